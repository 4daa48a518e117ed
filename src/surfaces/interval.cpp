#include "surfaces/interval.hpp"

#include <bit>
#include <numbers>

#include "elementary_functions/hyperbolic.hpp"
#include "elementary_functions/inverse_trigonometric.hpp"
#include "elementary_functions/power.hpp"
#include "elementary_functions/sine_cosine.hpp"

namespace surfmesh::intervals {
namespace {

constexpr double PI = std::numbers::pi, TAU = 2.0 * PI;

/// Of an interval: a zero so near to one of its ends counts as no break inside.
constexpr double AT_THE_END = 1e-12;

constexpr Interval WHOLE_LINE{-INFINITE, INFINITE};

/// x^n for n >= 2, as tapes compute it at points.
double repeated(double x, std::int32_t n) {
    double result = 1.0;
    for (int bit = std::bit_width(static_cast<std::uint32_t>(n)) - 1; bit >= 0; --bit) {
        result *= result;
        if (n >> bit & 1) result *= x;
    }
    return result;
}

/// The range of corners of a box.
Interval around(double p, double q, double r, double s) {
    return {smaller(smaller(p, q), smaller(r, s)), larger(larger(p, q), larger(r, s))};
}

/// Does [lo, hi] hold a point at `phase` of a wave of period 2 pi?
bool holds_phase(Interval a, double phase) {
    // the widened ends keep a crest that sits on an end point, whatever its round-off
    const double slack = 1e-15 * (1.0 + std::abs(a.lo) + std::abs(a.hi));
    return std::ceil((a.lo - slack - phase) / TAU) * TAU + phase <= a.hi + slack;
}

/// Range of a wave of period 2 pi with a crest (+1) at `crest` and a trough half way on.
Interval wave(Interval a, double (*f)(double), double crest) {
    if (!std::isfinite(a.lo) || !std::isfinite(a.hi)) return {-1.0, 1.0};
    const double first = f(a.lo), last = a.hi == a.lo ? first : f(a.hi);
    return {holds_phase(a, crest + 0.5 * TAU) ? -1.0 : smaller(first, last),
            holds_phase(a, crest) ? 1.0 : larger(first, last)};
}

double heaviside(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? 0.0 : x == 0.0 ? 0.5 : x; }
double sign(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : x == 0.0 ? 0.0 : x; }

/// Is zero inside the interval, not only at one of its ends?
bool inside(Interval a) {
    const double slack = AT_THE_END * larger(std::abs(a.lo), std::abs(a.hi));
    return (a.lo < -slack && a.hi > slack) || (a.lo == 0.0 && a.hi == 0.0);
}

Interval unbounded_where(bool broken) { return broken ? WHOLE_LINE : Interval{0.0, 0.0}; }

bool meets_cut(Interval y, Interval x) { return x.lo <= 0.0 && y.lo <= 0.0 && y.hi >= 0.0; }

Interval angle_of_corners(Interval y, Interval x) {
    using elementary::atan2;
    return around(atan2(y.lo, x.lo), atan2(y.lo, x.hi), atan2(y.hi, x.lo), atan2(y.hi, x.hi));
}

/// a^b for a >= 0, monotone along both sides of the box.
Interval power_of_positive(Interval a, Interval b) {
    using elementary::pow;
    const Interval all = around(pow(a.lo, b.lo), pow(a.lo, b.hi), pow(a.hi, b.lo), pow(a.hi, b.hi));
    // 0^0 = 1 stands alone beside 0^y = 0
    return known(a.lo == 0.0 && b.hi > 0.0 ? 0.0 : all.lo, all.hi);
}

/// a^b where a holds negative numbers and b a whole one.
Interval power_of_any_sign(Interval a, Interval b) {
    const Interval size = power_of_positive(absolute(a), b);
    if (b.lo != b.hi) return {-size.hi, size.hi};
    if (std::floor(0.5 * b.lo) == 0.5 * b.lo) return size;
    if (b.lo < 0.0) return holds_zero(a) ? WHOLE_LINE : negative(size);
    return known(elementary::pow(a.lo, b.lo), elementary::pow(a.hi, b.lo));
}

}  // namespace

Interval integer_power(Interval a, std::int32_t n) {
    const double low = repeated(a.lo, n), high = repeated(a.hi, n);
    if (n % 2 != 0) return known(low, high);
    return known(holds_zero(a) ? 0.0 : smaller(low, high), larger(low, high));
}

Interval power(Interval a, Interval b) {
    if (a.lo < 0.0 && std::ceil(b.lo) <= b.hi) return power_of_any_sign(a, b);
    if (a.hi < 0.0) return WHOLE_LINE;
    return power_of_positive({larger(a.lo, 0.0), a.hi}, b);
}

Interval sin(Interval a) { return wave(a, elementary::sin, 0.25 * TAU); }
Interval cos(Interval a) { return wave(a, elementary::cos, 0.0); }

Interval tan(Interval a) {
    const bool one_branch = std::floor(a.lo / PI + 0.5) == std::floor(a.hi / PI + 0.5);
    if (!one_branch || !(a.hi - a.lo < PI)) return WHOLE_LINE;
    return known(elementary::tan(a.lo), elementary::tan(a.hi));
}

Interval acos(Interval a) {
    return known(elementary::acos(smaller(a.hi, 1.0)), elementary::acos(larger(a.lo, -1.0)));
}

Interval cosh(Interval a) { return increasing(absolute(a), elementary::cosh); }

Interval angle(Interval y, Interval x) {
    if (meets_cut(y, x)) return {-PI, PI};
    const Interval all = angle_of_corners(y, x);
    return known(all.lo, all.hi);
}

Interval turn(Interval y, Interval x) {
    if (!meets_cut(y, x) || !(x.hi < 0.0)) return angle(y, x);
    const Interval back = angle(negative(y), negative(x));
    return {back.lo + PI, back.hi + PI};
}

Interval steady(Interval a, double (*f)(double), double rate, double lowest, double highest) {
    const double reach = 0.5 * rate * (a.hi - a.lo), middle = f(0.5 * (a.lo + a.hi));
    const double lo = larger(middle - reach, lowest), hi = smaller(middle + reach, highest);
    return lo <= hi ? Interval{lo, hi} : Interval{lowest, highest};  // an end may be infinite
}

Interval step(Interval a) { return {heaviside(a.lo), heaviside(a.hi)}; }
Interval signum(Interval a) { return known(sign(a.lo), sign(a.hi)); }

Interval slope_step(Interval a) {
    const bool broken = inside(a), above = a.hi > -a.lo;
    return {broken || !above ? 0.0 : 1.0, broken || above ? 1.0 : 0.0};
}

Interval slope_side(Interval a) {
    const Interval step = slope_step(a);
    return {2.0 * step.lo - 1.0, 2.0 * step.hi - 1.0};
}

Interval kink(Interval a) { return unbounded_where(inside(a) || !(a.lo <= a.hi)); }
Interval jump(Interval a) { return unbounded_where(!(a.lo > 0.0 || a.hi < 0.0)); }

Interval tread(Interval a) {
    const double below = std::floor(a.lo);
    return unbounded_where(!(below == std::floor(a.hi) && below < a.lo));
}

Interval cut(Interval y, Interval x) {
    return unbounded_where(!(x.lo > 0.0 || y.lo > 0.0 || y.hi < 0.0));
}

Interval chosen(Interval d, Interval a, Interval b) {
    if (d.lo >= 0.0) return known(a.lo, a.hi);
    if (d.hi < 0.0) return known(b.lo, b.hi);
    return known(smaller(a.lo, b.lo), larger(a.hi, b.hi));
}

}  // namespace surfmesh::intervals
