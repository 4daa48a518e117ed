#include "sizing/bounded_features.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "elementary_functions/power.hpp"
#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr double HIDDEN_RISE = 0.25;  // of ``chord``: what rises less within a cell is no feature
constexpr double HIDDEN_TURN = 0.25;  // of ``angle``, likewise
constexpr double NARROW = 0.2;        // of the least size seen: the width of a narrow cell
constexpr double RADIANS = 3.141592653589793 / 180.0;
constexpr std::size_t CELLS_TOGETHER = 512;  // cells of which bounds are taken at a time

Array<ParameterBox> boxes_of(const Chart& chart, const SeenCells& cells, std::size_t first,
                             std::size_t count) {
    Array<ParameterBox> boxes(count);
    for (std::size_t i = 0; i < count; ++i)
        boxes[i] = chart.to_box(cells.low[first + i], cells.high[first + i]);
    return boxes;
}

struct Range {
    double least, most;
};

/// n . x for x between two corners of a box. Parts of opposite sign cancel: of a small box little
/// more is left than the values in it.
Range range_along(Point3 low, Point3 high, Point3 n) {
    const auto part = [](double normal, double a, double b) {  // times infinity is 0: x is finite
        return normal == 0.0 ? 0.0 : normal * (normal > 0.0 ? a : b);
    };
    return {part(n.x, low.x, high.x) + part(n.y, low.y, high.y) + part(n.z, low.z, high.z),
            part(n.x, high.x, low.x) + part(n.y, high.y, low.y) + part(n.z, high.z, low.z)};
}

/// Bound of |n . x| for x between two corners of a box.
double largest_along(Point3 low, Point3 high, Point3 n) {
    const Range range = range_along(low, high, n);
    return most(std::abs(range.least), std::abs(range.most));
}

double width_along(Point3 low, Point3 high, Point3 n) {
    const Range range = range_along(low, high, n);
    return range.most - range.least;
}

/// The largest E and G of the first fundamental form at the nodes of a cell.
Point2 largest_squares(const SeenCells& cells, std::size_t cell) {
    Point2 found{0.0, 0.0};
    for (std::size_t node = 0; node < 9; ++node) {
        const SizeTensor root = cells.root[9 * cell + node];
        found.x = most(found.x, root.xx * root.xx + root.xy * root.xy);
        found.y = most(found.y, root.xy * root.xy + root.yy * root.yy);
    }
    return found;
}

/// Bounds of the second fundamental form in the plane, from those of its parts in (u, v).
std::array<double, 3> in_plane(const ChartPoint& at, const double (&form)[3]) {
    const auto [du, dv] = at.rates;
    std::array<double, 3> found{std::abs(du * du) * form[0], std::abs(du * dv) * form[1],
                                std::abs(dv * dv) * form[2]};
    if (!at.is_crossed()) return found;
    const auto [across, up] = at.crossed;  // du/dy, dv/dx
    found[0] += 2.0 * std::abs(du * up) * form[1] + up * up * form[2];
    found[1] += std::abs(du * across) * form[0] + std::abs(up * across) * form[1] +
                std::abs(up * dv) * form[2];
    found[2] += across * across * form[0] + 2.0 * std::abs(across * dv) * form[1];
    return found;
}

double smaller_number(double a, double b) {
    if (std::isnan(a)) return b;
    return std::isnan(b) || a <= b ? a : b;
}

}  // namespace

std::exception_ptr BoundedFeatures::take_failure() {
    if (status_ == SurfaceStatus::FAILED)
        if (const std::exception_ptr failure = surface_.take_failure()) return failure;
    return rules_.take_failure();
}

bool BoundedFeatures::find(const SeenCells& cells, bool deep, std::span<std::uint8_t> found) {
    const std::size_t count = cells.low.size();
    Array<double> k(count), possible(count);
    for_each_block(count, CELLS_TOGETHER, [&](std::size_t first, std::size_t last) {
        bound_curvature(cells, first, {k.data() + first, last - first});
    });
    std::fill(found.begin(), found.end(), std::uint8_t{0});
    if (status_ == SurfaceStatus::UNKNOWN) return true;
    if (status_ != SurfaceStatus::DONE) return false;
    Array<PrincipalCurvatures> curved(count);
    for (std::size_t i = 0; i < count; ++i) curved[i] = {k[i], angle_ ? k[i] : 0.0};
    if (!rules_.shorter({curved.data(), count}, {possible.data(), count})) return false;
    Array<std::int32_t> some;
    for (std::size_t i = 0; i < count; ++i) {
        if (!(possible[i] < 0.5 * cells.smallest_size[i])) continue;
        // beside a rim of infinite speed there is no bound at any depth: there the report looks
        if (beside_infinite_speed(cells.low[i], cells.high[i])) continue;
        if (!deep && is_flat(cells, i, k[i])) continue;
        found[i] = 1;
        some.push_back(static_cast<std::int32_t>(i));
    }
    if (deep && chord_) keep_rising(cells, {some.data(), some.size()}, found);
    return status_ == SurfaceStatus::DONE;
}

