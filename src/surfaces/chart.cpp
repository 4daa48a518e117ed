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
class Knots {
  public:
    explicit Knots(const ChartAxis& axis)
        : axis_(axis),
          cells_(static_cast<std::int64_t>(axis.knots.size()) - 1),
          step_(axis.extent / static_cast<double>(cells_)) {}

    [[nodiscard]] bool are_even() const { return cells_ == 1; }
    [[nodiscard]] ValueAndRate at(double x) const {
        if (are_even()) return {axis_.knots[0] + x * axis_.slopes[0], axis_.slopes[0]};
        const double inside = std::min(std::max(0.0, x), axis_.extent);  // 0 for what is no number
        const Cubic cubic(*this, inside);
        const double rate = cubic.rate() / step_;
        return {cubic.value() + (x - inside) * rate, rate};
    }
    /// The same without the rate, which only points outside need.
    [[nodiscard]] double value_at(double x) const {
        if (are_even() || !(x >= 0.0 && x <= axis_.extent)) return at(x).value;
        return Cubic(*this, x).value() + 0.0;
    }

  private:
    /// Between two knots, t from one to the other.
    struct Cubic {
        double first, t, m, b, c;

        Cubic(const Knots& k, double inside) {
            const double place = inside / k.step_;
            const std::int64_t i = std::min(static_cast<std::int64_t>(place), k.cells_ - 1);
            t = place - static_cast<double>(i);
            m = k.step_ * k.axis_.slopes[i];
            first = k.axis_.knots[i];
            const double n = k.step_ * k.axis_.slopes[i + 1], d = k.axis_.knots[i + 1] - first;
            b = 3.0 * d - 2.0 * m - n;
            c = m + n - 2.0 * d;
        }
        [[nodiscard]] double value() const { return first + t * (m + t * (b + t * c)); }
        [[nodiscard]] double rate() const { return m + t * (2.0 * b + 3.0 * t * c); }
    };

    const ChartAxis& axis_;
    std::int64_t cells_;
    double step_;
};

/// Fill in one parameter of many points.
template <class Coordinate>
void fill_parameters(const ChartAxis& axis, std::span<const Point2> xy, Coordinate coordinate,
                     Array<Point2>& uv) {
    const Knots knots(axis);
    const bool bent = !axis.pieces.empty();
    for (std::size_t i = 0; i < xy.size(); ++i) {
        const double value = knots.value_at(xy[i].*coordinate);
        uv[i].*coordinate = bent ? unbent(axis.pieces, value) : value;
    }
}

/// The piece that holds s, or the nearest one.
const BentPiece& piece_at(const Array<BentPiece>& pieces, double s) {
    std::ptrdiff_t k = static_cast<std::ptrdiff_t>(pieces.size()) - 1;
    while (k > 0 && s < pieces[k].first) --k;
    return pieces[k];
}

double clipped(double x, double low, double high) { return std::min(std::max(x, low), high); }

/// Coordinates of many parameters: of one that is that of the point before, as along a line in the
/// direction of the other axis, it is known.
template <class Parameter>
void fill_coordinates(const ChartAxis& axis, std::span<const Point2> uv, Parameter parameter,
                      Array<Point2>& xy) {
    for (std::size_t i = 0; i < uv.size(); ++i) {
        const bool is_known = i > 0 && uv[i].*parameter == uv[i - 1].*parameter;
        xy[i].*parameter = is_known ? xy[i - 1].*parameter : axis.coordinate(uv[i].*parameter);
    }
}

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

