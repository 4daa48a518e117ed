// Intervals with their ends rounded outwards: what they hold is proved, round-off included.
//
// A sum, product, quotient or root of doubles is within half an ulp of the exact one, so the next
// double down or up bounds it; the elementary functions are within the ulps that their headers say.
// ``below`` and ``above`` need no directed rounding and no branch: with e = phi |x| + eta computed
// to nearest, x - e is the double below x or the one below that.
//
// Source: Rump, Zimmermann, Boldo, Melquiond, "Computing predecessor and successor in rounding to
// nearest", BIT 49 (2009), 419-431, algorithm 1.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "surfaces/interval.hpp"

namespace surfmesh::outward {

inline constexpr double ULP = 0x1p-52;  // relative: the distance of two doubles, at most

/// No greater than x less one ulp; -infinity where that overflows, nan for +infinity.
inline double below(double x) {
    constexpr double PHI = 0x1p-53 * (1.0 + 0x1p-51),
                     ETA = std::numeric_limits<double>::denorm_min();
    return x - (PHI * std::abs(x) + ETA);
}
inline double above(double x) { return -below(-x); }

/// So many ulps further out at both ends.
inline Interval widened(Interval a, double ulps) {
    constexpr double TINY = 4.0 * std::numeric_limits<double>::denorm_min();
    const double low = std::abs(a.lo) * (ulps * ULP) + ulps * TINY;
    const double high = std::abs(a.hi) * (ulps * ULP) + ulps * TINY;
    return intervals::known(below(a.lo - low), above(a.hi + high));
}

inline Interval rounded(Interval a) { return intervals::known(below(a.lo), above(a.hi)); }

inline Interval exactly(double x) { return {x, x}; }
inline Interval add(Interval a, Interval b) { return rounded({a.lo + b.lo, a.hi + b.hi}); }
inline Interval subtract(Interval a, Interval b) { return rounded({a.lo - b.hi, a.hi - b.lo}); }

/// Where a product is not a number, or they are infinite of both signs, so is their sum.
inline Interval multiply(Interval a, Interval b) {
    const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
    const double sum = (p + q) + (r + s);
    const Interval found = rounded(
        {std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s))});
    return sum == sum ? found : Interval{-intervals::INFINITE, intervals::INFINITE};
}
inline Interval reciprocal(Interval a) { return rounded(intervals::reciprocal(a)); }
inline Interval divide(Interval a, Interval b) { return multiply(a, reciprocal(b)); }

/// Of both.
inline Interval hull(Interval a, Interval b) {
    return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}

/// The largest absolute value.
inline double magnitude(Interval a) { return std::max(std::abs(a.lo), std::abs(a.hi)); }

}  // namespace surfmesh::outward
