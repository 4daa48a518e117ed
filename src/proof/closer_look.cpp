#include "proof/closer_look.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "proof/cells_over_ring.hpp"
#include "proof/covering.hpp"
#include "proof/distinct_places.hpp"
#include "proof/triangle_grid.hpp"
#include "values/segment.hpp"

namespace surfmesh {
namespace {

constexpr double ROUNDING = TriangleRing::ROUNDING;
constexpr std::size_t FIRST_LEVEL = 2, MOST_LEVELS = 8;
constexpr std::size_t TOGETHER = 256;  // triangles whose first points are computed at once
constexpr int LAYERS = 2;              // of triangles around

/// What is cut into cells: the triangle's own piece of the surface, or a gap beside it.
struct LookedPiece {
    PlaneCorners uv;
    PlaneBends bend;
    TriangleBounds bounds;
    bool is_own;

    [[nodiscard]] PlanePiece plane() const { return {uv, bend}; }
};

/// Distances point by point: the largest at points, and with what may lie between them.
struct PointByPoint {
    double at_points, bound;
};

class Looker {
  public:
    /// rings_alone: not point by point.
    Looker(const Surface& surface, const ProofMesh& mesh, const TrianglesAtVertices& at_vertices,
           SideDistances& sides, const PoleGaps& gaps, bool rings_alone)
        : surface_(surface),
          mesh_(mesh),
          gaps_(gaps),
          bounds_(mesh.bounds),
          ring_(mesh, at_vertices, sides),
          cells_(ring_),
          rings_alone_(rings_alone),
          layers_(mesh.corners.size(), 0),
          over_ring_(mesh.corners.size(), intervals::INFINITE),
          whole_(mesh.corners.size()) {
        for (std::size_t t = 0; t < whole_.size(); ++t) whole_[t] = bounds_[t].whole;
        // a gap's interpolant is the side beside it
        for (std::size_t k = 0; k < gaps.owner.size(); ++k)
            whole_[gaps.owner[k]] = std::max(whole_[gaps.owner[k]], gaps.bounds[k].whole);
    }

    SurfaceStatus compute_first(std::span<const std::int32_t> which, Array<EnclosedPoint>& points);

    /// Lower ``bound`` as far as the look shows; first: the points of the coarsest grid.
    SurfaceStatus look(std::int32_t t, std::span<const EnclosedPoint> first, double limit,
                       int levels, double& bound) {
        triangle_ = t;
        for (Array<EnclosedPoint>& known : known_) known.clear();
        known_[FIRST_LEVEL] = Array<EnclosedPoint>(first);
        if (!rings_alone_)
            if (const auto status = look_point_by_point(t, limit, levels, bound);
                status != SurfaceStatus::DONE)
                return status;
        if (bound <= limit || !ring_.begin(t)) return SurfaceStatus::DONE;
        for (int layer = 0; layer < LAYERS && !(bound <= limit); ++layer) {
            if (!ring_.add_layer()) return SurfaceStatus::DONE;
            if (!(ring_.free() > 0.0)) continue;
            double found = intervals::INFINITE;
            const auto status = look_with_ring(t, limit, levels, found);
            if (status != SurfaceStatus::DONE) return status;
            over_ring_[t] = std::min(over_ring_[t], found);
            if (!(found < bound)) continue;
            bound = found;
            layers_[t] = static_cast<std::uint8_t>(layer + 1);
        }
        return SurfaceStatus::DONE;
    }
    /// At all of these, those that have a bound already too.
    SurfaceStatus look_at_all(std::span<const std::int32_t> which, std::span<const double> limits,
                              int levels, std::span<double> bound);

    [[nodiscard]] LookedAt looked_at(const Array<double>& without) const {
        return {{layers_.data(), layers_.size()},
                {over_ring_.data(), over_ring_.size()},
                {without.data(), without.size()},
                {whole_.data(), whole_.size()}};
    }

