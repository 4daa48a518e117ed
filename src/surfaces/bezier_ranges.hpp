// Ranges of a Bezier polynomial and of its derivatives, between its coefficients and their
// differences; round-off included.
//
// Over a part a x b of a span second derivatives lie between second differences of the coefficients
// c_ij, p (p - 1) (c_i+2 - 2 c_i+1 + c_i) / a^2 and so on. A curve has one column.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "surfaces/outward.hpp"

namespace surfmesh {

/// The coefficients over one part along one direction, or its weights.
struct BezierNumbers {
    std::size_t rows, columns;
    double width_u, width_v;
    const double* values;
    double error;  // of each of them

    [[nodiscard]] double at(std::size_t i, std::size_t j) const { return values[i * columns + j]; }
};

/// Between the smallest and the largest of differences.
class NumberRange {
  public:
    void take(double x) {
        lo_ = std::min(lo_, x);
        hi_ = std::max(hi_, x);
        size_ = std::max(size_, std::abs(x));
    }
    /// Times a factor, with the error of the coefficients and of the few operations.
    [[nodiscard]] Interval scaled(double factor, double error) const {
        if (!(lo_ <= hi_)) return {0.0, 0.0};  // none: the degree is too low for the derivative
        const double margin = error + 4.0 * outward::ULP * size_;
        return outward::widened({factor * (lo_ - margin), factor * (hi_ + margin)}, 6.0);
    }

  private:
    double lo_ = std::numeric_limits<double>::infinity(), hi_ = -lo_, size_ = 0.0;
};

Interval value_range(const BezierNumbers& c);

/// k times along u, l times along v, each at most 2.
Interval derivative_range(const BezierNumbers& c, std::size_t k, std::size_t l);

/// A corner of a part: at its last u, at its last v.
struct BezierCorner {
    bool last_u, last_v;
};

/// All derivatives up to the order, at most 3, in their sequence (surface.hpp): over the part, which has
/// widths, or at one of its corners. work: twice as many numbers as coefficients.
void derivative_ranges(const BezierNumbers& c, int order, const BezierCorner* corner,
                       std::span<double> work, std::span<Interval> out);

/// The first derivative of s = A / w by that of A and of w, which is positive: (A_u - w_u s) / w.
Interval quotient_slope(Interval a_u, Interval w_u, Interval s, Interval w);

/// How far quotients of coefficients may be off, of coefficients no larger than ``largest``.
double quotient_error(double error_of_a, double error_of_w, double largest, double least_weight);

}  // namespace surfmesh
