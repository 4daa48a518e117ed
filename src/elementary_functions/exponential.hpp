// The exponential function, as one double and as a sum of two.
//
// In: any double; overflow gives infinity, underflow what is left of it, and 0 in the end. Out:
// within 0.6 ulp, the same bits in blocks. x = k ln 2 + r with ln 2 in parts (W.J. Cody, W. Waite,
// Software Manual for the Elementary Functions, 1980, chapter 6), e^r = 1 + r + r^2 P(r).
#pragma once

#include <cmath>
#include <limits>
#include <span>

#include "elementary_functions/bits.hpp"
#include "elementary_functions/coefficients.hpp"
#include "elementary_functions/polynomial.hpp"
#include "values/rounded_number.hpp"

namespace surfmesh::elementary {

/// (high + low) 2^exponent.
struct ScaledSum {
    double high, low;
    std::int64_t exponent;
};

inline constexpr double ORDINARY_EXPONENT = 708.0;  // up to it, e^x and e^-x are normal numbers
inline constexpr double HIGHEST_EXPONENT = 746.0;   // beyond it, e^x is infinite and e^-x is 0

/// 2^k for -1023 < k < 1024.
inline double power_of_two(std::int64_t k) {
    return number_of((EXPONENT_OF_ONE + static_cast<std::uint64_t>(k)) << 52);
}

/// x 2^k, rounded once, for a normal x and |k| < 2046.
inline double scaled(double x, std::int64_t k) {
    const std::int64_t half = k / 2;
    return (x * power_of_two(half)) * power_of_two(k - half);
}

/// e^(x + low) for |x| <= HIGHEST_EXPONENT and a low below an ulp or so of x.
inline ScaledSum exp_sum(double x, double low = 0.0) {
    constexpr double ROUNDER = 0x1.8p52;
    const double rounded = x * LOG2_E + ROUNDER;
    const double k = rounded - ROUNDER;
    const double first = x - k * LN2_PARTS[0];  // exact, as is the next product
    const RoundedNumber second = two_sum(first, -(k * LN2_PARTS[1]));
    const RoundedNumber r = fast_two_sum(second.high, (second.low - k * LN2_PARTS[2]) + low);
    const RoundedNumber top = fast_two_sum(1.0, r.high);
    const double square = r.high * r.high;
    const double rest = r.low + r.low * r.high + square * polynomial(EXPONENTIAL, r.high);
    const RoundedNumber found = fast_two_sum(top.high, top.low + rest);
    // the last bits of `rounded` are those of k
    const auto exponent = static_cast<std::int64_t>(bits_of(rounded) - bits_of(ROUNDER));
    return {found.high, found.low, exponent};
}

/// For |x| <= ORDINARY_EXPONENT, without a branch.
inline double exp_ordinary(double x) {
    const ScaledSum e = exp_sum(x);
    return e.high * power_of_two(e.exponent);
}

/// For all x.
inline double exp(double x) {
    if (std::abs(x) <= ORDINARY_EXPONENT) return exp_ordinary(x);
    if (std::isnan(x)) return x;
    if (x > HIGHEST_EXPONENT) return std::numeric_limits<double>::infinity();
    if (x < -HIGHEST_EXPONENT) return 0.0;
    const ScaledSum e = exp_sum(x);
    return scaled(e.high, e.exponent);
}

/// out[i] = f(x[i]); x and out have one length and may be the same.
void exp(std::span<const double> x, std::span<double> out);

}  // namespace surfmesh::elementary
