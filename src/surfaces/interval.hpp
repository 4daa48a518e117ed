// Interval arithmetic: a function of an interval is an interval that holds its range.
//
// Bounds hold up to round-off, over the part of the interval where the function is defined:
// sqrt([-1, 4]) is [0, 2]. Where nothing is known the bounds are infinite.
//
// Source: Moore, Kearfott, Cloud, "Introduction to Interval Analysis", SIAM 2009, chapters 2-5.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace surfmesh {

struct Interval {
    double lo, hi;
};

namespace intervals {

inline constexpr double INFINITE = std::numeric_limits<double>::infinity();

/// nan where either is.
inline double smaller(double a, double b) { return a < b || a != a ? a : b; }
inline double larger(double a, double b) { return a > b || a != a ? a : b; }

/// Everything undecided (nan, reversed) replaced by the whole line.
inline Interval known(double lo, double hi) {
    return lo <= hi ? Interval{lo, hi} : Interval{-INFINITE, INFINITE};
}

inline Interval add(Interval a, Interval b) { return known(a.lo + b.lo, a.hi + b.hi); }
inline Interval subtract(Interval a, Interval b) { return known(a.lo - b.hi, a.hi - b.lo); }
inline Interval negative(Interval a) { return {-a.hi, -a.lo}; }
inline Interval sqrt(Interval a) { return known(std::sqrt(larger(a.lo, 0.0)), std::sqrt(a.hi)); }
inline Interval minimum(Interval a, Interval b) {
    return {smaller(a.lo, b.lo), smaller(a.hi, b.hi)};
}
inline Interval maximum(Interval a, Interval b) { return {larger(a.lo, b.lo), larger(a.hi, b.hi)}; }

inline Interval multiply(Interval a, Interval b) {
    const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
    return known(smaller(smaller(p, q), smaller(r, s)), larger(larger(p, q), larger(r, s)));
}

inline bool holds_zero(Interval a) { return a.lo <= 0.0 && a.hi >= 0.0; }

inline Interval absolute(Interval a) {
    const double lo = std::abs(a.lo), hi = std::abs(a.hi);
    return known(holds_zero(a) ? 0.0 : smaller(lo, hi), larger(lo, hi));
}

/// 1/[0, b] = [1/b, inf] and 1/[a, 0] = [-inf, 1/a]; a zero inside leaves nothing known.
inline Interval reciprocal(Interval a) {
    if (a.lo < 0.0 && a.hi > 0.0) return {-INFINITE, INFINITE};
    return known(a.hi == 0.0 ? -INFINITE : 1.0 / a.hi, a.lo == 0.0 ? INFINITE : 1.0 / a.lo);
}
inline Interval divide(Interval a, Interval b) { return multiply(a, reciprocal(b)); }

/// f increases where it is defined, from `first` to `last`.
inline Interval increasing(Interval a, double (*f)(double), double first = -INFINITE,
                           double last = INFINITE) {
    return known(f(larger(a.lo, first)), f(smaller(a.hi, last)));
}

/// a^n for an integer n >= 2; tighter than repeated products when a holds 0.
Interval integer_power(Interval a, std::int32_t n);
/// a^b for a >= 0, and for a < 0 where b is whole; unknown where a is negative and b is not.
Interval power(Interval a, Interval b);

Interval sin(Interval a);
Interval cos(Interval a);
Interval tan(Interval a);
Interval acos(Interval a);
Interval cosh(Interval a);

/// atan2 over a box: extremes are at corners unless the box meets the cut x <= 0, y = 0.
Interval angle(Interval y, Interval x);
/// ``angle`` up to whole turns: from the other side where the box meets the cut.
Interval turn(Interval y, Interval x);

/// A function whose slope is at most `rate`, between two bounds.
Interval steady(Interval a, double (*f)(double), double rate, double lowest, double highest);

/// Heaviside's function, as it is at the ends too.
Interval step(Interval a);
/// -1, 0 or 1.
Interval signum(Interval a);
/// 0 or 1, the slope of max(x, 0): one-sided at the ends, where the other side is not seen.
Interval slope_step(Interval a);
/// -1 or 1, the slope of |x|: likewise.
Interval slope_side(Interval a);

/// The slope of a slope that jumps at 0: nothing is known where that is inside.
Interval kink(Interval a);
/// The slope of a value that jumps at 0: nothing is known where that is in the interval.
Interval jump(Interval a);
/// The slope of floor(x).
Interval tread(Interval a);
/// What the slope of ``angle`` has beside its smooth part.
Interval cut(Interval y, Interval x);
/// a where d >= 0, else b.
Interval chosen(Interval d, Interval a, Interval b);

}  // namespace intervals
}  // namespace surfmesh
