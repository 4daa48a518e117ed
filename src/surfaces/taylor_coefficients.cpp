#include "surfaces/taylor_coefficients.hpp"

#include <algorithm>
#include <cmath>

#include "elementary_functions/logarithm.hpp"
#include "surfaces/ball.hpp"
#include "surfaces/function_slopes.hpp"
#include "surfaces/outward.hpp"

namespace surfmesh::taylor {
namespace {

using intervals::INFINITE;

constexpr double TINY = 1e-250;              // more than what underflows
constexpr double SERIES_ROUNDING = 0x1p-47;  // of a sum of products, of the size of each

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
