#include "surfaces/majorant.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "elementary_functions/exponential.hpp"
#include "elementary_functions/hyperbolic.hpp"
#include "elementary_functions/logarithm.hpp"
#include "elementary_functions/power.hpp"
#include "surfaces/outward.hpp"

namespace surfmesh::majorants {
namespace {

using intervals::INFINITE;
using outward::magnitude;

constexpr double TINY = 1e-250;          // more than what underflows
constexpr double WIDER = 1.0 + 0x1p-45;  // more than what functions are off

constexpr Sizes UNKNOWN = {INFINITE, INFINITE, INFINITE, INFINITE, INFINITE, INFINITE, INFINITE,
                           INFINITE, INFINITE, INFINITE, INFINITE, INFINITE, INFINITE, INFINITE};

constexpr std::size_t number(std::size_t k, std::size_t l) {
    return (k + l) * (k + l + 1) / 2 + l - 1;
}

/// What terms of orders N and M give of their product.
template <std::size_t N, std::size_t M>
void add_terms(const Sizes& a, const Sizes& b, Sizes& found) {
    constexpr std::size_t FROM = number(N, 0), OTHER = number(M, 0), INTO = number(N + M, 0);
    const auto row = [&]<std::size_t... I>(std::size_t j, std::index_sequence<I...>) {
        const double factor = a[FROM + j];
        ((found[INTO + j + I] += factor * b[OTHER + I]), ...);
    };
    for (std::size_t j = 0; j <= N; ++j) row(j, std::make_index_sequence<M + 1>());
}

/// The product of two of them without their values.
Sizes product(const Sizes& a, const Sizes& b) {
    Sizes found{};
    add_terms<1, 1>(a, b, found);
    add_terms<1, 2>(a, b, found);
    add_terms<2, 1>(a, b, found);
    add_terms<1, 3>(a, b, found);
    add_terms<2, 2>(a, b, found);
    add_terms<3, 1>(a, b, found);
    return found;
}

void add(Sizes& a, double factor, const Sizes& b) {
    for (std::size_t k = 0; k < COUNT; ++k) a[k] += factor * b[k];
}

Sizes sum(const Sizes& a, const Sizes& b) {
    Sizes found = a;
    add(found, 1.0, b);
    return found;
}

/// What has underflowed is not 0.
Sizes not_zero(Sizes a) {
    for (double& size : a) size = std::max(size, TINY);
    return a;
}

Sizes multiply(const Majorant& a, const Majorant& b) {
    Sizes found = product(a.sizes, b.sizes);
    add(found, magnitude(a.range), b.sizes);
    add(found, magnitude(b.range), a.sizes);
    return not_zero(found);
}

/// Of f, with sup |f^(k)| / k! over the operand's range, k = 1 ... 4.
using Slopes = std::array<double, ORDER>;

Sizes composed(const Slopes& f, const Sizes& a) {
    Sizes found{};
    add(found, f[3], a);
    for (const std::size_t k : {2, 1, 0}) {
        found = product(found, a);
        add(found, f[k], a);
    }
    return not_zero(found);
}

double least_magnitude(Interval a) {
    return intervals::holds_zero(a) ? 0.0 : std::min(std::abs(a.lo), std::abs(a.hi));
}

/// f^(k) / k! at most radius^-k / k: of the logarithm, and of those that are as regular.
Slopes of_logarithm(double radius) {
    const double x = WIDER / radius;
    return {x, x * x / 2.0, x * x * x / 3.0, x * x * x * x / 4.0};
}

/// x^b, for b whole or x > 0; at the end where each derivative is largest.
Slopes of_power(Interval a, double b) {
    const double low = least_magnitude(a), high = magnitude(a);
    Slopes found{};
    double factor = 1.0;
    for (std::size_t k = 1; k <= ORDER; ++k) {
        const double left = b - static_cast<double>(k) + 1.0, exponent = left - 1.0;
        factor *= std::abs(left) / static_cast<double>(k);
        if (factor == 0.0) break;
        const double x = exponent < 0.0 ? low : high;
        found[k - 1] = factor * elementary::pow(x, exponent) * WIDER;
    }
    return found;
}

Slopes of_waves(double sine, double cosine) {
    return {cosine, sine / 2.0, cosine / 6.0, sine / 24.0};
}

double largest_sine(Interval a) {
    constexpr double FARTHEST = 1e6;  // of a phase that is known
    if (!(magnitude(a) < FARTHEST)) return 1.0;
    return std::min(1.0, magnitude(intervals::sin(a)) + 0x1p-40);
}

double largest_cosine(Interval a) {
    constexpr double FARTHEST = 1e6;
    if (!(magnitude(a) < FARTHEST)) return 1.0;
    return std::min(1.0, magnitude(intervals::cos(a)) + 0x1p-40);
}

Slopes of_tangent(Interval a) {
    const double t = magnitude(intervals::tan(a)) * WIDER, s = 1.0 + t * t;
    return {s, s * t, s * (1.0 + 3.0 * t * t) / 3.0, s * t * (2.0 + 3.0 * t * t) / 3.0};
}

/// With s = 1 - tanh^2: s, - t s, (3 t^2 - 1) s / 3, (2 - 3 t^2) t s / 3.
Slopes of_hyperbolic_tangent(Interval a) {
    const double steep = 1.0 / elementary::cosh(least_magnitude(a)), s = steep * steep * WIDER;
    const double t = std::min(1.0, magnitude(a));
    return {s, s * t, 2.0 / 3.0 * s, 2.0 / 3.0 * s * t};
}

Slopes of_arc_sine(Interval a) {
    const double x = magnitude(a), w = WIDER / (1.0 - x * x);
    if (!(x < 1.0)) return {INFINITE, INFINITE, INFINITE, INFINITE};
    const double r = std::sqrt(w);
    return {r, x * r * w / 2.0, (1.0 + 2.0 * x * x) * r * w * w / 6.0,
            (9.0 + 6.0 * x * x) * x * r * w * w * w / 24.0};
}

/// 1 / sqrt((x - 1) (x + 1)) has coefficients at most (x - 1)^-k times itself.
Slopes of_arc_cosh(Interval a) {
    const double d = a.lo - 1.0, steep = WIDER / std::sqrt(d * (a.lo + 1.0)), x = WIDER / d;
    if (!(d > 0.0)) return {INFINITE, INFINITE, INFINITE, INFINITE};
    return {steep, steep * x / 2.0, steep * x * x / 3.0, steep * x * x * x / 4.0};
}

/// Functions of one operand that are smooth where they are known.
Slopes slopes_of(const Instruction& step, Interval a) {
    const auto waves = [](double x) { return Slopes{x, x / 2.0, x / 6.0, x / 24.0}; };
    switch (step.operation) {
        case Operation::RECIPROCAL:
            return of_power(a, -1.0);
        case Operation::INTEGER_POWER:
            return of_power(a, step.exponent);
        case Operation::SQRT:
            return of_power({std::max(a.lo, 0.0), a.hi}, 0.5);
        case Operation::CUBE_ROOT:
            return of_power(a, 1.0 / 3.0);
        case Operation::EXP:
            return waves(elementary::exp(a.hi) * WIDER);
        case Operation::SINH:
        case Operation::COSH:
            return waves(elementary::cosh(magnitude(a)) * WIDER);
        case Operation::LOG:
            return of_logarithm(std::max(a.lo, 0.0));
        case Operation::SIN:
            return of_waves(largest_sine(a), largest_cosine(a));
        case Operation::COS:
            return of_waves(largest_cosine(a), largest_sine(a));
        case Operation::TAN:
            return of_tangent(a);
        case Operation::TANH:
            return of_hyperbolic_tangent(a);
        case Operation::ASIN:
        case Operation::ACOS:
            return of_arc_sine(a);
        case Operation::ATAN:  // as far as i is from x, and -i
        case Operation::ASINH:
            return of_logarithm(std::sqrt(1.0 + least_magnitude(a) * least_magnitude(a)));
        case Operation::ACOSH:
            return of_arc_cosh(a);
        case Operation::ATANH:
            return of_logarithm(std::max(1.0 - magnitude(a), 0.0));
        case Operation::ERF:  // 2 / sqrt(pi) times the largest Hermite functions
            return {1.1284, 0.4841, 0.3762, 0.1840};
        default:
            return {INFINITE, INFINITE, INFINITE, INFINITE};
    }
}

bool is_constant(const Majorant& a) {
    return std::all_of(a.sizes.begin(), a.sizes.end(), [](double size) { return size == 0.0; });
}

/// a^b = exp(b log a).
Sizes power_of(const Majorant& a, const Majorant& b) {
    if (is_constant(b) && b.range.lo == b.range.hi) {
        const bool whole = b.range.lo == std::floor(b.range.lo);
        return a.range.lo > 0.0 || whole ? composed(of_power(a.range, b.range.lo), a.sizes)
                                         : UNKNOWN;
    }
    if (!(a.range.lo > 0.0)) return UNKNOWN;
    const Instruction logarithm{Operation::LOG, 0, {0, 0, 0}, 0};
    const Interval range = outward::widened(
        intervals::increasing(a.range, [](double x) { return elementary::log(x); }, 0.0), 3.0);
    const Majorant log = {range, composed(slopes_of(logarithm, a.range), a.sizes)};
    const Majorant exponent = {outward::multiply(b.range, range), multiply(b, log)};
    return composed(slopes_of({Operation::EXP, 0, {0, 0, 0}, 0}, exponent.range), exponent.sizes);
}

/// The argument of x + i y: the imaginary part of its logarithm.
Sizes angle_of(const Majorant& y, const Majorant& x) {
    if (x.range.lo <= 0.0 && intervals::holds_zero(y.range)) return UNKNOWN;
    const double across = least_magnitude(x.range), along = least_magnitude(y.range);
    const double radius = std::sqrt(across * across + along * along);
    return composed(of_logarithm(radius), sum(x.sizes, y.sizes));
}

/// Where it is known which of two it is.
Sizes chosen(bool first, bool second, const Majorant& a, const Majorant& b) {
    return first ? a.sizes : second ? b.sizes : UNKNOWN;
}

}  // namespace

Sizes of(const Instruction& step, const std::array<Majorant, 3>& operands) {
    const auto& [a, b, c] = operands;
    switch (step.operation) {
        case Operation::ADD:
        case Operation::SUBTRACT:
            return sum(a.sizes, b.sizes);
        case Operation::MULTIPLY:
            return multiply(a, b);
        case Operation::DIVIDE: {
            const Majorant inverse = {outward::reciprocal(b.range),
                                      composed(of_power(b.range, -1.0), b.sizes)};
            return multiply(a, inverse);
        }
        case Operation::NEGATIVE:
            return a.sizes;
        case Operation::ABSOLUTE:
            return chosen(a.range.lo > 0.0, a.range.hi < 0.0, a, a);
        case Operation::MINIMUM:
            return chosen(a.range.hi < b.range.lo, b.range.hi < a.range.lo, a, b);
        case Operation::MAXIMUM:
            return chosen(a.range.lo > b.range.hi, b.range.lo > a.range.hi, a, b);
        case Operation::CHOSEN:
            return chosen(a.range.lo > 0.0, a.range.hi < 0.0, b, c);
        case Operation::POWER:
            return power_of(a, b);
        case Operation::ANGLE:
            return angle_of(a, b);
        default:
            return composed(slopes_of(step, a.range), a.sizes);
    }
}

}  // namespace surfmesh::majorants