  private:
    /// At the triangle's own piece, and at the gaps beside it.
    SurfaceStatus look_with_ring(std::int32_t t, double limit, int levels, double& bound) {
        double most = intervals::INFINITE;
        piece_ = {mesh_.uv[t], mesh_.bends[t], bounds_[t], true};
        if (const auto status = look_at_piece(limit, levels, most); status != SurfaceStatus::DONE)
            return status;
        const auto first = std::lower_bound(gaps_.owner.begin(), gaps_.owner.end(), t);
        for (auto gap = first; gap != gaps_.owner.end() && *gap == t; ++gap) {
            const auto k = static_cast<std::size_t>(gap - gaps_.owner.begin());
            double found = intervals::INFINITE;
            piece_ = {gaps_.uv[k], PlaneBends{}, gaps_.bounds[k], false};
            if (const auto status = look_at_piece(limit, levels, found);
                status != SurfaceStatus::DONE)
                return status;
            most = std::max(most, found);
        }
        bound = most;
        return SurfaceStatus::DONE;
    }
    SurfaceStatus look_at_piece(double limit, int levels, double& bound) {
        for (int level = int{FIRST_LEVEL}; level <= levels; ++level) {
            double found = intervals::INFINITE;
            const auto status = look_at_cells(level, limit, level == levels, found);
            if (status != SurfaceStatus::DONE) return status;
            if (found < bound) bound = found;
            // more cells take away what is between them, and no more
            const double scale = 1.0 / static_cast<double>(std::size_t{1} << (2 * level));
            const double between =
                scale * (piece_.bounds.cell_height + 2.0 * piece_.bounds.cell_whole);
            const bool is_hopeless = found < intervals::INFINITE && found - 40.0 * between > limit;
            if (bound <= limit || is_hopeless) break;
        }
        return SurfaceStatus::DONE;
    }
    /// is_last: see CellsOverRing.
    SurfaceStatus look_at_cells(int level, double limit, bool is_last, double& found) {
        const std::size_t side = std::size_t{1} << level;
        if (const auto status = compute_points(side); status != SurfaceStatus::DONE) return status;
        found = cells_.bound({piece_.bounds, points_, side, rounded_uv_}, limit, is_last);
        if (piece_.is_own && found < intervals::INFINITE)
            found = std::max(found, cells_.farthest_at_rims(mesh_.corners[triangle_]));
        return SurfaceStatus::DONE;
    }
    SurfaceStatus look_point_by_point(std::int32_t t, double limit, int levels, double& bound);
    SurfaceStatus take_points(std::size_t side, PointByPoint& found);
    [[nodiscard]] double farthest_from_linear(std::size_t side) const;
    [[nodiscard]] double farthest_from_side() const;
    SurfaceStatus compute_points(std::size_t side);

