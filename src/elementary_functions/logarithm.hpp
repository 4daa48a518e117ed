// The natural logarithm, as one double and as a sum of two.
//
// In: any double; log(0) = -infinity, nan below. Out: within 0.6 ulp, the same bits in blocks.
// x = 2^k m with m in [sqrt(1/2), sqrt(2)), f = m - 1, s = f / (2 + f), and log m = 2 atanh s
// = f - f^2/2 + s (f^2/2 + s^2 P(s^2)), f^2/2 in two parts (the splitting is that of W. Kahan and
// K.C. Ng as P.T.P. Tang describes it, Table-driven implementation of the logarithm function,
// ACM Transactions on Mathematical Software 16, 1990).
#pragma once

#include <span>

#include "elementary_functions/bits.hpp"
#include "elementary_functions/coefficients.hpp"
#include "elementary_functions/polynomial.hpp"
#include "values/rounded_number.hpp"

namespace surfmesh::elementary {

/// x = mantissa 2^exponent, mantissa in [sqrt(1/2), sqrt(2)).
struct Normalised {
    double mantissa, exponent;
};

inline Normalised normalised(double x) {
    constexpr std::uint64_t ROOT_OF_HALF = 0x3fe6a09e667f3bcd;
    constexpr std::uint64_t TWO_TO_52 = 0x4330000000000000;
    const std::uint64_t biased = (bits_of(x) - ROOT_OF_HALF + (EXPONENT_OF_ONE << 52)) >> 52;
    const std::uint64_t mantissa = bits_of(x) - ((biased - EXPONENT_OF_ONE) << 52);
    return {number_of(mantissa), number_of(biased | TWO_TO_52) - (0x1p52 + 1023.0)};
}

/// For normal x > 0, without a branch.
inline double log_ordinary(double x) {
    constexpr double SPLITTER = 0x1p27 + 1.0;
    const Normalised n = normalised(x);
    const double f = n.mantissa - 1.0, s = f / (2.0 + f), z = s * s;
    const double t = SPLITTER * f, head = t - (t - f), tail = f - head;
    const double half_square = 0.5 * head * head;  // exact: head has 26 bits
    const double other = tail * (head + 0.5 * tail);
    const RoundedNumber top = fast_two_sum(f, -half_square);
    const double rest =
        (top.low - other) + s * ((half_square + other) + z * polynomial(LOGARITHM, z));
    const RoundedNumber all = fast_two_sum(n.exponent * LN2_PARTS[0], top.high);
    return all.high + (all.low + (rest + n.exponent * LN2_PARTS[1]));
}

/// The first bit is set where x is not a normal number above 0.
inline std::uint64_t is_no_normal_positive(double x) {
    constexpr std::uint64_t SMALLEST = 0x0010000000000000, LARGEST = 0x7fefffffffffffff;
    const std::uint64_t bits = bits_of(x);
    return bits | (bits - SMALLEST) | (LARGEST - bits);
}

/// For all x that are no normal numbers above 0.
double log_beyond(double x);

inline double log(double x) {
    return is_no_normal_positive(x) >> 63 == 0 ? log_ordinary(x) : log_beyond(x);
}

/// log(x + low) for normal x > 0 and |low| <= ulp(x), right to about 2^-65 of itself.
RoundedNumber log_sum(double x, double low = 0.0);

/// out[i] = f(x[i]); x and out have one length and may be the same.
void log(std::span<const double> x, std::span<double> out);

}  // namespace surfmesh::elementary
