#include "elementary_functions/inverse_trigonometric.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "elementary_functions/bits.hpp"
#include "elementary_functions/blocks.hpp"
#include "elementary_functions/coefficients.hpp"
#include "elementary_functions/double_double.hpp"
#include "elementary_functions/polynomial.hpp"

namespace surfmesh::elementary {
namespace {

/// All bits set where a > b, for a and b without a sign.
std::uint64_t mask_of_larger(double a, double b) { return mask_of(bits_of(b) - bits_of(a)); }

/// The angle of (x, y), 0 <= y and x of any sign, that is made of quarters of pi:
/// of |x| and y the smaller over the larger is a / b.
///
///     y
///     |  \ 2 | 1 /        octants; x < 0 is mirrored: pi - angle
///     |   \  |  /  0
///     +----------- x
///
/// Inline, so that compilers take several numbers at a time in the loops below.
inline double angle_of(double y, double x) {
    const double size = std::abs(x);
    const std::uint64_t steep = mask_of_larger(y, size), left = mask_of(bits_of(x));
    const double a = choose(steep, size, y), b = choose(steep, y, size);
    // a / b, or (a - b) / (a + b) where that is too large
    const std::uint64_t shifted = mask_of_larger(a, TAN_OF_PI_8 * b);
    const RoundedNumber difference = two_sum(a, -b), total = two_sum(a, b);
    const double above = choose(shifted, difference.high, a);
    const double above_low = choose(shifted, difference.low, 0.0);
    const double below = choose(shifted, total.high, b);
    const double below_low = choose(shifted, total.low, 0.0);
    const double q = above / below;
    const RoundedNumber back = two_product(q, below);
    const double q_low = (((above - back.high) - back.low) + (above_low - q * below_low)) / below;
    const double z = q * q, rest = q_low + q * z * polynomial(ARC_TANGENT, z);
    // quarters of pi beside it, and its sign: steep turns it over from pi/2, left from pi
    const double quarters = choose(shifted, 1.0, 0.0);
    const double upright = choose(steep, 2.0 - quarters, quarters);
    const double turned = choose(left, 4.0 - upright, upright);
    const std::uint64_t sign = steep ^ left;
    const double high = with_sign_flipped(q, sign), low = with_sign_flipped(rest, sign);
    const double base = turned * QUARTER_PI[0], base_low = turned * QUARTER_PI[1];
    const RoundedNumber all = two_sum(base, high);
    return all.high + (all.low + (base_low + low));
}

/// The first bit is set where a quotient with x, sums and their errors may over- or underflow.
std::uint64_t is_extreme(double x) {
    constexpr std::uint64_t SMALLEST = 0x2010000000000000, LARGEST = 0x5fe0000000000000;
    const std::uint64_t bits = bits_of_magnitude(x);
    return (bits - SMALLEST) | (LARGEST - bits);
}

inline double atan_ordinary(double x) { return std::copysign(angle_of(std::abs(x), 1.0), x); }

inline double atan2_ordinary(double y, double x) {
    return std::copysign(angle_of(std::abs(y), x), y);
}

/// atan2 at zeros, infinities and extreme numbers; |y| in place of y.
double upper_angle(double y, double x) {
    const bool left = std::signbit(x);
    const double size = std::abs(x);
    if (y == 0.0) return left ? 4.0 * QUARTER_PI[0] : 0.0;
    if (size == 0.0) return 2.0 * QUARTER_PI[0];
    if (std::isinf(y)) return (!std::isinf(x) ? 2.0 : left ? 3.0 : 1.0) * QUARTER_PI[0];
    if (std::isinf(x)) return left ? 4.0 * QUARTER_PI[0] : 0.0;
    int y_exponent = 0, x_exponent = 0;
    const double a = std::frexp(y, &y_exponent), b = std::frexp(x, &x_exponent);
    const int apart = y_exponent - x_exponent;
    if (apart > 64) return 2.0 * QUARTER_PI[0];
    if (apart < -64) return left ? 4.0 * QUARTER_PI[0] : y / x;
    return angle_of(std::ldexp(a, apart), b);
}

/// x + x^3 R(x^2) at |x| <= 1/2, or at sqrt((1 - |x|) / 2): half the angle from 1.
RoundedNumber asin_near(double x) {
    const double size = std::abs(x);
    const bool near = size <= 0.5;
    const double square = near ? size * size : 0.5 * (1.0 - size);
    const double s = near ? size : std::sqrt(square);
    const RoundedNumber back = two_product(s, s);
    const double tiny = std::numeric_limits<double>::min();  // no division by 0
    const double s_low = near ? 0.0 : ((square - back.high) - back.low) / (s + s + tiny);
    return fast_two_sum(s, s_low + s * square * polynomial(ARC_SINE, square));
}

}  // namespace

double atan(double x) {
    if (is_extreme(x) >> 63 == 0) return atan_ordinary(x);
    if (std::isnan(x)) return x;
    return std::abs(x) < 1.0 ? x : std::copysign(2.0 * QUARTER_PI[0], x);
}

double atan2(double y, double x) {
    if ((is_extreme(y) | is_extreme(x)) >> 63 == 0) return atan2_ordinary(y, x);
    if (std::isnan(x) || std::isnan(y)) return x + y;
    return std::copysign(upper_angle(std::abs(y), x), y);
}

double asin(double x) {
    const double size = std::abs(x);
    if (!(size <= 1.0)) return std::numeric_limits<double>::quiet_NaN();
    const RoundedNumber a = asin_near(x);
    if (size <= 0.5) return std::copysign(a.high, x);
    const RoundedNumber all = two_sum(2.0 * QUARTER_PI[0], -2.0 * a.high);
    return std::copysign(all.high + (all.low + 2.0 * (QUARTER_PI[1] - a.low)), x);
}

double acos(double x) {
    if (!(std::abs(x) <= 1.0)) return std::numeric_limits<double>::quiet_NaN();
    const RoundedNumber a = asin_near(x);
    if (x > 0.5) return 2.0 * (a.high + a.low);
    // pi/2 - asin x, or pi - 2 asin(sqrt((1 + x)/2))
    const double quarters = x < -0.5 ? 4.0 : 2.0;
    const double part = x < -0.5 ? 2.0 * a.high : std::copysign(a.high, x);
    const double part_low = x < -0.5 ? 2.0 * a.low : with_sign_flipped(a.low, bits_of(x));
    const RoundedNumber all = two_sum(quarters * QUARTER_PI[0], -part);
    return all.high + (all.low + (quarters * QUARTER_PI[1] - part_low));
}

void atan(std::span<const double> x, std::span<double> out) {
    map_blocks(x, out, atan_ordinary, is_extreme, [](double a) { return atan(a); });
}

void atan2(std::span<const double> y, std::span<const double> x, std::span<double> out) {
    std::array<double, CHUNK> above, below;
    for (std::size_t start = 0; start < x.size(); start += CHUNK) {
        const std::size_t count = std::min(CHUNK, x.size() - start);
        std::copy_n(y.data() + start, count, above.data());
        std::copy_n(x.data() + start, count, below.data());
        double* result = out.data() + start;
        std::uint64_t special = 0;
        for (std::size_t k = 0; k < count; ++k)
            special |= is_extreme(above[k]) | is_extreme(below[k]);
        if (special >> 63 == 0)
            for (std::size_t k = 0; k < count; ++k) result[k] = atan2_ordinary(above[k], below[k]);
        else
            for (std::size_t k = 0; k < count; ++k) result[k] = atan2(above[k], below[k]);
    }
}

void asin(std::span<const double> x, std::span<double> out) { map_each(x, out, asin); }
void acos(std::span<const double> x, std::span<double> out) { map_each(x, out, acos); }

}  // namespace surfmesh::elementary
