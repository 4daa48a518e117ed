// Bounds of derivatives of splines over cells and ranges, by control points.
//
// Derivatives of a spline are splines whose control points are differences of its own; over a
// cell they lie between those of the spans that it meets. A rational one is S = A / w, and so
//
//     w S^(k,l) = A^(k,l) - sum of (k over i) (l over j) w^(i,j) S^(k-i,l-j),  i + j > 0
//
// with A taken about a point in the middle of the cell's control points (Piegl and Tiller, The
// NURBS Book, 4.2).
#include <algorithm>
#include <cmath>

#include "surfaces/spline_curve.hpp"
#include "surfaces/spline_surface.hpp"

namespace surfmesh {
namespace {

constexpr double SLACK = 1e-12;  // of the knots' range: what rounding leaves beyond their ends

/// A control point times its weight, and the weight.
struct WeightedPoint {
    Point3 point;
    double weight;
};

WeightedPoint operator-(const WeightedPoint& a, const WeightedPoint& b) {
    return {a.point - b.point, a.weight - b.weight};
}
WeightedPoint operator*(double s, const WeightedPoint& a) { return {s * a.point, s * a.weight}; }

Point3 control_size(Point3 p) { return {std::abs(p.x), std::abs(p.y), std::abs(p.z)}; }

Point3 larger(Point3 a, Point3 b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

/// Control points of some spans both ways, rows of v.
struct ControlNet {
    std::int64_t rows, columns;
    Array<WeightedPoint> points;

    [[nodiscard]] WeightedPoint at(std::int64_t i, std::int64_t j) const {
        return points[i * columns + j];
    }
};

/// The largest control_size values of a net's points and weights.
WeightedPoint magnitude_of(const ControlNet& net) {
    WeightedPoint found{{0.0, 0.0, 0.0}, 0.0};
    for (const WeightedPoint& own : net.points) {
        found.point = larger(found.point, control_size(own.point));
        found.weight = std::max(found.weight, std::abs(own.weight));
    }
    return found;
}

/// The net of the derivative by u (or v) of a net that is the derivative ``times`` already; its
/// first point is number ``first`` of the whole. Empty above the degree.
ControlNet derived(const ControlNet& net, const SplineBasis& basis, std::int64_t first, int times,
                   bool by_u) {
    ControlNet found{by_u ? net.rows - 1 : net.rows, by_u ? net.columns : net.columns - 1, {}};
    if (found.rows < 1 || found.columns < 1) return {0, 0, {}};
    for (std::int64_t i = 0; i < found.rows; ++i)
        for (std::int64_t j = 0; j < found.columns; ++j) {
            const double factor = basis.difference_factor(first + (by_u ? i : j), times);
            found.points.push_back(factor *
                                   (net.at(i + (by_u ? 1 : 0), j + (by_u ? 0 : 1)) - net.at(i, j)));
        }
    return found;
}

/// Magnitudes of the derivatives of w r and w, in the sequence of the surface's.
using Magnitudes = std::array<WeightedPoint, 10>;

/// Bounds of derivatives k >= 1 of r from those of w r and w; least: of w.
void divide_by_weight(const Magnitudes& part, double least, std::size_t count,
                      std::span<Point3> out) {
    std::array<Point3, 10> r{};
    for (std::size_t number = 0; number < count; ++number) {
        const auto [k, l] = DERIVATIVES[number];
        Point3 value = part[number].point;
        double outer = 1.0;  // binomial coefficients k over i, and l over j
        for (int i = 0; i <= k; ++i) {
            double inner = outer;
            for (int j = 0; j <= l; ++j) {
                if (i + j > 0)
                    value = value + inner * part[derivative_number(i, j)].weight *
                                        r[derivative_number(k - i, l - j)];
                inner = inner * (l - j) / (j + 1);
            }
            outer = outer * (k - i) / (i + 1);
        }
        r[number] = (1.0 / least) * value;
        out[number] = number == 0 ? Point3{0.0, 0.0, 0.0} : r[number];
    }
}

/// Points of the net about the middle of their box; returns the least weight.
double centre(ControlNet& net) {
    const auto own = [](const WeightedPoint& h) { return (1.0 / h.weight) * h.point; };
    Point3 low = own(net.points[0]), high = low;
    double least = net.points[0].weight;
    for (const WeightedPoint& h : net.points) {
        const Point3 p = own(h);
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = larger(high, p);
        least = std::min(least, h.weight);
    }
    const Point3 middle = 0.5 * (low + high);
    for (WeightedPoint& h : net.points) h.point = h.point - h.weight * middle;
    return least;
}

}  // namespace

SpanRange SplineBasis::spans(double low, double high) const {
    const auto count = static_cast<std::int64_t>(knots_.size()) - degree_ - 1;
    const double begin = knots_[degree_], end = knots_[count];
    if (limits_.period > 0.0) {
        const double turns =
            limits_.period * std::floor((0.5 * (low + high) - begin) / limits_.period);
        low -= turns;
        high -= turns;
    }
    const double slack = SLACK * (end - begin);
    if (low < begin - slack || high > end + slack) return {degree_, count - 1};
    const auto first = std::upper_bound(knots_.begin(), knots_.end(), low) - knots_.begin() - 1;
    const auto last = std::lower_bound(knots_.begin(), knots_.end(), high) - knots_.begin() - 1;
    const std::int64_t from = std::clamp<std::int64_t>(first, degree_, count - 1);
    return {from, std::max<std::int64_t>(from, std::clamp<std::int64_t>(last, degree_, count - 1))};
}

bool SplineBasis::is_smooth() const {
    const auto count = static_cast<std::int64_t>(knots_.size()) - degree_ - 1;
    for (std::int64_t i = degree_ + 1; i + degree_ - 1 < count; ++i)
        if (knots_[i] > knots_[degree_] && knots_[i] < knots_[count] &&
            knots_[i + degree_ - 1] <= knots_[i])
            return false;
    return true;
}

double SplineBasis::difference_factor(std::int64_t first, int times) const {
    const double width = knots_[first + degree_ + 1] - knots_[first + times + 1];
    return width > 0.0 ? static_cast<double>(degree_ - times) / width : 0.0;
}

SurfaceStatus SplineSurface::derivative_magnitudes(std::span<const ParameterBox> cells, int order,
                                                   std::span<Point3> out) const {
    if (!u_.is_smooth() || !v_.is_smooth()) return SurfaceStatus::UNKNOWN;
    const std::size_t count = derivative_count(order);
    const auto p = static_cast<std::int64_t>(u_.degree());
    const auto q = static_cast<std::int64_t>(v_.degree());
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        const SpanRange u = u_.spans(cells[cell].low.x, cells[cell].high.x);
        const SpanRange v = v_.spans(cells[cell].low.y, cells[cell].high.y);
        const std::int64_t row = u.first - p, column = v.first - q;
        ControlNet net{u.last - row + 1, v.last - column + 1, {}};
        for (std::int64_t i = row; i <= u.last; ++i)
            for (std::int64_t j = column; j <= v.last; ++j) {
                const std::int64_t k = i * columns_ + j;
                const double weight = weights_.empty() ? 1.0 : weights_[k];
                net.points.push_back({weight * control_[k], weight});
            }
        const double least = centre(net);
        Magnitudes part{};
        for (int k = 0; k <= order; ++k) {  // by u, then by v
            if (k > 0) net = derived(net, u_, row, k - 1, true);
            ControlNet both = net;
            for (int l = 0; k + l <= order; ++l) {
                if (l > 0) both = derived(both, v_, column, l - 1, false);
                part[derivative_number(k, l)] = magnitude_of(both);
            }
        }
        divide_by_weight(part, least, count, out.subspan(cell * count, count));
    }
    return SurfaceStatus::DONE;
}

bool SplineCurve::derivative_magnitudes(std::span<const ParameterRange> ranges, int order,
                                        std::span<Point3> out) const {
    if (!basis_.is_smooth()) return false;
    const auto p = static_cast<std::int64_t>(basis_.degree());
    const auto count = static_cast<std::size_t>(order + 1);
    for (std::size_t range = 0; range < ranges.size(); ++range) {
        const auto [low, high] = ranges[range];
        const SpanRange spans = basis_.spans(std::min(low, high), std::max(low, high));
        const std::int64_t row = spans.first - p;
        ControlNet net{spans.last - row + 1, 1, {}};
        for (std::int64_t i = row; i <= spans.last; ++i) {
            const double weight = weights_.empty() ? 1.0 : weights_[i];
            net.points.push_back({weight * control_[i], weight});
        }
        const double least = centre(net);
        Magnitudes part{};
        for (int k = 0; k <= order; ++k) {
            if (k > 0) net = derived(net, basis_, row, k - 1, true);
            part[derivative_number(k, 0)] = magnitude_of(net);
        }
        std::array<Point3, 10> found{};
        divide_by_weight(part, least, derivative_count(order), found);
        for (int k = 0; k <= order; ++k)
            out[range * count + static_cast<std::size_t>(k)] = found[derivative_number(k, 0)];
    }
    return true;
}

}  // namespace surfmesh