/// Bounds of the curvature of cells from ``first`` on.
void BoundedFeatures::bound_curvature(const SeenCells& cells, std::size_t first,
                                      std::span<double> k) {
    const std::size_t count = k.size();
    const Array<ParameterBox> boxes = boxes_of(chart_, cells, first, count);
    Array<Point3> lower(BOUNDED_DERIVATIVES * count), upper(BOUNDED_DERIVATIVES * count);
    const SurfaceStatus status = surface_.derivative_bounds(
        {boxes.data(), count}, {lower.data(), lower.size()}, {upper.data(), upper.size()});
    if (status != SurfaceStatus::DONE) {
        status_.store(status);
        return;
    }
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t cell = first + i;
        const Point2 middle = 0.5 * (cells.low[cell] + cells.high[cell]);
        double form[3];  // |r_uu|, |r_uv|, |r_vv| along the normal at most
        for (std::size_t j = 0; j < 3; ++j) {
            const std::size_t row = BOUNDED_DERIVATIVES * i + 2 + j;
            form[j] = largest_along(lower[row], upper[row], cells.normal[cell]);
        }
        const auto [xx, xy, yy] = in_plane(chart_.at(middle), form);
        const auto [e, g] = largest_squares(cells, cell);
        const double l = xx / e, n = yy / g;
        const double bound = std::sqrt(l * l + 2.0 * (xy * xy) / (e * g) + n * n);
        k[i] = std::isnan(bound) ? std::numeric_limits<double>::infinity() : bound;
    }
}

/// Is a cell narrow, and does the bound k of its curvature show that the surface rises and turns
/// little within it?
///
/// With k the Frobenius norm of the second fundamental form in terms of the first, and w no less
/// than the cell's width both ways, it leaves the tangent plane at the middle by no more than
///
///     (|L| du^2 + 2 |M| du dv + |N| dv^2) / 8  <=  k (E du^2 + G dv^2) / 8  <=  k w^2 / 4
///
/// and its normal turns by about k w / sqrt(2).
bool BoundedFeatures::is_flat(const SeenCells& cells, std::size_t cell, double k) const {
    const Point2 step = cells.high[cell] - cells.low[cell];
    const auto [e, g] = largest_squares(cells, cell);
    const double square = std::max(e * step.x * step.x, g * step.y * step.y);
    const double size = NARROW * cells.smallest_size[cell];
    if (!(square < size * size)) return false;
    const double turn = HIDDEN_TURN * RADIANS;
    if (angle_ && !(k * std::sqrt(0.5 * square) <= turn * *angle_)) return false;
    return !chord_ || 0.25 * k * square <= HIDDEN_RISE * *chord_;
}

/// Of the cells found, those in which the surface may lie off its tangent plane by a fraction of
/// the chord: by the mean value or by its values, which hold across kinks and jumps too.
void BoundedFeatures::keep_rising(const SeenCells& cells, std::span<const std::int32_t> some,
                                  std::span<std::uint8_t> found) {
    for_each_block(some.size(), CELLS_TOGETHER, [&](std::size_t first, std::size_t last) {
        const std::size_t count = last - first;
        Array<ParameterBox> boxes(count);
        for (std::size_t i = 0; i < count; ++i)
            boxes[i] = chart_.to_box(cells.low[some[first + i]], cells.high[some[first + i]]);
        constexpr std::size_t rows = 1 + BOUNDED_DERIVATIVES;
        Array<Point3> lower(rows * count), upper(rows * count);
        const SurfaceStatus status = surface_.all_bounds(
            {boxes.data(), count}, {lower.data(), lower.size()}, {upper.data(), upper.size()});
        if (status == SurfaceStatus::FAILED) status_.store(status);
        for (std::size_t i = 0; i < count; ++i) {
            const std::int32_t cell = some[first + i];
            if (status != SurfaceStatus::DONE) {
                found[cell] = 0;
                continue;
            }
            const Point3 n = cells.normal[cell];
            const auto width = [&](std::size_t k) {
                return width_along(lower[rows * i + k], upper[rows * i + k], n);
            };
            const Point2 half = 0.5 * (boxes[i].high - boxes[i].low);
            const double bent = half.x * width(1) + half.y * width(2);
            // no size could follow what is narrower than the least of them: the report finds it
            const Point2 step = cells.high[cell] - cells.low[cell];
            const SizeTensor root = cells.root[9 * cell + 4];
            const bool wide =
                elementary::hypot(root.xx, root.xy) * std::abs(step.x) > rules_.smallest ||
                elementary::hypot(root.xy, root.yy) * std::abs(step.y) > rules_.smallest;
            const double rise = smaller_number(width(0), bent);
            found[cell] = wide && !(rise <= HIDDEN_RISE * *chord_) ? 1 : 0;
        }
    });
}

/// Does a cell hold a place where derivatives have no bound?
bool BoundedFeatures::beside_infinite_speed(Point2 low, Point2 high) const {
    const auto holds = [](const ChartAxis& axis, double first, double last) {
        for (const BentPiece& piece : axis.pieces) {
            if (piece.q0 > 1.0 && first <= piece.first && piece.first <= last) return true;
            if (piece.q1 > 1.0 && first <= piece.last && piece.last <= last) return true;
        }
        return false;
    };
    if (chart_.u.pieces.empty() && chart_.v.pieces.empty()) return false;
    const Point2 a = chart_.to_uv(low), b = chart_.to_uv(high);
    return holds(chart_.u, a.x, b.x) || holds(chart_.v, a.y, b.y);
}

}  // namespace surfmesh