/// Where one axis is scaled by the other coordinate; linear beyond its ends.
ChartPoint scaled_at(const Chart& chart, Point2 xy) {
    const PoleScaling& scaling = chart.scaling;
    const bool along_u = scaling.axis == 0;
    const ChartAxis& radial = along_u ? chart.u : chart.v;
    const ChartAxis& other = along_u ? chart.v : chart.u;
    const double s = along_u ? xy.y : xy.x, y = along_u ? xy.x : xy.y;
    const EvenCubic::Value first = scaling.first.at(s), last = scaling.last.at(s);
    const double t = y / radial.extent, inside = clipped(t, 0.0, 1.0);
    const ScaledFraction w =
        FractionScaling{scaling.poles, scaling.c, first.value, last.value}.at(inside);
    const ValueAndRate around = other.parameter(s);
    const ValueAndRate out = radial.parameter(radial.extent * (w.value + (t - inside) * w.by_t));
    const double turned = w.by_first * first.rate + w.by_last * last.rate;
    const double rate = out.rate * w.by_t, crossed = out.rate * radial.extent * turned;
    if (along_u) return {{out.value, around.value}, {rate, around.rate}, {crossed, 0.0}};
    return {{around.value, out.value}, {around.rate, rate}, {0.0, crossed}};
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
    const ValueAndRate found = Knots(*this).at(x);
    if (pieces.empty()) return found;
    return {unbent(pieces, found.value), found.rate * rate_of_bending(pieces, found.value)};
}

double ChartAxis::coordinate(double given) const {
    if (given == knots.end()[-1]) return extent;
    if (given == knots[0]) return 0.0;
    double x = piecewise_linear(*this, given);
    if (knots.size() == 2) return x;
    const Knots by_knots(*this);
    for (int k = 0; k < INVERSION_STEPS; ++k) {
        const ValueAndRate at = by_knots.at(x);
        const double next = clipped(x - (at.value - given) / at.rate, 0.0, extent);
        if (next == x) break;  // as all steps from here would be
        x = next;
    }
    return x;
}

ChartPoint Chart::at(Point2 xy) const {
    if (!scaling.is_none()) return scaled_at(*this, xy);
    const ValueAndRate a = u.parameter(xy.x), b = v.parameter(xy.y);
    return {{a.value, b.value}, {a.rate, b.rate}};
}

Point2 Chart::to_plane(Point2 uv) const {
    Point2 xy{u.coordinate(uv.x), v.coordinate(uv.y)};
    if (scaling.is_none()) return xy;
    const bool along_u = scaling.axis == 0;
    double& radial = along_u ? xy.x : xy.y;
    const double extent = along_u ? u.extent : v.extent;
    radial = scaling.beside(along_u ? xy.y : xy.x).inverse(radial / extent) * extent;
    return xy;
}

ParameterBox Chart::to_box(Point2 low, Point2 high) const {
    if (scaling.is_none()) return {to_uv(low), to_uv(high)};
    const bool along_u = scaling.axis == 0;
    const double first = along_u ? low.y : low.x, last = along_u ? high.y : high.x;
    const double extent = along_u ? u.extent : v.extent;
    double& lower = along_u ? low.x : low.y;
    double& upper = along_u ? high.x : high.y;
    const auto [least, most] = scaling.between(clipped(lower / extent, 0.0, 1.0),
                                               clipped(upper / extent, 0.0, 1.0), first, last);
    lower = extent * least;
    upper = extent * most;
    return {{u.parameter(low.x).value, v.parameter(low.y).value},
            {u.parameter(high.x).value, v.parameter(high.y).value}};
}

Array<Point2> Chart::to_uv(std::span<const Point2> xy) const {
    Array<Point2> uv(xy.size());
    if (!scaling.is_none()) {
        for (std::size_t i = 0; i < xy.size(); ++i) uv[i] = to_uv(xy[i]);
        return uv;
    }
    fill_parameters(u, xy, &Point2::x, uv);
    fill_parameters(v, xy, &Point2::y, uv);
    return uv;
}

Array<Point2> Chart::to_plane(std::span<const Point2> uv) const {
    Array<Point2> xy(uv.size());
    if (!scaling.is_none()) {
        for (std::size_t i = 0; i < uv.size(); ++i) xy[i] = to_plane(uv[i]);
        return xy;
    }
    fill_coordinates(u, uv, &Point2::x, xy);
    fill_coordinates(v, uv, &Point2::y, xy);
    return xy;
}

}  // namespace surfmesh
