// Bounds of derivatives over cells: of elementary surfaces in closed form, of swept ones by those
// of their curve, of offsets by those of their basis.
#include <algorithm>
#include <cmath>
#include <limits>

#include "elementary_functions/sine_cosine.hpp"
#include "surfaces/elementary_surfaces.hpp"
#include "surfaces/offset_surface.hpp"
#include "surfaces/swept_surfaces.hpp"

namespace surfmesh {
namespace {

constexpr double HALF_TURN = 3.141592653589793;

Point3 size_by_coordinate(Point3 p) { return {std::abs(p.x), std::abs(p.y), std::abs(p.z)}; }

double radius_of(double a, double b) { return std::sqrt(a * a + b * b); }

/// The largest |cos t x + sin t y| by coordinate.
Point3 amplitude(Point3 x, Point3 y) {
    return {radius_of(x.x, y.x), radius_of(x.y, y.y), radius_of(x.z, y.z)};
}

/// The largest |cos| between two angles.
double largest_cosine(double low, double high) {
    if (std::floor(high / HALF_TURN) >= std::ceil(low / HALF_TURN)) return 1.0;
    return std::max(std::abs(elementary::cos(low)), std::abs(elementary::cos(high)));
}

/// The largest |p|, |p'|, |p''|, |p'''| of a profile over a range of v.
std::array<double, 4> largest_radii(const Profile& profile, double low, double high) {
    if (!profile.is_circle) {
        const auto radius = [&](double v) {
            return std::abs(profile.radius + profile.outwards * v);
        };
        return {std::max(radius(low), radius(high)), std::abs(profile.outwards), 0.0, 0.0};
    }
    const double cosine = std::abs(profile.tube) * largest_cosine(low, high);
    const double sine =
        std::abs(profile.tube) * largest_cosine(low - 0.5 * HALF_TURN, high - 0.5 * HALF_TURN);
    return {std::abs(profile.radius) + cosine, sine, cosine, sine};
}

}  // namespace

SurfaceStatus Surface::bend_bounds(std::span<const ParameterBox> cells, std::span<Point3> lower,
                                   std::span<Point3> upper) const {
    constexpr std::size_t ALL = 1 + BOUNDED_DERIVATIVES, BENT = 3;
    Array<Point3> low(ALL * cells.size()), high(ALL * cells.size());
    const SurfaceStatus status = all_bounds(cells, low, high);
    if (status != SurfaceStatus::DONE) return status;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const std::size_t from = ALL * i + ALL - BENT;
        std::copy_n(low.data() + from, BENT, lower.data() + BENT * i);
        std::copy_n(high.data() + from, BENT, upper.data() + BENT * i);
    }
    return SurfaceStatus::DONE;
}

SurfaceStatus Surface::derivative_magnitudes(std::span<const ParameterBox> cells, int order,
                                             std::span<Point3> out) const {
    if (order > 2) return SurfaceStatus::UNKNOWN;
    Array<Point3> lower(BOUNDED_DERIVATIVES * cells.size()),
        upper(BOUNDED_DERIVATIVES * cells.size());
    const SurfaceStatus status = derivative_bounds(cells, lower, upper);
    if (status != SurfaceStatus::DONE) return status;
    const std::size_t count = derivative_count(order);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        out[i * count] = {0.0, 0.0, 0.0};
        for (std::size_t k = 1; k < count; ++k) {
            const auto from = static_cast<std::ptrdiff_t>(i * BOUNDED_DERIVATIVES + k - 1);
            const Point3 low = size_by_coordinate(lower[from]),
                         high = size_by_coordinate(upper[from]);
            out[i * count + k] = {std::max(low.x, high.x), std::max(low.y, high.y),
                                  std::max(low.z, high.z)};
        }
    }
    return SurfaceStatus::DONE;
}

