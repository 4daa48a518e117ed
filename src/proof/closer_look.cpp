#include "proof/closer_look.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

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
struct Piece {
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

/// The corners of a cell, as rows of points.
using Cell = std::array<std::size_t, 3>;

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
            const auto status = bound_by_cells(level, limit, level == levels, found);
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
    SurfaceStatus look_point_by_point(std::int32_t t, double limit, int levels, double& bound);
    SurfaceStatus take_points(std::size_t side, PointByPoint& found);
    [[nodiscard]] double farthest_from_linear(std::size_t side) const;
    [[nodiscard]] double farthest_from_side() const;
    [[nodiscard]] double rounded() const { return (ROUNDING + rounded_uv_) * ring_.longest(); }
    /// How far a cell may reach beyond its corners, within a plane.
    [[nodiscard]] double grown(double scale) const {
        return scale * piece_.bounds.cell_whole + rounded();
    }
    /// How far it may rise over its corners, from a member's plane.
    [[nodiscard]] double sag(const Neighbour& member, double scale) const {
        return scale * (piece_.bounds.cell_height + 2.0 * member.sine * piece_.bounds.cell_whole);
    }
    void measure(std::size_t m, double scale);
    [[nodiscard]] double highest_within() const;
    SurfaceStatus bound_by_cells(int level, double limit, bool is_last, double& found);
    [[nodiscard]] double highest(std::size_t side, double scale) const;
    [[nodiscard]] double height_of(const Cell& cell, double scale) const;
    [[nodiscard]] double farthest_at_rims(std::size_t side, double scale) const;
    [[nodiscard]] double beyond_rim(const Neighbour& member, std::size_t m, std::size_t s,
                                    const Cell& cell, double grown, double beside) const;
    [[nodiscard]] double over_side(std::size_t m, double own, const Cell& cell, double grown) const;
    SurfaceStatus compute_points(std::size_t side);

    const Surface& surface_;
    ProofMesh mesh_;
    PoleGaps gaps_;
    std::span<const TriangleBounds> bounds_;
    TriangleRing ring_;
    bool rings_alone_;
    Array<std::uint8_t> layers_;  // of triangles around, with which a bound holds
    Array<double> over_ring_;     // heights over those around
    Array<double> whole_;         // point by point, of gaps too
    Piece piece_{};
    std::int32_t triangle_ = NIL;  // that is looked at
    Array<Point2> uv_, feet_;
    Array<EnclosedPoint> points_;
    std::array<Array<EnclosedPoint>, MOST_LEVELS> known_;  // of the triangle's own piece, by level
    double rounded_uv_ = 0.0;
    double farthest_ = 0.0;  // how far a foot leaves the triangle
    // of each point and member: height over its plane, distances inside its sides
    Array<double> height_;
    Array<std::array<double, 3>> inside_;
    Array<std::uint8_t> is_beyond_;  // bit s: so far beyond side s that no cell there lies over it
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

/// Heights over a member's plane, and distances inside its sides; nothing where it is too far off.
void Looker::measure(std::size_t m, double scale) {
    Neighbour& member = ring_[m];
    const std::size_t count = uv_.size();
    double* height = height_.data() + m * count;
    std::array<double, 3>* inside = inside_.data() + m * count;
    std::uint8_t* is_beyond = is_beyond_.data() + m * count;
    double highest = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
        const auto& [r, error] = points_[k];
        const Point3 x = r - member.plane.point;
        const double size = std::abs(x.x) + std::abs(x.y) + std::abs(x.z);
        height[k] = std::abs(dot(member.plane.normal, x)) + 2.0 * error +
                    (member.plane.tilt + ROUNDING) * size;
        highest = std::max(highest, height[k]);
    }
    const double beside =
        2.0 * (scale * piece_.bounds.cell_whole + highest + ROUNDING * ring_.longest());
    // no cell reaches farther beside the member, as in height_of
    const double reach =
        grown(scale) + 2.0 * (highest + sag(member, scale) + rounded()) * member.sine;
    std::fill_n(is_beyond, count, std::uint8_t{0});
    member.is_near = true;
    for (std::size_t s = 0; s < 3; ++s) {
        double most = -intervals::INFINITE;
        for (std::size_t k = 0; k < count; ++k) {
            inside[k][s] = dot(member.inward[s], feet_[k] - member.corners[s]);
            most = std::max(most, inside[k][s]);
            is_beyond[k] |= static_cast<std::uint8_t>((inside[k][s] < -reach ? 1U : 0U) << s);
        }
        if (m > 0 && most < -beside) member.is_near = false;
    }
}