    const Surface& surface_;
    ProofMesh mesh_;
    PoleGaps gaps_;
    std::span<const TriangleBounds> bounds_;
    TriangleRing ring_;
    CellsOverRing cells_;
    bool rings_alone_;
    Array<std::uint8_t> layers_;  // of triangles around, with which a bound holds
    Array<double> over_ring_;     // heights over those around
    Array<double> whole_;         // point by point, of gaps too
    LookedPiece piece_{};
    std::int32_t triangle_ = NIL;  // that is looked at
    Array<Point2> uv_;
    Array<EnclosedPoint> points_;
    std::array<Array<EnclosedPoint>, MOST_LEVELS> known_;  // of the triangle's own piece, by level
    double rounded_uv_ = 0.0;
};

/// |r - L| at the corners of cells, and how far it may rise between them: both ways, by itself. Gaps
/// count by their distance from a side of the triangle.
SurfaceStatus Looker::look_point_by_point(std::int32_t t, double limit, int levels, double& bound) {
    const auto [first, last] = std::equal_range(gaps_.owner.begin(), gaps_.owner.end(), t);
    for (int level = int{FIRST_LEVEL}; level <= levels && !(bound <= limit); ++level) {
        const std::size_t side = std::size_t{1} << level;
        PointByPoint found{0.0, 0.0};
        piece_ = {mesh_.uv[t], mesh_.bends[t], bounds_[t], true};
        if (const auto status = take_points(side, found); status != SurfaceStatus::DONE)
            return status;
        for (auto gap = first; gap != last; ++gap) {
            const auto k = static_cast<std::size_t>(gap - gaps_.owner.begin());
            piece_ = {gaps_.uv[k], PlaneBends{}, gaps_.bounds[k], false};
            if (const auto status = take_points(side, found); status != SurfaceStatus::DONE)
                return status;
        }
        bound = std::min(bound, found.bound);
        if (found.at_points > limit) break;
    }
    return SurfaceStatus::DONE;
}

/// Of one piece, on a grid; ``found`` is raised.
SurfaceStatus Looker::take_points(std::size_t side, PointByPoint& found) {
    if (const auto status = compute_points(side); status != SurfaceStatus::DONE) return status;
    const SpaceCorners& p = mesh_.corners[triangle_];
    const double longest = std::max({norm(p[1] - p[0]), norm(p[2] - p[1]), norm(p[0] - p[2])});
    const double size = norm(p[0]) + norm(p[1]) + norm(p[2]);
    const double most = piece_.is_own ? farthest_from_linear(side) : farthest_from_side();
    const double between = piece_.bounds.cell_whole / static_cast<double>(side * side);
    const double all = most * (1.0 + ROUNDING) + between + ROUNDING * 0x1p-4 * size +
                       rounded_uv_ * (longest + 4.0 * piece_.bounds.shift);
    found.at_points = std::max(found.at_points, most);
    found.bound = all <= intervals::INFINITE ? std::max(found.bound, all) : intervals::INFINITE;
    return SurfaceStatus::DONE;
}

/// Of the points of the triangle's own piece, each from its own place in the triangle.
double Looker::farthest_from_linear(std::size_t side) const {
    const SpaceCorners& p = mesh_.corners[triangle_];
    double most = 0.0;
    std::size_t k = 0;
    for_grid(side, [&](const Barycentric& l) {
        const Point3 flat = l[0] * p[0] + l[1] * p[1] + l[2] * p[2];
        most = std::max(most, norm(points_[k].value - flat) + 2.0 * points_[k].error);
        ++k;
    });
    return most;
}

/// Of all points from one and the same side, which is convex.
double Looker::farthest_from_side() const {
    const SpaceCorners& p = mesh_.corners[triangle_];
    double least = intervals::INFINITE;
    for (std::size_t s = 0; s < 3; ++s) {
        double most = 0.0;
        for (const auto& [value, error] : points_)
            most = std::max(most, distance_to_segment(value, p[s], p[(s + 1) % 3]) + 2.0 * error);
        least = std::min(least, most);
    }
    return least;
}

/// The points of the grid of the piece.
SurfaceStatus Looker::compute_points(std::size_t side) {
    uv_.clear();
    append_grid(piece_.plane(), side, uv_);
    rounded_uv_ = rounded_part(piece_.plane());
    points_.resize(uv_.size());
    const std::size_t level = std::bit_width(side) - 1;
    if (piece_.is_own && known_[level].size() == uv_.size()) {
        std::copy(known_[level].begin(), known_[level].end(), points_.begin());
        return SurfaceStatus::DONE;
    }
    const auto status = surface_.enclose({uv_.data(), uv_.size()}, {points_.data(), uv_.size()});
    if (piece_.is_own) known_[level] = Array<EnclosedPoint>({points_.data(), uv_.size()});
    return status;
}

/// The points of the coarsest grids of many triangles, all at once.
SurfaceStatus Looker::compute_first(std::span<const std::int32_t> which,
                                    Array<EnclosedPoint>& points) {
    Array<Point2> uv;
    for (const std::int32_t t : which)
        append_grid({mesh_.uv[t], mesh_.bends[t]}, std::size_t{1} << FIRST_LEVEL, uv);
    const DistinctPlaces places({uv.data(), uv.size()});
    Array<EnclosedPoint> found(places.all().size());
    const auto status = surface_.enclose(places.all(), {found.data(), found.size()});
    points.resize(uv.size());
    for (std::size_t k = 0; k < uv.size(); ++k) points.begin()[k] = found[places.at(k)];
    return status;
}

SurfaceStatus Looker::look_at_all(std::span<const std::int32_t> which,
                                  std::span<const double> limits, int levels,
                                  std::span<double> bound) {
    Array<EnclosedPoint> points;
    for (std::size_t start = 0; start < which.size(); start += TOGETHER) {
        const std::span some = which.subspan(start, std::min(TOGETHER, which.size() - start));
        if (const auto status = compute_first(some, points); status != SurfaceStatus::DONE)
            return status;
        const std::size_t each = points.size() / some.size();
        for (std::size_t k = 0; k < some.size(); ++k) {
            const auto t = static_cast<std::size_t>(some[k]);
            const auto status =
                look(some[k], {points.data() + k * each, each}, limits[t], levels, bound[t]);
            if (status != SurfaceStatus::DONE) return status;
        }
    }
    return SurfaceStatus::DONE;
}

}  // namespace

SurfaceStatus look_closer(const Surface& surface, const ProofMesh& mesh, const PoleGaps& gaps,
                          std::span<const std::int32_t> which, std::span<const double> limits,
                          int levels, std::span<double> bound) {
    SideDistances sides(surface, mesh);
    const TrianglesAtVertices at_vertices(mesh.vertices);
    Looker looker(surface, mesh, at_vertices, sides, gaps, false);
    Array<double> without{std::span<const double>(bound)};  // rings
    auto status = looker.look_at_all(which, limits, levels, bound);
    if (status != SurfaceStatus::DONE) return status;
    LookedAt looked = looker.looked_at(without);
    const auto is_without = [](std::uint8_t layers) { return layers == 0; };
    if (std::all_of(looked.layers.begin(), looked.layers.end(), is_without)) return status;
    for (std::size_t t = 0; t < bound.size(); ++t)
        if (is_without(looked.layers[t])) without[static_cast<std::ptrdiff_t>(t)] = bound[t];
    const Array<std::int32_t> others =
        covering_triangles(mesh, at_vertices, sides, looked, limits, bound);
    Array<double> unknown(bound.size(), intervals::INFINITE);
    if (others.empty()) {
        looked.over_ring = {unknown.data(), unknown.size()};
        count_covering(mesh, at_vertices, sides, looked, bound);
        return status;
    }
    Looker again(surface, mesh, at_vertices, sides, gaps, true);
    status = again.look_at_all({others.data(), others.size()}, limits, levels,
                               {unknown.data(), unknown.size()});
    if (status != SurfaceStatus::DONE) return status;
    looked.over_ring = again.looked_at(without).over_ring;
    count_covering(mesh, at_vertices, sides, looked, bound);
    return SurfaceStatus::DONE;
}

}  // namespace surfmesh