SurfaceStatus Plane::derivative_magnitudes(std::span<const ParameterBox> cells, int order,
                                           std::span<Point3> out) const {
    const std::size_t count = derivative_count(order);
    std::fill(out.begin(), out.end(), Point3{0.0, 0.0, 0.0});
    for (std::size_t i = 0; i < cells.size(); ++i) {
        out[i * count + 1] = size_by_coordinate(frame_.x);
        out[i * count + 2] = size_by_coordinate(frame_.y);
    }
    return SurfaceStatus::DONE;
}

SurfaceStatus TurnedProfile::derivative_magnitudes(std::span<const ParameterBox> cells, int order,
                                                   std::span<Point3> out) const {
    const std::size_t count = derivative_count(order);
    const Point3 around = amplitude(frame_.x, frame_.y);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const auto radii = largest_radii(profile_, cells[i].low.y, cells[i].high.y);
        for (std::size_t number = 0; number < count; ++number) {
            const auto [k, l] = DERIVATIVES[number];
            Point3& value = out[i * count + number];
            if (number == 0)
                value = {0.0, 0.0, 0.0};
            else if (k > 0)
                value = radii[static_cast<std::size_t>(l)] * around;
            else if (profile_.is_circle)  // along the tube
                value = std::abs(profile_.tube) * amplitude(around, frame_.z);
            else
                value = radii[static_cast<std::size_t>(l)] * around +
                        (l == 1 ? std::abs(profile_.upwards) : 0.0) * size_by_coordinate(frame_.z);
        }
    }
    return SurfaceStatus::DONE;
}

SurfaceStatus ExtrusionSurface::derivative_magnitudes(std::span<const ParameterBox> cells,
                                                      int order, std::span<Point3> out) const {
    const std::size_t count = derivative_count(order);
    const auto rows = static_cast<std::size_t>(order + 1);
    Array<ParameterRange> ranges;
    for (const ParameterBox& cell : cells) ranges.push_back({cell.low.x, cell.high.x});
    Array<Point3> curve(rows * cells.size());
    if (!curve_->derivative_magnitudes(ranges, order, curve)) return SurfaceStatus::UNKNOWN;
    std::fill(out.begin(), out.end(), Point3{0.0, 0.0, 0.0});
    for (std::size_t i = 0; i < cells.size(); ++i)
        for (std::size_t number = 1; number < count; ++number) {
            const auto [k, l] = DERIVATIVES[number];
            const std::size_t from = i * rows + static_cast<std::size_t>(k);
            if (l == 0) out[i * count + number] = curve[static_cast<std::ptrdiff_t>(from)];
            if (number == 2) out[i * count + number] = size_by_coordinate(direction_);
        }
    return SurfaceStatus::DONE;
}

SurfaceStatus RevolutionSurface::derivative_magnitudes(std::span<const ParameterBox> cells,
                                                       int order, std::span<Point3> out) const {
    const std::size_t count = derivative_count(order);
    const auto rows = static_cast<std::size_t>(order + 1);
    Array<ParameterRange> ranges;
    Array<double> middles;
    for (const ParameterBox& cell : cells) {
        ranges.push_back({cell.low.y, cell.high.y});
        middles.push_back(0.5 * (cell.low.y + cell.high.y));
    }
    Array<Point3> curve(rows * cells.size());
    if (!curve_->derivative_magnitudes(ranges, order, curve)) return SurfaceStatus::UNKNOWN;
    const CurveValues middle(*curve_, middles, 0);
    const Point3 axis = size_by_coordinate(axis_);
    const auto beside = [](double a) { return std::sqrt(std::max(0.0, 1.0 - a * a)); };
    const Point3 around{beside(axis.x), beside(axis.y), beside(axis.z)};
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const Point3* own = curve.data() + i * rows;
        const Point3 q = middle[0][i] - origin_, across = q - dot(q, axis_) * axis_;
        const double half = 0.5 * (ranges[static_cast<std::ptrdiff_t>(i)].last -
                                   ranges[static_cast<std::ptrdiff_t>(i)].first);
        for (std::size_t number = 0; number < count; ++number) {
            const auto [k, l] = DERIVATIVES[number];
            const double radius = l == 0 ? norm(across) + half * norm(own[1]) : norm(own[l]);
            out[i * count + number] = radius * around;
            if (k == 0) out[i * count + number] = radius * around + dot(axis, own[l]) * axis;
        }
        out[i * count] = {0.0, 0.0, 0.0};
    }
    return SurfaceStatus::DONE;
}