/// The largest height of a point over the triangle itself, whose foot lies in it.
double Looker::highest_within() const {
    double most = 0.0;
    for (std::size_t k = 0; k < uv_.size(); ++k) {
        const auto& [a, b, c] = inside_[k];
        if (std::min({a, b, c}) >= 0.0) most = std::max(most, height_[k]);
    }
    return most;
}

/// is_last: else it is left infinite where more cells are needed to come within the limit.
SurfaceStatus Looker::bound_by_cells(int level, double limit, bool is_last, double& found) {
    const std::size_t side = std::size_t{1} << level;
    const double scale = 1.0 / static_cast<double>(side * side);
    if (const auto status = compute_points(side); status != SurfaceStatus::DONE) return status;
    const std::size_t count = uv_.size();
    feet_.resize(count);
    height_.resize(ring_.count() * count);
    inside_.resize(ring_.count() * count);
    is_beyond_.resize(ring_.count() * count);
    farthest_ = 0.0;
    found = intervals::INFINITE;
    for (std::size_t k = 0; k < count; ++k) feet_[k] = ring_.foot(points_[k].value);
    measure(0, scale);
    const double least = highest_within();
    if (!is_last && least <= limit && least + sag(ring_[0], scale) + rounded() > limit)
        return SurfaceStatus::DONE;
    for (std::size_t m = 1; m < ring_.count(); ++m) measure(m, scale);
    for (std::size_t k = 0; k < count; ++k) {
        const auto& own = inside_[k];
        if (std::min({own[0], own[1], own[2]}) >= 0.0) continue;
        const auto& c = ring_[0].corners;
        farthest_ = std::max(farthest_, std::min({distance_to_segment(feet_[k], c[0], c[1]),
                                                  distance_to_segment(feet_[k], c[1], c[2]),
                                                  distance_to_segment(feet_[k], c[2], c[0])}));
    }
    farthest_ += grown(scale);
    if (!(farthest_ < ring_.free())) return SurfaceStatus::DONE;
    found = highest(side, scale) * (1.0 + ROUNDING);
    if (piece_.is_own) found = std::max(found, farthest_at_rims(side, scale));
    return SurfaceStatus::DONE;
}

/// Over all cells.
double Looker::highest(std::size_t side, double scale) const {
    const auto row = [side](std::size_t i) { return i * (side + 1) - i * (i - 1) / 2; };
    double most = 0.0;
    for (std::size_t i = 0; i < side; ++i)
        for (std::size_t j = 0; i + j < side; ++j) {
            const std::size_t a = row(i) + j, b = row(i + 1) + j;
            most = std::max(most, height_of({a, b, a + 1}, scale));
            if (i + j + 1 < side) most = std::max(most, height_of({b, b + 1, a + 1}, scale));
        }
    return most;
}

/// How far a cell may lie beyond side s of a member, a rim, from that side; 0: it cannot.
double Looker::beyond_rim(const Neighbour& member, std::size_t m, std::size_t s, const Cell& cell,
                          double grown, double beside) const {
    const std::array<double, 3>* inside = inside_.data() + m * uv_.size();
    double least = intervals::INFINITE, first = intervals::INFINITE, last = -first;
    const Point2 end = member.corners[(s + 1) % 3] - member.corners[s];
    const double length = norm(end);
    for (const std::size_t k : cell) {
        least = std::min(least, inside[k][s]);
        const double along = dot(end, feet_[k] - member.corners[s]) / length;
        first = std::min(first, along);
        last = std::max(last, along);
    }
    const double reach = farthest_ + beside;
    if (least >= beside || last < -reach || first > length + reach) return 0.0;
    // what lies beyond is so far across the side, and so far along it from its ends
    const double across = std::max(0.0, -least) + grown;
    const double past = std::max({0.0, -first, last - length}) + grown;
    return first >= grown && last <= length - grown ? across
                                                    : std::sqrt(across * across + past * past);
}

