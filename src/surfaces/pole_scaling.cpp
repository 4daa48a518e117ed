#include "surfaces/pole_scaling.hpp"

#include <algorithm>
#include <cmath>

#include "elementary_functions/exponential.hpp"
#include "elementary_functions/inverse_trigonometric.hpp"
#include "elementary_functions/logarithm.hpp"
#include "elementary_functions/sine_cosine.hpp"
#include "surfaces/monotone_cubic.hpp"

namespace surfmesh {
namespace {

constexpr double POLE_TO_POLE = 3.141592653589793;

/// Newton's steps within an interval that is halved where they leave it, at most.
constexpr int FRACTION_STEPS = 60;
constexpr double INVERTED = 1e-15;

/// Poles at both ends.
ScaledFraction between_poles(double t, double first, double last) {
    const auto [sine, cosine] = elementary::sincos(POLE_TO_POLE * t);
    const double by_first = 0.5 * (1.0 + cosine), by_last = 0.5 * (1.0 - cosine);
    const double change = elementary::log(last / first);
    const double k = first * elementary::exp(by_last * change);
    const double square = sine * sine + (k * cosine) * (k * cosine);
    const double turned = -sine * cosine * k / (POLE_TO_POLE * square);  // by the logarithm of k
    const double slope = k * (1.0 - 0.5 * change * cosine * (sine * sine)) / square;
    return {elementary::atan2(sine, k * cosine) / POLE_TO_POLE, slope, by_first / first * turned,
            by_last / last * turned};
}

/// A pole at the beginning.
ScaledFraction beside_pole(double t, double k, double c) {
    const auto [sine, cosine] = elementary::sincos(c * t);
    const double whole = elementary::sincos(c).sine;
    const double z = sine / whole, rest = (1.0 - z) * (1.0 + z);
    const double root = std::sqrt(z * z + k * k * rest), cube = root * root * root;
    return {z / root, k * k / cube * (c * cosine / whole), -z * k * rest / cube, 0.0};
}

}  // namespace

ScaledFraction FractionScaling::at(double t) const {
    if (poles == PoleEnds::both) return between_poles(t, first, last);
    if (poles == PoleEnds::first) return beside_pole(t, first, c);
    const ScaledFraction found = beside_pole(1.0 - t, last, c);
    return {1.0 - found.value, found.by_t, 0.0, -found.by_first};
}

double FractionScaling::inverse(double w) const {
    if (w <= 0.0) return 0.0;
    if (w >= 1.0) return 1.0;
    double low = 0.0, high = 1.0, t = w;
    for (int step = 0; step < FRACTION_STEPS; ++step) {
        const ScaledFraction found = at(t);
        (found.value < w ? low : high) = t;
        double next = t - (found.value - w) / found.by_t;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        const bool done = std::abs(next - t) <= INVERTED * t;
        t = next;
        if (done) break;
    }
    return t;
}

EvenCubic::Value EvenCubic::at(double s) const {
    const auto cells = static_cast<std::ptrdiff_t>(values.size()) - 1;
    const double step = extent / static_cast<double>(cells);
    const double inside = std::min(std::max(0.0, s), extent);  // 0 for what is no number
    const auto i = std::min(static_cast<std::ptrdiff_t>(inside / step), cells - 1);
    const double t = inside / step - static_cast<double>(i);
    const double m = step * slopes[i], n = step * slopes[i + 1], d = values[i + 1] - values[i];
    const double b = 3.0 * d - 2.0 * m - n, c = m + n - 2.0 * d;
    const double rate = (m + t * (2.0 * b + 3.0 * t * c)) / step;
    return {values[i] + t * (m + t * (b + t * c)), s == inside ? rate : 0.0};
}

EvenCubic::Range PoleScaling::between(double t0, double t1, double s0, double s1) const {
    const auto one = first.between(s0, s1), other = last.between(s0, s1);
    // in its first half w falls with both k, in its second half it rises
    const auto lowest_first = [&](double t) {
        return poles == PoleEnds::first || (poles == PoleEnds::both && t < 0.5);
    };
    const auto w = [&](double t, double k0, double k1) {
        return FractionScaling{poles, c, k0, k1}.at(t).value;
    };
    const double least =
        lowest_first(t0) ? w(t0, one.most, other.most) : w(t0, one.least, other.least);
    const double most =
        lowest_first(t1) ? w(t1, one.least, other.least) : w(t1, one.most, other.most);
    return {least, most};
}

EvenCubic::Range EvenCubic::between(double first, double last) const {
    const double one = at(first).value, other = at(last).value;
    Range found{std::min(one, other), std::max(one, other)};
    const auto cells = static_cast<std::ptrdiff_t>(values.size()) - 1;
    const double step = extent / static_cast<double>(cells);
    const auto from = static_cast<std::ptrdiff_t>(std::max(first, 0.0) / step);
    for (std::ptrdiff_t i = from; i <= cells && static_cast<double>(i) * step <= last; ++i) {
        found.least = std::min(found.least, values[i]);
        found.most = std::max(found.most, values[i]);
    }
    return found;
}

EvenCubic even_cubic(double extent, Array<double> values) {
    const std::size_t count = values.size();
    Array<double> place(count);
    for (std::size_t k = 0; k < count; ++k)
        place[k] = extent * (static_cast<double>(k) / static_cast<double>(count - 1));
    const MonotoneCubic cubic(place, values);
    EvenCubic made{extent, std::move(values), Array<double>(count)};
    for (std::size_t k = 0; k < count; ++k) made.slopes[k] = cubic.derivative(place[k]);
    return made;
}

}  // namespace surfmesh
