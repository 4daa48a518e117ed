#include "surfaces/function_slopes.hpp"

#include <algorithm>
#include <cmath>

#include "elementary_functions/exponential.hpp"
#include "elementary_functions/hyperbolic.hpp"
#include "elementary_functions/power.hpp"

namespace surfmesh::taylor {
namespace {

using outward::magnitude;

constexpr double PHASE_OFF = 0x1p-40;  // of sines and cosines, whose phase is below FARTHEST
constexpr double FARTHEST = 1e6;

constexpr Slopes UNKNOWN_SLOPES = {ANY_NUMBER, ANY_NUMBER, ANY_NUMBER, ANY_NUMBER};

Ball scaled(double factor, Ball a) { return {factor * a.mid, std::abs(factor) * a.rad}; }
Ball symmetric(double size) { return {0.0, size}; }

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

}  // namespace

Slopes like_logarithm(double radius) {
    const double x = (1.0 + FUNCTION_OFF) / radius;
    return {symmetric(x), symmetric(x * x / 2.0), symmetric(x * x * x / 3.0),
            symmetric(x * x * x * x / 4.0)};
}

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

}  // namespace surfmesh::taylor