namespace {

/// Bounds over a cell of the derivatives of n = N / s, s = |N|: by u, v, twice by each.
struct NormalMagnitudes {
    double u, v, uu, uv, vv;
};

/// From N_u and N_v in the middle, which change by second derivatives of N at most:
///
///     n_uu = (N_uu)' / s - 2 s_u n_u / s - |n_u|^2 n        ' the part across n; |s_u| <= |N_u|
///
/// r: the basis in the middle, to the second order; bound: its derivatives over the cell, to the
/// third. Infinite where N may vanish.
NormalMagnitudes normal_magnitudes(const std::array<Point3, 6>& r, std::span<const Point3> bound,
                                   Point2 half) {
    constexpr double NOT_KNOWN = std::numeric_limits<double>::infinity();
    std::array<double, 10> b{};
    for (std::size_t k = 1; k < b.size(); ++k) b[k] = norm(bound[k]);
    const double uu = b[6] * b[2] + 2.0 * b[3] * b[4] + b[1] * b[7];  // |N_uu|
    const double uv = b[7] * b[2] + b[3] * b[5] + b[1] * b[8];
    const double vv = b[8] * b[2] + 2.0 * b[4] * b[5] + b[1] * b[9];
    const double u = norm(cross(r[3], r[2]) + cross(r[1], r[4])) + half.x * uu + half.y * uv;
    const double v = norm(cross(r[4], r[2]) + cross(r[1], r[5])) + half.x * uv + half.y * vv;
    const double s = norm(cross(r[1], r[2])) - (half.x * u + half.y * v);
    if (!(s > 0.0)) return {NOT_KNOWN, NOT_KNOWN, NOT_KNOWN, NOT_KNOWN, NOT_KNOWN};
    const double n_u = u / s, n_v = v / s;
    return {n_u, n_v, uu / s + 3.0 * n_u * n_u, uv / s + 3.0 * n_u * n_v, vv / s + 3.0 * n_v * n_v};
}

}  // namespace

SurfaceStatus OffsetSurface::derivative_magnitudes(std::span<const ParameterBox> cells, int order,
                                                   std::span<Point3> out) const {
    if (order > 2) return SurfaceStatus::UNKNOWN;
    const std::size_t count = derivative_count(order), third = derivative_count(3);
    Array<Point3> basis(third * cells.size());
    if (const auto status = basis_->derivative_magnitudes(cells, 3, basis);
        status != SurfaceStatus::DONE)
        return status;
    Array<Point2> middles;
    for (const auto& [low, high] : cells) middles.push_back(0.5 * (low + high));
    SurfaceValues middle;
    if (const auto status = middle.evaluate(*basis_, middles, 2); status != SurfaceStatus::DONE)
        return status;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const std::span<const Point3> own{basis.data() + i * third, third};
        std::array<Point3, 6> r{};
        for (std::size_t k = 0; k < r.size(); ++k) r[k] = middle[k][i];
        const auto [u, v, uu, uv, vv] =
            normal_magnitudes(r, own, 0.5 * (cells[i].high - cells[i].low));
        const std::array<double, 6> normal{0.0, u, v, uu, uv, vv};
        out[i * count] = {0.0, 0.0, 0.0};
        for (std::size_t k = 1; k < count; ++k) {
            const double wider = std::abs(distance_) * normal[k];
            out[i * count + k] = own[k] + Point3{wider, wider, wider};
        }
    }
    return SurfaceStatus::DONE;
}

}  // namespace surfmesh
