#include "surfaces/chart.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "elementary_functions/incomplete_beta.hpp"
#include "elementary_functions/power.hpp"

namespace surfmesh {
namespace {

/// Newton's steps from the piecewise linear inverse, which is a cell away at most.
constexpr int INVERSION_STEPS = 6;

/// The parameter or the bent one, and its derivative by x: cubic Hermite interpolation.
ValueAndRate knotted(const ChartAxis& axis, double x) {
    if (axis.knots.size() == 2) return {axis.knots[0] + x * axis.slopes[0], axis.slopes[0]};
    const auto cells = static_cast<std::int64_t>(axis.knots.size()) - 1;
    const double step = axis.extent / static_cast<double>(cells);
    const double inside = std::min(std::max(0.0, x), axis.extent);  // 0 for what is no number
    const std::int64_t i = std::min(static_cast<std::int64_t>(inside / step), cells - 1);
    const double t = inside / step - static_cast<double>(i);
    const double m = step * axis.slopes[i], n = step * axis.slopes[i + 1];
    const double d = axis.knots[i + 1] - axis.knots[i];
    const double b = 3.0 * d - 2.0 * m - n, c = m + n - 2.0 * d;
    const double rate = (m + t * (2.0 * b + 3.0 * t * c)) / step;
    return {axis.knots[i] + t * (m + t * (b + t * c)) + (x - inside) * rate, rate};
}

/// The piece that holds s, or the nearest one.
const BentPiece& piece_at(const Array<BentPiece>& pieces, double s) {
    std::ptrdiff_t k = static_cast<std::ptrdiff_t>(pieces.size()) - 1;
    while (k > 0 && s < pieces[k].first) --k;
    return pieces[k];
}

double clipped(double x, double low, double high) { return std::min(std::max(x, low), high); }

/// The coordinate of a parameter where the axis is linear from knot to knot.
double piecewise_linear(const ChartAxis& axis, double u) {
    const Array<double>& knots = axis.knots;
    const auto last = static_cast<std::ptrdiff_t>(knots.size()) - 1;
    const double step = axis.extent / static_cast<double>(last);
    if (!(u < knots[last])) return std::isnan(u) ? u : step * static_cast<double>(last);
    if (u < knots[0]) return 0.0;
    const std::ptrdiff_t i = std::upper_bound(knots.begin(), knots.end(), u) - knots.begin() - 1;
    const double low = step * static_cast<double>(i), high = step * static_cast<double>(i + 1);
    return (high - low) / (knots[i + 1] - knots[i]) * (u - knots[i]) + low;
}

}  // namespace

double unbent(const Array<BentPiece>& pieces, double s) {
    const BentPiece& p = piece_at(pieces, s);
    const double width = p.last - p.first;
    const double before = clipped((s - p.first) / width, 0.0, 1.0);
    const double after = clipped((p.last - s) / width, 0.0, 1.0);
    if (before < 0.5)
        return p.first + width * elementary::incomplete_beta(p.q0, p.q1, p.beta, before);
    return p.last - width * elementary::incomplete_beta(p.q1, p.q0, p.beta, after);
}

double rate_of_bending(const Array<BentPiece>& pieces, double s) {
    const BentPiece& at = piece_at(pieces, s);
    const double wide = at.last - at.first;
    s = clipped(s, at.first + at.clearance0 * wide, at.last - at.clearance1 * wide);
    const BentPiece& p = piece_at(pieces, s);
    const double width = p.last - p.first;
    const double before = (s - p.first) / width, after = (p.last - s) / width;
    return elementary::pow(before, p.q0 - 1.0) * elementary::pow(after, p.q1 - 1.0) / p.beta;
}

ValueAndRate ChartAxis::parameter(double x) const {
    const ValueAndRate found = knotted(*this, x);
    if (pieces.empty()) return found;
    return {unbent(pieces, found.value), found.rate * rate_of_bending(pieces, found.value)};
}

double ChartAxis::coordinate(double given) const {
    if (given == knots.end()[-1]) return extent;
    if (given == knots[0]) return 0.0;
    double x = piecewise_linear(*this, given);
    if (knots.size() == 2) return x;
    for (int k = 0; k < INVERSION_STEPS; ++k) {
        const ValueAndRate at = knotted(*this, x);
        x = clipped(x - (at.value - given) / at.rate, 0.0, extent);
    }
    return x;
}

ChartPoint Chart::at(Point2 xy) const {
    const ValueAndRate a = u.parameter(xy.x), b = v.parameter(xy.y);
    return {{a.value, b.value}, {a.rate, b.rate}};
}

Array<Point2> Chart::to_uv(std::span<const Point2> xy) const {
    Array<Point2> uv(xy.size());
    for (std::size_t i = 0; i < xy.size(); ++i) uv[i] = to_uv(xy[i]);
    return uv;
}

Array<Point2> Chart::to_plane(std::span<const Point2> uv) const {
    Array<Point2> xy(uv.size());
    for (std::size_t i = 0; i < uv.size(); ++i) xy[i] = to_plane(uv[i]);
    return xy;
}

}  // namespace surfmesh
