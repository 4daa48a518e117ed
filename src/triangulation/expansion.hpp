// A sum of doubles without error, as an expansion: numbers that do not overlap, the largest last.
//
// In: the terms, or products of two or three numbers, which have exact errors as long as nothing
// under- or overflows. Out: a double with the sign of the sum, exactly. Grow-Expansion with zeros
// left out (J.R. Shewchuk, Adaptive precision floating-point arithmetic and fast robust geometric
// predicates, Discrete & Computational Geometry 18, 1997, 2.4): rounding to even keeps a gap
// between the numbers, so that those below the largest are less than half of it together.
#pragma once

#include <array>
#include <cstddef>

#include "values/rounded_number.hpp"

namespace surfmesh {

/// Takes as many terms as it has room for.
template <std::size_t ROOM>
class Expansion {
  public:
    void add(double term) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < length_; ++i) {
            const RoundedNumber sum = two_sum(term, numbers_[i]);
            term = sum.high;
            if (sum.low != 0.0) numbers_[kept++] = sum.low;
        }
        if (term != 0.0) numbers_[kept++] = term;
        length_ = kept;
    }
    /// Add a b, two terms.
    void add_product(double a, double b) {
        const RoundedNumber ab = two_product(a, b);
        add(ab.low);
        add(ab.high);
    }
    /// Add a b c, four terms.
    void add_product(double a, double b, double c) {
        const RoundedNumber ab = two_product(a, b);
        add_product(ab.low, c);
        add_product(ab.high, c);
    }
    /// About the sum, with its sign.
    [[nodiscard]] double estimate() const {
        double sum = 0.0;
        for (std::size_t i = 0; i < length_; ++i) sum += numbers_[i];
        return sum;
    }

  private:
    std::array<double, ROOM> numbers_;
    std::size_t length_ = 0;
};

}  // namespace surfmesh
