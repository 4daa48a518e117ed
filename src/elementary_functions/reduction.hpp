// Arguments of sine and cosine brought to [-pi/4, pi/4]: x = quadrant pi/2 + (high + low).
//
// Moderate arguments by subtracting multiples of pi/2 in parts of 33 bits (W.J. Cody, W. Waite,
// Software Manual for the Elementary Functions, 1980, chapter 8): each product with a number of
// 20 bits is exact, so what remains is right to about 2^-110. Larger ones by the bits of 2/pi that
// matter (M.H. Payne, R.N. Hanek, Radian reduction for trigonometric functions, SIGNUM 18, 1983).
#pragma once

#include <cstdint>

#include "elementary_functions/bits.hpp"
#include "elementary_functions/coefficients.hpp"
#include "values/rounded_number.hpp"

namespace surfmesh::elementary {

/// Of the quadrant the last two bits count. |low| <= ulp(high) / 2.
struct ReducedAngle {
    double high, low;
    std::uint64_t quadrant;
};

inline constexpr double MODERATE = 0x1p20;
inline constexpr double ROUNDER = 0x1.8p52;  // x + ROUNDER holds the nearest integer to x

/// For |x| <= MODERATE; what comes out for others has no meaning.
inline ReducedAngle reduce_moderate(double x) {
    const double rounded = x * TWO_OVER_PI + ROUNDER;
    const double n = rounded - ROUNDER;
    // exact: the difference is a multiple of 2^-53 or of ulp(x), and below 1
    const double first = x - n * HALF_PI_PARTS[0];
    const RoundedNumber second = two_sum(first, -(n * HALF_PI_PARTS[1]));
    const RoundedNumber third = two_sum(second.high, -(n * HALF_PI_PARTS[2]));
    // subtracted, not added: the sign of zero remains
    const double rest = n * HALF_PI_PARTS[3] - (second.low + third.low);
    const double high = third.high - rest;
    return {high, (third.high - high) - rest, bits_of(rounded)};
}

/// For every finite |x| > MODERATE.
ReducedAngle reduce_large(double x);

}  // namespace surfmesh::elementary