/// Of one cell: over the members that it may lie over, and from the rims that it may lie beyond.
double Looker::height_of(const Cell& cell, double scale) const {
    const std::size_t count = uv_.size();
    const double grows = grown(scale);
    const auto& [a, b, c] = cell;
    double most = 0.0, from_rim = intervals::INFINITE, own = 0.0;
    bool leaves = false;
    for (std::size_t m = 0; m < ring_.count(); ++m) {
        const Neighbour& member = ring_[m];
        const std::uint8_t* is_beyond = is_beyond_.data() + m * count;
        const bool has_rim = member.is_rim[0] || member.is_rim[1] || member.is_rim[2];
        const bool is_far = !member.is_near || (is_beyond[a] & is_beyond[b] & is_beyond[c]) != 0;
        if (m > 0 && is_far && !has_rim) continue;
        const double* height = height_.data() + m * count;
        const std::array<double, 3>* inside = inside_.data() + m * count;
        const double high =
            std::max({height[a], height[b], height[c]}) + sag(member, scale) + rounded();
        if (m == 0) own = high;
        // a foot along this member's normal is off by so much
        const double beside = grows + 2.0 * high * member.sine;
        bool is_over = true;
        for (std::size_t s = 0; s < 3; ++s) {
            if (std::max({inside[a][s], inside[b][s], inside[c][s]}) < -beside) is_over = false;
            if (!member.is_rim[s]) continue;
            const double away = beyond_rim(member, m, s, cell, grows, beside);
            if (away == 0.0) continue;
            leaves = true;
            from_rim = std::min(from_rim, std::sqrt(high * high + away * away) / member.cosine);
        }
        if (!is_over) continue;
        most = std::max(most, std::min(high / member.cosine, over_side(m, own, cell, grows)));
    }
    return leaves ? std::max(most, from_rim) : most;
}

/// Over a neighbour across one of the triangle's own sides: both planes meet in that side, so that
/// the height over the one is that over the other, and how far beyond the side times their slope.
double Looker::over_side(std::size_t m, double own, const Cell& cell, double grown) const {
    for (std::size_t s = 0; s < 3; ++s) {
        if (m == 0 || ring_.across(s) != m) continue;
        double least = 0.0;
        for (const std::size_t k : cell) least = std::min(least, inside_[k][s]);
        const Neighbour& member = ring_[m];
        const double slack = 2.0 * own * member.sine;  // along its normal, and not this one
        return own + (grown - least + slack) * member.sine / member.cosine;
    }
    return intervals::INFINITE;
}

/// How far the curves over the triangle's own rims are from them.
double Looker::farthest_at_rims(std::size_t side, double scale) const {
    const SpaceCorners& p = mesh_.corners[triangle_];
    const auto row = [side](std::size_t i) { return i * (side + 1) - i * (i - 1) / 2; };
    double most = 0.0;
    for (std::size_t s = 0; s < 3; ++s) {
        if (!ring_[0].is_rim[s]) continue;
        const Point3 along = p[(s + 1) % 3] - p[s];
        for (std::size_t k = 0; k <= side; ++k) {
            const std::size_t at = s == 0 ? row(k) : s == 1 ? row(k) + side - k : k;
            const Point3 x = points_[at].value - p[s];
            const double away = norm(x - (dot(x, along) / dot(along, along)) * along);
            most = std::max(most, away + 2.0 * points_[at].error);
        }
    }
    return most > 0.0 ? most + grown(scale) + piece_.bounds.corner : 0.0;
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
