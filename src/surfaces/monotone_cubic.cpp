#include "surfaces/monotone_cubic.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh {
namespace {

double sign_of(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : x; }

/// From the lengths and slopes of the step at the end and of the next one.
double end_slope(double h0, double h1, double m0, double m1) {
    const double parabola = ((2.0 * h0 + h1) * m0 - h0 * m1) / (h0 + h1);
    if (sign_of(parabola) != sign_of(m0)) return 0.0;
    if (sign_of(m0) != sign_of(m1) && std::abs(parabola) > 3.0 * std::abs(m0)) return 3.0 * m0;
    return parabola;
}

/// Slope at a point between two steps.
double inner_slope(double before, double after, double left, double right) {
    if (sign_of(left) != sign_of(right) || left == 0.0 || right == 0.0) return 0.0;
    const double first = 2.0 * after + before, second = after + 2.0 * before;
    const double mean = (first / left + second / right) / (first + second);
    return 1.0 / mean;
}

}  // namespace

MonotoneCubic::MonotoneCubic(std::span<const double> x, std::span<const double> y)
    : x_(x), pieces_(x.size() - 1) {
    const std::size_t steps = x.size() - 1;
    Array<double> step(steps), slope(steps), at_points(x.size());
    for (std::size_t k = 0; k < steps; ++k) {
        step[k] = x[k + 1] - x[k];
        slope[k] = (y[k + 1] - y[k]) / step[k];
    }
    if (steps == 1) {
        at_points.fill(slope[0]);
    } else {
        at_points[0] = end_slope(step[0], step[1], slope[0], slope[1]);
        for (std::size_t k = 1; k < steps; ++k)
            at_points[k] = inner_slope(step[k - 1], step[k], slope[k - 1], slope[k]);
        at_points[steps] =
            end_slope(step[steps - 1], step[steps - 2], slope[steps - 1], slope[steps - 2]);
    }
    for (std::size_t k = 0; k < steps; ++k) {
        const double bend = (at_points[k] + at_points[k + 1] - 2.0 * slope[k]) / step[k];
        pieces_[k] = {
            {y[k], at_points[k], (slope[k] - at_points[k]) / step[k] - bend, bend / step[k]}};
    }
}

/// The piece that x lies in, the right one at a point.
std::ptrdiff_t MonotoneCubic::piece_at(double x) const {
    const std::ptrdiff_t after = std::upper_bound(x_.begin(), x_.end(), x) - x_.begin();
    return std::clamp<std::ptrdiff_t>(after - 1, 0,
                                      static_cast<std::ptrdiff_t>(pieces_.size()) - 1);
}

double MonotoneCubic::value(double x) const {
    const std::ptrdiff_t k = piece_at(x);
    const auto& c = pieces_[k].c;
    const double w = x - x_[k], w2 = w * w, w3 = w2 * w;
    return c[0] + c[1] * w + c[2] * w2 + c[3] * w3;
}

double MonotoneCubic::derivative(double x) const {
    const std::ptrdiff_t k = piece_at(x);
    const auto& c = pieces_[k].c;
    const double w = x - x_[k], w2 = w * w;
    return c[1] + c[2] * 2.0 * w + c[3] * 3.0 * w2;
}

}  // namespace surfmesh
