#include "surfaces/taylor_coefficients.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "elementary_functions/exponential.hpp"
#include "elementary_functions/hyperbolic.hpp"
#include "elementary_functions/logarithm.hpp"
#include "elementary_functions/power.hpp"
#include "surfaces/ball.hpp"
#include "surfaces/outward.hpp"

namespace surfmesh::taylor {
namespace {

using intervals::INFINITE;
using outward::magnitude;

constexpr double TINY = 1e-250;              // more than what underflows
constexpr double FUNCTION_OFF = 0x1p-45;     // more than what functions are off, relative
constexpr double SERIES_ROUNDING = 0x1p-47;  // of a sum of products, of the size of each
constexpr double PHASE_OFF = 0x1p-40;        // of sines and cosines, whose phase is below FARTHEST
constexpr double FARTHEST = 1e6;

constexpr Ball ANY_NUMBER = {0.0, INFINITE};

Ball ball_of(Interval a, double off = 0.0) {
    if (!(magnitude(a) < INFINITE)) return ANY_NUMBER;
    const double mid = 0.5 * a.lo + 0.5 * a.hi;
    const double rad = std::max(a.hi - mid, mid - a.lo);
    return {mid, rad + off + FUNCTION_OFF * magnitude(a)};
}

Ball scaled(double factor, Ball a) { return {factor * a.mid, std::abs(factor) * a.rad}; }
Ball symmetric(double size) { return {0.0, size}; }

constexpr std::size_t number(std::size_t k, std::size_t l) {
    return (k + l) * (k + l + 1) / 2 + l - 1;
}

Coefficients unknown() {
    Coefficients found{};
    found.rad.fill(INFINITE);
    return found;
}

/// What the radius of a product is made of.
struct Sizes {
    std::array<double, COUNT> mid, rad, both;  // |mid|; rad with round-off; the sum of these
};

Sizes sizes_of(const Coefficients& a) {
    Sizes found;
    for (std::size_t k = 0; k < COUNT; ++k) {
        found.mid[k] = std::abs(a.mid[k]);
        found.rad[k] = a.rad[k] + SERIES_ROUNDING * found.mid[k];
        found.both[k] = found.mid[k] + found.rad[k];
    }
    return found;
}

/// What terms of orders N and M give of their product.
template <Variables V, std::size_t N, std::size_t M>
void add_terms(const Coefficients& a, const Coefficients& b, const Sizes& size,
               Coefficients& found) {
    constexpr std::size_t FROM = number(N, 0), OTHER = number(M, 0), INTO = number(N + M, 0);
    const auto term = [&](std::size_t j, std::size_t i) {
        const double mid = a.mid[FROM + j], rad = a.rad[FROM + j];
        found.mid[INTO + j + i] += mid * b.mid[OTHER + i];
        found.rad[INTO + j + i] += std::abs(mid) * size.rad[OTHER + i] + rad * size.both[OTHER + i];
    };
    const auto row = [&]<std::size_t... I>(std::size_t j, std::index_sequence<I...>) {
        (term(j, I), ...);
    };
    if constexpr (V == Variables::U)
        term(0, 0);
    else if constexpr (V == Variables::V)
        term(N, M);
    else
        for (std::size_t j = 0; j <= N; ++j) row(j, std::make_index_sequence<M + 1>());
}

/// The product of two series without their values, up to an order; size: of b.
template <Variables V, std::size_t HIGHEST = ORDER>
Coefficients product(const Coefficients& a, const Coefficients& b, const Sizes& size) {
    Coefficients found{};
    add_terms<V, 1, 1>(a, b, size, found);
    if constexpr (HIGHEST >= 3) {
        add_terms<V, 1, 2>(a, b, size, found);
        add_terms<V, 2, 1>(a, b, size, found);
    }
    if constexpr (HIGHEST >= 4) {
        add_terms<V, 1, 3>(a, b, size, found);
        add_terms<V, 2, 2>(a, b, size, found);
        add_terms<V, 3, 1>(a, b, size, found);
    }
    return found;
}

template <Variables V = Variables::BOTH, std::size_t HIGHEST = ORDER>
void add(Coefficients& a, Ball factor, const Coefficients& b) {
    const double most = std::abs(factor.mid) * (1.0 + SERIES_ROUNDING) + factor.rad;
    const auto term = [&](std::size_t k) {
        const double mid = std::abs(b.mid[k]);
        a.rad[k] += SERIES_ROUNDING * (std::abs(a.mid[k]) + most * mid) + factor.rad * mid +
                    most * b.rad[k];
        a.mid[k] += factor.mid * b.mid[k];
    };
    if constexpr (V == Variables::U)
        for (std::size_t k = 1; k <= HIGHEST; ++k) term(number(k, 0));
    else if constexpr (V == Variables::V)
        for (std::size_t k = 1; k <= HIGHEST; ++k) term(number(0, k));
    else
        for (std::size_t k = 0; k < number(HIGHEST + 1, 0); ++k) term(k);
}

/// What has underflowed is not 0.
Coefficients not_zero(Coefficients a) {
    for (double& rad : a.rad) rad += TINY;
    return a;
}

Coefficients sum(const Coefficients& a, double sign, const Coefficients& b) {
    Coefficients found = a;
    add(found, {sign, 0.0}, b);
    return found;
}

/// The product of a series in one variable, that of A, and of one in the other: s^k t^l comes from s^k
/// and t^l alone.
template <Variables A>
Coefficients product_across(const Coefficients& a, const Coefficients& b, const Sizes& size) {
    Coefficients found{};
    for (std::size_t k = 1; k < ORDER; ++k)
        for (std::size_t l = 1; k + l <= ORDER; ++l) {
            const std::size_t s = number(k, 0), t = number(0, l), into = number(k, l);
            const std::size_t i = A == Variables::U ? s : t, j = A == Variables::U ? t : s;
            found.mid[into] = a.mid[i] * b.mid[j];
            found.rad[into] = std::abs(a.mid[i]) * size.rad[j] + a.rad[i] * size.both[j];
        }
    return found;
}

/// The product of the series without their values, as far as it is not 0.
Coefficients product_of(const Operand& a, const Operand& b) {
    using enum Variables;
    if (a.variables == NONE || b.variables == NONE) return {};
    const Coefficients &x = a.coefficients, &y = b.coefficients;
    const Sizes size = sizes_of(y);
    if (a.variables == U && b.variables == V) return product_across<U>(x, y, size);
    if (a.variables == V && b.variables == U) return product_across<V>(x, y, size);
    if (a.variables == U && b.variables == U) return product<U>(x, y, size);
    if (a.variables == V && b.variables == V) return product<V>(x, y, size);
    return product<BOTH>(x, y, size);
}

Coefficients multiply(const Operand& a, const Operand& b) {
    Coefficients found = product_of(a, b);
    add(found, ball_of(a.range), b.coefficients);
    add(found, ball_of(b.range), a.coefficients);
    return not_zero(found);
}

/// Of f: f^(k) / k! over the operand's range, k = 1 ... 4.
using Slopes = std::array<Ball, ORDER>;

constexpr Slopes UNKNOWN_SLOPES = {ANY_NUMBER, ANY_NUMBER, ANY_NUMBER, ANY_NUMBER};

/// By Horner's rule; a has no value, so that what is multiplied by it n times more is wanted up to
/// the order 4 - n alone.
template <Variables V>
Coefficients composed_of(const Slopes& f, const Coefficients& a) {
    const Sizes size = sizes_of(a);
    Coefficients found{};
    add<V, 1>(found, f[3], a);
    found = product<V, 2>(found, a, size);
    add<V, 2>(found, f[2], a);
    found = product<V, 3>(found, a, size);
    add<V, 3>(found, f[1], a);
    found = product<V, 4>(found, a, size);
    add<V, 4>(found, f[0], a);
    return not_zero(found);
}

Coefficients composed(const Slopes& f, const Coefficients& a,
                      Variables variables = Variables::BOTH) {
    switch (variables) {
        case Variables::U:
            return composed_of<Variables::U>(f, a);
        case Variables::V:
            return composed_of<Variables::V>(f, a);
        default:
            return composed_of<Variables::BOTH>(f, a);
    }
}

double least_magnitude(Interval a) {
    return intervals::holds_zero(a) ? 0.0 : std::min(std::abs(a.lo), std::abs(a.hi));
}

/// |f^(k)| / k! at most radius^-k / k: of those that are as regular as the logarithm.
Slopes like_logarithm(double radius) {
    const double x = (1.0 + FUNCTION_OFF) / radius;
    return {symmetric(x), symmetric(x * x / 2.0), symmetric(x * x * x / 3.0),
            symmetric(x * x * x * x / 4.0)};
}

/// x^e for x >= 0: a product of few factors, or of a root's.
double power_of_number(double x, double e) {
    constexpr double MOST_FACTORS = 16.0;
    const double size = std::abs(e), whole = std::floor(size), rest = size - whole;
    if (!(size < MOST_FACTORS) || (rest != 0.0 && rest != 0.5)) return elementary::pow(x, e);
    double found = rest == 0.5 ? std::sqrt(x) : 1.0;
    for (double k = 0.0; k < whole; k += 1.0) found *= x;
    return e < 0.0 ? 1.0 / found : found;
}

/// x^e over a range, e whole or x > 0; of either sign elsewhere.
Ball power_range(Interval a, double e) {
    if (e == 0.0) return {1.0, 0.0};
    if (e == 1.0) return ball_of(a);
    const auto raised = [e](double x) { return power_of_number(x, e); };
    const double low = raised(least_magnitude(a)), high = raised(magnitude(a));
    const Interval size = {std::min(low, high), std::max(low, high)};
    if (a.lo > 0.0) return ball_of(size);
    if (e != std::floor(e)) return symmetric(size.hi * (1.0 + FUNCTION_OFF));
    const bool is_odd = std::floor(0.5 * e) != 0.5 * e;
    if (a.hi < 0.0) return is_odd ? ball_of({-size.hi, -size.lo}) : ball_of(size);
    if (e < 0.0) return ANY_NUMBER;
    if (!is_odd) return ball_of({0.0, size.hi});
    return ball_of({-raised(std::abs(a.lo)), raised(std::abs(a.hi))});
}

/// x^b, for b whole or x > 0.
Slopes of_power(Interval a, double b) {
    Slopes found{};
    double factor = 1.0;
    for (std::size_t k = 1; k <= ORDER; ++k) {
        const double left = b - static_cast<double>(k) + 1.0;
        factor *= left / static_cast<double>(k);
        if (factor == 0.0) break;
        found[k - 1] = scaled(factor, power_range(a, left - 1.0));
        found[k - 1].rad *= 1.0 + FUNCTION_OFF;
        found[k - 1].rad += FUNCTION_OFF * std::abs(found[k - 1].mid);
    }
    return found;
}

Slopes of_logarithm(Interval a) {
    Slopes found{};
    for (std::size_t k = 1; k <= ORDER; ++k) {
        const double n = static_cast<double>(k);
        found[k - 1] = scaled((k % 2 == 1 ? 1.0 : -1.0) / n, power_range(a, -n));
        found[k - 1].rad += FUNCTION_OFF * std::abs(found[k - 1].mid);
    }
    return found;
}

/// Of a function whose derivatives are first, second, - or + first ...
Slopes of_waves(Ball first, Ball second, double sign) {
    return {first, scaled(0.5, second), scaled(sign / 6.0, first), scaled(sign / 24.0, second)};
}

Ball sine_of(Interval a) {
    if (!(magnitude(a) < FARTHEST)) return symmetric(1.0);
    return ball_of(intervals::sin(a), PHASE_OFF);
}

Ball cosine_of(Interval a) {
    if (!(magnitude(a) < FARTHEST)) return symmetric(1.0);
    return ball_of(intervals::cos(a), PHASE_OFF);
}

/// With s = 1 + t^2: s, t s, (1 + 3 t^2) s / 3, (2 + 3 t^2) t s / 3. Of tanh the same with s = 1 - t^2,
/// - t s, (3 t^2 - 1) s / 3, (2 - 3 t^2) t s / 3.
Slopes of_tangent(Interval t, double sign) {
    namespace i = intervals;
    const auto times = [](double x, Interval a) {
        return x < 0.0 ? Interval{x * a.hi, x * a.lo} : Interval{x * a.lo, x * a.hi};
    };
    const Interval square = i::integer_power(t, 2);
    const Interval s = i::add({1.0, 1.0}, times(sign, square)), ts = i::multiply(t, s);
    const Interval third = i::add({sign, sign}, times(3.0, square)),
                   fourth = i::add({2.0, 2.0}, times(3.0 * sign, square));
    const double off = FUNCTION_OFF * (1.0 + magnitude(square)) * (1.0 + magnitude(square));
    return {ball_of(s, off), ball_of(times(sign, ts), off),
            scaled(1.0 / 3.0, ball_of(i::multiply(third, s), 4.0 * off)),
            scaled(1.0 / 3.0, ball_of(i::multiply(fourth, ts), 8.0 * off * (1.0 + magnitude(t))))};
}

Slopes of_arc_sine(Interval a) {
    const double x = magnitude(a), w = (1.0 + FUNCTION_OFF) / (1.0 - x * x);
    if (!(x < 1.0)) return UNKNOWN_SLOPES;
    const double r = std::sqrt(w);
    return {symmetric(r), symmetric(x * r * w / 2.0),
            symmetric((1.0 + 2.0 * x * x) * r * w * w / 6.0),
            symmetric((9.0 + 6.0 * x * x) * x * r * w * w * w / 24.0)};
}

/// 1 / sqrt((x - 1) (x + 1)) has coefficients at most (x - 1)^-k times itself.
Slopes of_arc_cosh(Interval a) {
    const double d = a.lo - 1.0, steep = (1.0 + FUNCTION_OFF) / std::sqrt(d * (a.lo + 1.0)),
                 x = (1.0 + FUNCTION_OFF) / d;
    if (!(d > 0.0)) return UNKNOWN_SLOPES;
    return {symmetric(steep), symmetric(steep * x / 2.0), symmetric(steep * x * x / 3.0),
            symmetric(steep * x * x * x / 4.0)};
}

Ball between(double low, double high) { return ball_of({low, high}); }

/// Functions of one operand that are smooth where they are known.
Slopes slopes_of(const Instruction& step, Interval a) {
    switch (step.operation) {
        case Operation::RECIPROCAL:
            return of_power(a, -1.0);
        case Operation::INTEGER_POWER:
            return of_power(a, step.exponent);
        case Operation::SQRT:
            return of_power({std::max(a.lo, 0.0), a.hi}, 0.5);
        case Operation::CUBE_ROOT:
            return of_power(a, 1.0 / 3.0);
        case Operation::EXP: {
            const Ball all = between(elementary::exp(a.lo), elementary::exp(a.hi));
            return of_waves(all, all, 1.0);
        }
        case Operation::SINH:
        case Operation::COSH: {
            const Ball sine = between(elementary::sinh(a.lo), elementary::sinh(a.hi)),
                       cosine = ball_of(intervals::cosh(a));
            return step.operation == Operation::SINH ? of_waves(cosine, sine, 1.0)
                                                     : of_waves(sine, cosine, 1.0);
        }
        case Operation::LOG:
            return of_logarithm({std::max(a.lo, 0.0), a.hi});
        case Operation::SIN:
            return of_waves(cosine_of(a), scaled(-1.0, sine_of(a)), -1.0);
        case Operation::COS:
            return of_waves(scaled(-1.0, sine_of(a)), scaled(-1.0, cosine_of(a)), -1.0);
        case Operation::TAN:
            return of_tangent(intervals::tan(a), 1.0);
        case Operation::TANH:
            return of_tangent({elementary::tanh(a.lo), elementary::tanh(a.hi)}, -1.0);
        case Operation::ASIN:
        case Operation::ACOS:
            return of_arc_sine(a);
        case Operation::ATAN:  // as far as i is from x, and -i
        case Operation::ASINH:
            return like_logarithm(std::sqrt(1.0 + least_magnitude(a) * least_magnitude(a)));
        case Operation::ACOSH:
            return of_arc_cosh(a);
        case Operation::ATANH:
            return like_logarithm(std::max(1.0 - magnitude(a), 0.0));
        case Operation::ERF:  // 2 / sqrt(pi) times the largest Hermite functions
            return {symmetric(1.1284), symmetric(0.4841), symmetric(0.3762), symmetric(0.1840)};
        default:
            return UNKNOWN_SLOPES;
    }
}

bool is_constant(const Operand& a) {
    const auto is_zero = [](double x) { return x == 0.0; };
    const Coefficients& c = a.coefficients;
    return std::all_of(c.mid.begin(), c.mid.end(), is_zero) &&
           std::all_of(c.rad.begin(), c.rad.end(), is_zero);
}

/// a^b = exp(b log a).
Coefficients power_of(const Operand& a, const Operand& b) {
    if (is_constant(b) && b.range.lo == b.range.hi) {
        const bool whole = b.range.lo == std::floor(b.range.lo);
        if (!(a.range.lo > 0.0) && !whole) return unknown();
        return composed(of_power(a.range, b.range.lo), a.coefficients, a.variables);
    }
    if (!(a.range.lo > 0.0)) return unknown();
    const Interval range = outward::widened(
        intervals::increasing(a.range, [](double x) { return elementary::log(x); }, 0.0), 3.0);
    const Coefficients log = composed(of_logarithm(a.range), a.coefficients);
    const Coefficients exponent = multiply(b, {range, log});
    const Instruction exponential{Operation::EXP, 0, {0, 0, 0}, 0};
    return composed(slopes_of(exponential, outward::multiply(b.range, range)), exponent);
}

/// The argument of x + i y: the imaginary part of its logarithm, by absolute values.
Coefficients angle_of(const Operand& y, const Operand& x) {
    if (x.range.lo <= 0.0 && intervals::holds_zero(y.range)) return unknown();
    const double across = least_magnitude(x.range), along = least_magnitude(y.range);
    const double radius = std::sqrt(across * across + along * along);
    Coefficients both{};
    for (std::size_t k = 0; k < COUNT; ++k)
        both.rad[k] = std::abs(x.coefficients.mid[k]) + x.coefficients.rad[k] +
                      std::abs(y.coefficients.mid[k]) + y.coefficients.rad[k];
    return composed(like_logarithm(radius), both);
}

/// Where it is known which of two it is.
Coefficients chosen(bool first, bool second, const Operand& a, const Operand& b) {
    return first ? a.coefficients : second ? b.coefficients : unknown();
}

Coefficients negative(Coefficients a) {
    for (double& mid : a.mid) mid = -mid;
    return a;
}

}  // namespace

Coefficients of(const Instruction& step, const std::array<Operand, 3>& operands) {
    const auto& [a, b, c] = operands;
    switch (step.operation) {
        case Operation::ADD:
            return sum(a.coefficients, 1.0, b.coefficients);
        case Operation::SUBTRACT:
            return sum(a.coefficients, -1.0, b.coefficients);
        case Operation::MULTIPLY:
            return multiply(a, b);
        case Operation::DIVIDE: {
            const Coefficients inverse =
                composed(of_power(b.range, -1.0), b.coefficients, b.variables);
            return multiply(a, {outward::reciprocal(b.range), inverse, b.variables});
        }
        case Operation::NEGATIVE:
            return negative(a.coefficients);
        case Operation::ABSOLUTE:
            return a.range.hi < 0.0 ? negative(a.coefficients)
                                    : chosen(a.range.lo > 0.0, false, a, a);
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
            return composed(slopes_of(step, a.range), a.coefficients, a.variables);
    }
}

}  // namespace surfmesh::taylor
