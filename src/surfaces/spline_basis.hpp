// B-spline functions that are not zero in a knot span, and their derivatives.
//
// Source: Piegl, Tiller, "The NURBS Book", 2nd edition, 1997: A2.2 and A2.3.
//
// A flat knot vector of m + 1 numbers and n + 1 control points fix the degree p = m - n - 1; the
// parameter runs from knots[p] to knots[n + 1], whether the ends are clamped or not:
//
//     knots   | 0 .. p-1 |  p   ...   n+1  | n+2 .. m |
//                           first     last
//     span s: knots[s] <= t < knots[s+1], where N_{s-p} .. N_s are not zero
//
// Beyond the ends the polynomial of the end span goes on; where there is a period, t is brought
// back by whole periods.
#pragma once

#include <cstdint>
#include <span>

#include "values/array.hpp"
#include "values/two_numbers.hpp"

namespace surfmesh {

/// The part of a spline in use, and its period.
struct SplineLimits {
    double first, last;  // nan: no part in particular
    double period;       // 0: none
};

/// Where a parameter lies: its span, and itself brought into it by whole periods.
struct KnotPlace {
    std::int64_t span;
    double t;
};

/// First and last of some spans.
struct SpanRange {
    std::int64_t first, last;
};

/// The spline functions of one parameter. The knots do not decrease, and knots[degree] is less
/// than knots[size - degree - 1].
class SplineBasis {
  public:
    SplineBasis(std::span<const double> knots, std::size_t degree, SplineLimits limits)
        : knots_(knots), degree_(static_cast<std::int64_t>(degree)), limits_(limits) {}

    [[nodiscard]] std::size_t degree() const { return static_cast<std::size_t>(degree_); }
    [[nodiscard]] std::span<const double> knots() const { return knots_; }
    [[nodiscard]] double period() const { return limits_.period; }
    [[nodiscard]] const SplineLimits& limits() const { return limits_; }

    /// At a knot that is an end of the part in use, the span lies inside.
    [[nodiscard]] KnotPlace locate(double t) const;

    /// The functions of a span and their derivatives up to the order: row k of ``out`` has the
    /// degree + 1 derivatives k. table: (degree + 1)^2 numbers to work in.
    void derivatives(KnotPlace place, int order, std::span<double> table,
                     std::span<double> out) const;
    /// The same of two parameters in one span.
    void derivatives(std::int64_t span, TwoNumbers t, int order, std::span<TwoNumbers> table,
                     std::span<TwoNumbers> out) const;

    /// The spans that a range meets; all of them where it goes beyond the knots.
    [[nodiscard]] SpanRange spans(double low, double high) const;

    /// Is there a tangent everywhere: no knot inside as often as the degree?
    [[nodiscard]] bool is_smooth() const;

    /// What the difference of control points ``first`` and first + 1 is multiplied with in the
    /// derivative ``times`` + 1, whose own derivative ``times`` these belong to.
    [[nodiscard]] double difference_factor(std::int64_t first, int times) const;

  private:
    [[nodiscard]] std::int64_t last_knot_not_above(double t) const;

    Array<double> knots_;
    std::int64_t degree_;
    SplineLimits limits_;
};

/// Memory for the functions of a basis and their derivatives, and to work in: of one parameter, or
/// of two.
template <class Number>
class FunctionsOfSpline {
  public:
    FunctionsOfSpline(std::size_t degree, int order)
        : columns_(degree + 1),
          table_(columns_ * columns_),
          values_(static_cast<std::size_t>(order + 1) * columns_),
          order_(order) {}

    void evaluate(const SplineBasis& basis, KnotPlace place) {
        basis.derivatives(place, order_, table_, values_);
    }
    void evaluate(const SplineBasis& basis, std::int64_t span, TwoNumbers t) {
        basis.derivatives(span, t, order_, table_, values_);
    }
    /// Derivative k of all functions of the span.
    [[nodiscard]] const Number* operator[](int k) const {
        return values_.data() + static_cast<std::size_t>(k) * columns_;
    }

  private:
    std::size_t columns_;
    Array<Number> table_, values_;
    int order_;
};

using SplineFunctions = FunctionsOfSpline<double>;
using PairsOfSplineFunctions = FunctionsOfSpline<TwoNumbers>;

}  // namespace surfmesh
