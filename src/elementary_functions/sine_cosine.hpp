// Sine, cosine and tangent of one number, and of blocks of numbers.
//
// In: any doubles; infinities and nan give nan. Out: within 0.6 ulp (tangent 1 ulp), the same
// bits for one number and in a block, on every machine. Only sums, products and one quotient in
// a fixed order; the angle is reduced to [-pi/4, pi/4] as a sum of two doubles (reduction.hpp).
#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "elementary_functions/polynomial.hpp"
#include "elementary_functions/reduction.hpp"

namespace surfmesh::elementary {

struct SineCosine {
    double sine, cosine;
};

/// sin(high + low), |high| <= pi/4: x + x^3 S(x^2) and the first terms in low.
inline RoundedNumber sine_near_zero(double high, double low) {
    const double z = high * high;
    const double correction = high * z * polynomial(SINE, z) + low * (1.0 - 0.5 * z);
    const double sum = high - (0.0 - correction);  // so that the sine of -0 is -0
    return {sum, correction - (sum - high)};
}

/// cos(high + low), |high| <= pi/4: 1 - x^2/2 + x^4 C(x^2), with the rounding error of 1 - x^2/2.
inline RoundedNumber cosine_near_zero(double high, double low) {
    constexpr double SPLITTER = 0x1p27 + 1.0;
    const double z = high * high;
    const double t = SPLITTER * high, head = t - (t - high), tail = high - head;
    const double half_square = 0.5 * head * head;  // exact: head has 26 bits
    const RoundedNumber top = fast_two_sum(1.0, -half_square);
    const double rest = tail * (head + 0.5 * tail) + high * low;
    return fast_two_sum(top.high, top.low + (z * z * polynomial(COSINE, z) - rest));
}

/// Both for a reduced angle.
inline SineCosine sincos(const ReducedAngle& angle) {
    const double s = sine_near_zero(angle.high, angle.low).high;
    const double c = cosine_near_zero(angle.high, angle.low).high;
    // sin(x + q pi/2) is s, c, -s, -c and cos(x + q pi/2) is c, -s, -c, s, for q = 0, 1, 2, 3
    const std::uint64_t odd = 0 - (angle.quadrant & 1);
    return {with_sign_flipped(choose(odd, c, s), angle.quadrant << 62),
            with_sign_flipped(choose(odd, s, c), (angle.quadrant + 1) << 62)};
}

/// The tangent of a reduced angle: s/c or -c/s, where s and c are sums of two doubles.
inline double tan(const ReducedAngle& angle) {
    const RoundedNumber s = sine_near_zero(angle.high, angle.low);
    const RoundedNumber c = cosine_near_zero(angle.high, angle.low);
    const std::uint64_t odd = 0 - (angle.quadrant & 1);
    const double above = choose(odd, -c.high, s.high), above_low = choose(odd, -c.low, s.low);
    const double below = choose(odd, s.high, c.high), below_low = choose(odd, s.low, c.low);
    const double quotient = above / below;
    const RoundedNumber back = two_product(quotient, below);
    const double rest = ((above - back.high) - back.low) + (above_low - quotient * below_low);
    return quotient - (0.0 - rest / below);  // so that the tangent of -0 is -0
}

/// For |x| <= MODERATE, without a branch.
inline SineCosine sincos_moderate(double x) { return sincos(reduce_moderate(x)); }

/// For all others: nan where x is not finite.
SineCosine sincos_beyond(double x);

inline SineCosine sincos(double x) {
    return std::abs(x) <= MODERATE ? sincos_moderate(x) : sincos_beyond(x);
}
inline double sin(double x) { return sincos(x).sine; }
inline double cos(double x) { return sincos(x).cosine; }
double tan(double x);

/// The same for blocks: out[i] = f(x[i]); x and out have one length and may be the same.
void sin(std::span<const double> x, std::span<double> out);
void cos(std::span<const double> x, std::span<double> out);
void sincos(std::span<const double> x, std::span<double> sine, std::span<double> cosine);
void tan(std::span<const double> x, std::span<double> out);

}  // namespace surfmesh::elementary
