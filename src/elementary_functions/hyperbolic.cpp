#include "elementary_functions/hyperbolic.hpp"

#include <cmath>
#include <limits>

#include "elementary_functions/blocks.hpp"
#include "elementary_functions/double_double.hpp"
#include "elementary_functions/exponential.hpp"
#include "elementary_functions/logarithm.hpp"

namespace surfmesh::elementary {
namespace {

constexpr double NAN_RESULT = std::numeric_limits<double>::quiet_NaN();
constexpr double INFINITE_RESULT = std::numeric_limits<double>::infinity();

/// e^x / 2, for 1 <= x: what is lost in rounding counts where little cancels.
RoundedNumber half_of_exp(double x) {
    const ScaledSum e = exp_sum(x);
    return {scaled(e.high, e.exponent - 1), scaled(e.low, e.exponent - 1)};
}

/// sinh x and cosh x for |x| <= 1.
RoundedNumber small_sinh(double x) {
    const double z = x * x;
    return fast_two_sum(x, x * z * polynomial(HYPERBOLIC_SINE, z));
}

RoundedNumber small_cosh(double x) {
    const RoundedNumber z = two_product(x, x);
    const double rest = z.high * (polynomial(HYPERBOLIC_COSINE, z.high) - 0.5);
    const RoundedNumber half = fast_two_sum(1.0, 0.5 * z.high);
    return fast_two_sum(half.high, half.low + (rest + 0.5 * z.low));
}

double log_of(RoundedNumber x) { return log_sum(x.high, x.low).high; }

/// log(2 x) for an x whose square would overflow.
double log_of_twice(double x) {
    return sum(log_sum(0.5 * x), {2.0 * LN2_PARTS[0], 2.0 * LN2_PARTS[1]}).high;
}

}  // namespace

double sinh(double x) {
    const double size = std::abs(x);
    if (size <= 1.0) return x == 0.0 ? x : small_sinh(x).high;
    if (!(size <= HIGHEST_EXPONENT)) return std::isnan(x) ? x : std::copysign(INFINITE_RESULT, x);
    const RoundedNumber half = half_of_exp(size);
    return std::copysign(half.high - (0.25 / half.high - half.low), x);
}

double cosh(double x) {
    const double size = std::abs(x);
    if (size <= 1.0) return small_cosh(x).high;
    if (!(size <= HIGHEST_EXPONENT)) return std::isnan(x) ? x : INFINITE_RESULT;
    const RoundedNumber half = half_of_exp(size);
    return half.high + (0.25 / half.high + half.low);
}

double tanh(double x) {
    const double size = std::abs(x);
    if (x == 0.0 || std::isnan(x)) return x;
    if (size <= 1.0) return quotient(small_sinh(x), small_cosh(x)).high;
    if (size > 22.0) return std::copysign(1.0, x);  // e^-44 is below an eighth of an ulp
    return std::copysign(1.0 - 2.0 / (exp_ordinary(2.0 * size) + 1.0), x);
}

double asinh(double x) {
    const double size = std::abs(x);
    if (size <= 0.125) {
        const double z = x * x;
        return x == 0.0 ? x : x + x * z * polynomial(AREA_SINE, z);
    }
    if (!std::isfinite(x)) return x;
    if (size > 0x1p400) return std::copysign(log_of_twice(size), x);
    const RoundedNumber far = root(sum({1.0, 0.0}, two_product(size, size)));
    return std::copysign(log_of(sum({size, 0.0}, far)), x);
}

double acosh(double x) {
    if (!(x >= 1.0)) return NAN_RESULT;
    if (x == 1.0) return 0.0;
    if (std::isinf(x)) return x;
    if (x > 0x1p400) return log_of_twice(x);
    // x^2 - 1 = (x - 1)(x + 1), where x - 1 is exact as far as it matters
    const RoundedNumber square = product(two_sum(x, -1.0), two_sum(x, 1.0));
    return log_of(sum({x, 0.0}, root(square)));
}

double atanh(double x) {
    const double size = std::abs(x);
    if (x == 0.0) return x;
    if (!(size < 1.0)) return size == 1.0 ? std::copysign(INFINITE_RESULT, x) : NAN_RESULT;
    if (size <= 0.17) {
        const double z = x * x;
        return x + x * z * (0.5 * polynomial(LOGARITHM, z));
    }
    const RoundedNumber ratio = quotient(two_sum(1.0, size), two_sum(1.0, -size));
    return std::copysign(0.5 * log_of(ratio), x);
}

void sinh(std::span<const double> x, std::span<double> out) { map_each(x, out, sinh); }
void cosh(std::span<const double> x, std::span<double> out) { map_each(x, out, cosh); }
void tanh(std::span<const double> x, std::span<double> out) { map_each(x, out, tanh); }
void asinh(std::span<const double> x, std::span<double> out) { map_each(x, out, asinh); }
void acosh(std::span<const double> x, std::span<double> out) { map_each(x, out, acosh); }
void atanh(std::span<const double> x, std::span<double> out) { map_each(x, out, atanh); }

}  // namespace surfmesh::elementary
