#include "proof/closer_look.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh {
namespace {

constexpr double ROUNDING = 0x1p-45;  // relative, more than that of any sum here
constexpr double LEAST_COSINE = 0.5;  // of 60 degrees
constexpr double FLATTEST = 0x1p-20;  // tilt of a normal
constexpr int FIRST_LEVEL = 2;
constexpr std::size_t MOST_AROUND = 80;  // triangles
constexpr int LAYERS = 2;                // of triangles around

struct Plane3 {
    Point3 point, normal;
    double tilt;  // by how much the normal may be wrong
};

Plane3 plane_of(const SpaceCorners& p, double corner) {
    const Point3 a = p[1] - p[0], b = p[2] - p[0], n = cross(a, b);
    const double area = norm(n), longest = std::max({norm(a), norm(b), norm(p[2] - p[1])});
    const double tilt = (32.0 * 0x1p-53 * longest * longest + 8.0 * corner * longest) / area;
    return {p[0], (1.0 / area) * n, tilt < FLATTEST ? tilt : intervals::INFINITE};
}

/// Rows of triangles at each vertex, one after the other.
struct Around {
    Array<std::int32_t> first, triangles;

    explicit Around(const ProofMesh& mesh) {
        std::int32_t count = 0;
        for (const std::int32_t v : mesh.vertices) count = std::max(count, v + 1);
        first.resize(static_cast<std::size_t>(count) + 1, 0);
        for (const std::int32_t v : mesh.vertices) ++first[v + 1];
        for (std::int32_t v = 0; v < count; ++v) first[v + 1] += first[v];
        triangles.resize(mesh.vertices.size());
        Array<std::int32_t> next(first);
        for (std::size_t h = 0; h < mesh.vertices.size(); ++h)
            triangles[next[mesh.vertices[h]]++] = static_cast<std::int32_t>(h / 3);
    }
};

using Axes2 = std::array<Point3, 2>;

Point2 seen(const Axes2& axes, Point3 x) { return {dot(axes[0], x), dot(axes[1], x)}; }

double distance_to_segment(Point2 x, Point2 a, Point2 b) {
    const Point2 along = b - a;
    const double length = dot(along, along);
    const double t = length > 0.0 ? std::clamp(dot(x - a, along) / length, 0.0, 1.0) : 0.0;
    return norm(x - a - t * along);
}

double turn(Point2 a, Point2 b, Point2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Of two segments; zero where they cross.
double distance_of_segments(Point2 a, Point2 b, Point2 c, Point2 d) {
    if (turn(a, b, c) * turn(a, b, d) <= 0.0 && turn(c, d, a) * turn(c, d, b) <= 0.0) return 0.0;
    return std::min({distance_to_segment(a, c, d), distance_to_segment(b, c, d),
                     distance_to_segment(c, a, b), distance_to_segment(d, a, b)});
}

/// One of the triangles around, as seen along the normal of the triangle that is looked at.
struct Neighbour {
    Plane3 plane;
    std::array<Point2, 3> corners, inward;  // unit normals of its sides, to the inside
    double cosine, sine;
    std::array<bool, 3> is_rim;  // of the sides
    bool is_near;                // may a cell lie over it?
};

/// A triangle with those around it, itself first.
struct Ring {
    std::array<Neighbour, MOST_AROUND> members;
    std::size_t count = 0;
    std::array<std::size_t, 3> across{};  // members over the triangle's own sides; 0: none
    double free;  // how far the ring's boundary, but for rims, is from the triangle, less its shift
    double longest;
};

/// What is cut into cells: the triangle's own piece of the surface, or a gap beside it.
struct Piece {
    PlaneCorners uv;
    TriangleBounds bounds;
    bool is_own;
};

/// The corners of a cell, as rows of points.
using Cell = std::array<std::size_t, 3>;

class Looker {
  public:
    Looker(const Surface& surface, const ProofMesh& mesh, const PoleGaps& gaps)
        : surface_(surface),
          mesh_(mesh),
          gaps_(gaps),
          bounds_(mesh.bounds),
          around_(mesh),
          mark_(mesh.corners.size(), -1),
          is_turned_(mesh.corners.size(), 0) {}

    /// Lower ``bound`` as far as the look shows.
    SurfaceStatus look(std::int32_t t, double limit, int levels, double& bound) {
        if (!begin(t)) return SurfaceStatus::DONE;
        if (const auto status = look_point_by_point(t, limit, levels, bound);
            status != SurfaceStatus::DONE)
            return status;
        for (int layer = 0; layer < LAYERS && !(bound <= limit); ++layer) {
            if (!add_layer(t)) return SurfaceStatus::DONE;
            if (!(ring_.free > 0.0)) continue;
            const auto status = look_with_ring(t, limit, levels, bound);
            if (status != SurfaceStatus::DONE) return status;
        }
        return SurfaceStatus::DONE;
    }

  private:
    /// At the triangle's own piece, and at the gaps beside it.
    SurfaceStatus look_with_ring(std::int32_t t, double limit, int levels, double& bound) {
        double most = intervals::INFINITE;
        piece_ = {mesh_.uv[t], bounds_[t], true};
        if (const auto status = look_at_piece(limit, levels, most); status != SurfaceStatus::DONE)
            return status;
        const auto first = std::lower_bound(gaps_.owner.begin(), gaps_.owner.end(), t);
        for (auto gap = first; gap != gaps_.owner.end() && *gap == t; ++gap) {
            const auto k = static_cast<std::size_t>(gap - gaps_.owner.begin());
            double found = intervals::INFINITE;
            piece_ = {gaps_.uv[k], gaps_.bounds[k], false};
            if (const auto status = look_at_piece(limit, levels, found);
                status != SurfaceStatus::DONE)
                return status;
            most = std::max(most, found);
        }
        bound = std::min(bound, most);
        return SurfaceStatus::DONE;
    }
    SurfaceStatus look_at_piece(double limit, int levels, double& bound) {
        for (int level = FIRST_LEVEL; level <= levels; ++level) {
            double found = intervals::INFINITE;
            const auto status = bound_by_cells(level, found);
            if (status != SurfaceStatus::DONE) return status;
            if (found < bound) bound = found;
            // more cells take away what is between them, and no more
            const double scale = 1.0 / static_cast<double>(std::size_t{1} << (2 * level));
            const double between = scale * (piece_.bounds.height + 2.0 * piece_.bounds.whole);
            const bool is_hopeless = found < intervals::INFINITE && found - 40.0 * between > limit;
            if (bound <= limit || is_hopeless) break;
        }
        return SurfaceStatus::DONE;
    }
    SurfaceStatus look_point_by_point(std::int32_t t, double limit, int levels, double& bound);
    bool begin(std::int32_t t);
    bool add_layer(std::int32_t t);
    bool take(std::int32_t other);
    [[nodiscard]] bool is_folded(std::size_t h) const;
    [[nodiscard]] double free_around(std::int32_t t) const;
    void measure(std::size_t m, double grown);
    SurfaceStatus bound_by_cells(int level, double& found);
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
    Around around_;
    Array<std::int32_t> mark_, members_;
    Array<std::uint8_t> is_turned_;  // the normal, against that of the triangle looked at
    Ring ring_;
    Piece piece_{};
    Axes2 axes_{};
    Point3 origin_{};
    Array<Point2> uv_, feet_;
    Array<EnclosedPoint> points_;
    double rounded_uv_ = 0.0;
    double farthest_ = 0.0;  // how far a foot leaves the triangle
    // of each point and member: height over its plane, distances inside its sides
    Array<double> height_;
    Array<std::array<double, 3>> inside_;
};

bool Looker::take(std::int32_t other) {
    if (ring_.count == MOST_AROUND) return false;
    Neighbour& member = ring_.members[ring_.count++];
    const SpaceCorners& p = mesh_.corners[other];
    const TriangleBounds& bounds = bounds_[other];
    member.plane = plane_of(p, bounds.corner);
    if (!(member.plane.tilt < FLATTEST) || !(bounds.whole < intervals::INFINITE)) return false;
    const Plane3& own = ring_.members[0].plane;
    const double slack = own.tilt + member.plane.tilt + ROUNDING;
    const double cosine = dot(own.normal, member.plane.normal);
    is_turned_[other] = cosine < 0.0 ? 1 : 0;  // on one-sided surfaces
    member.cosine = std::abs(cosine) - slack;
    member.sine = norm(cross(own.normal, member.plane.normal)) + slack;
    if (!(member.cosine > LEAST_COSINE)) return false;
    for (std::size_t k = 0; k < 3; ++k) member.corners[k] = seen(axes_, p[k] - origin_);
    for (std::size_t k = 0; k < 3; ++k) {
        const Point2 side = member.corners[(k + 1) % 3] - member.corners[k];
        const double length = norm(side);
        member.inward[k] = cosine < 0.0 ? Point2{side.y / length, -side.x / length}
                                        : Point2{-side.y / length, side.x / length};
        member.is_rim[k] = mesh_.twins[3 * static_cast<std::size_t>(other) + k] == NIL;
        // the curve over a rim runs within the ends of its side then
        if (member.is_rim[k] && !(bounds.shift + bounds.corner <= length)) return false;
    }
    mark_[other] = members_[0];
    return true;
}

/// The triangle alone; false where no statement is made with it.
bool Looker::begin(std::int32_t t) {
    const SpaceCorners& p = mesh_.corners[t];
    const Plane3 own = plane_of(p, bounds_[t].corner);
    if (!(own.tilt < FLATTEST)) return false;
    const Point3 along = p[1] - p[0], first = (1.0 / norm(along)) * along;
    axes_ = {first, cross(own.normal, first)};
    origin_ = p[0];
    ring_.count = 0;
    ring_.across = {};
    ring_.members[0].plane = own;
    ring_.longest = std::max({norm(along), norm(p[2] - p[1]), norm(p[0] - p[2])});
    members_.clear();
    members_.push_back(t);
    return take(t);
}

/// |r - L| at the corners of cells, and how far it may rise between them: both ways, by itself.
SurfaceStatus Looker::look_point_by_point(std::int32_t t, double limit, int levels, double& bound) {
    if (std::binary_search(gaps_.owner.begin(), gaps_.owner.end(), t)) return SurfaceStatus::DONE;
    piece_ = {mesh_.uv[t], bounds_[t], true};
    const SpaceCorners& p = mesh_.corners[t];
    for (int level = FIRST_LEVEL; level <= levels && !(bound <= limit); ++level) {
        const std::size_t side = std::size_t{1} << level;
        if (const auto status = compute_points(side); status != SurfaceStatus::DONE) return status;
        double most = 0.0;
        const double n = static_cast<double>(side);
        std::size_t k = 0;
        for (std::size_t i = 0; i <= side; ++i)
            for (std::size_t j = 0; i + j <= side; ++j, ++k) {
                const double a = static_cast<double>(i) / n, b = static_cast<double>(j) / n;
                const Point3 flat = (1.0 - a - b) * p[0] + a * p[1] + b * p[2];
                most = std::max(most, norm(points_[k].value - flat) + 2.0 * points_[k].error);
            }
        const double size = norm(p[0]) + norm(p[1]) + norm(p[2]);
        const double between = bounds_[t].whole / (n * n);
        const double found = most * (1.0 + ROUNDING) + between + ROUNDING * 0x1p-4 * size +
                             rounded_uv_ * ring_.longest;
        bound = std::min(bound, found);
        if (most > limit) break;
    }
    return SurfaceStatus::DONE;
}

/// All triangles that share a vertex with those so far; false where no statement holds with them.
bool Looker::add_layer(std::int32_t t) {
    const std::size_t before = members_.size();
    for (std::size_t k = 0; k < 3 * before; ++k) {
        const std::int32_t member = members_[static_cast<std::ptrdiff_t>(k / 3)];
        const std::int32_t v = mesh_.vertices[3 * static_cast<std::size_t>(member) + k % 3];
        for (std::int32_t i = around_.first[v]; i < around_.first[v + 1]; ++i) {
            const std::int32_t other = around_.triangles[i];
            if (mark_[other] == t) continue;
            members_.push_back(other);
            if (!take(other)) return false;
            for (std::size_t s = 0; s < 3; ++s) {
                const std::int32_t twin = mesh_.twins[3 * static_cast<std::size_t>(t) + s];
                if (twin != NIL && twin / 3 == other) ring_.across[s] = ring_.count - 1;
            }
        }
    }
    ring_.free = free_around(t);
    return true;
}

/// Do two members lie on the same side of their common side, as seen?
bool Looker::is_folded(std::size_t h) const {
    const std::int32_t twin = mesh_.twins[h];
    const bool run_alike = mesh_.vertices[h] == mesh_.vertices[twin];
    return run_alike != (is_turned_[static_cast<std::ptrdiff_t>(h / 3)] != is_turned_[twin / 3]);
}

/// How far the ring's boundary, but for rims, is from the triangle, less what its curve is shifted
/// by.
double Looker::free_around(std::int32_t t) const {
    const auto& own = ring_.members[0].corners;
    double nearest = 8.0 * ring_.longest, shifted = 0.0;
    for (const std::int32_t other : members_) {
        const SpaceCorners& p = mesh_.corners[other];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t twin = mesh_.twins[3 * static_cast<std::size_t>(other) + k];
            if (twin == NIL) continue;
            if (mark_[twin / 3] == t) {
                if (is_folded(3 * static_cast<std::size_t>(other) + k)) return 0.0;
                continue;
            }
            const Point2 a = seen(axes_, p[k] - origin_), b = seen(axes_, p[(k + 1) % 3] - origin_);
            for (std::size_t s = 0; s < 3; ++s)
                nearest = std::min(nearest, distance_of_segments(own[s], own[(s + 1) % 3], a, b));
            shifted = std::max(shifted, 0.25 * bounds_[other].shift + bounds_[other].corner);
        }
    }
    return (1.0 - ROUNDING) * nearest - (1.0 + ROUNDING) * shifted - ROUNDING * ring_.longest;
}

/// The points of the grid with ``side`` cells along a side of the triangle.
SurfaceStatus Looker::compute_points(std::size_t side) {
    const PlaneCorners& uv = piece_.uv;
    uv_.clear();
    const double n = static_cast<double>(side);
    for (std::size_t i = 0; i <= side; ++i)
        for (std::size_t j = 0; i + j <= side; ++j) {
            const double a = static_cast<double>(i) / n, b = static_cast<double>(j) / n;
            uv_.push_back((1.0 - a - b) * uv[0] + a * uv[1] + b * uv[2]);
        }
    const auto part = [](double x, double y, double z) {  // of the range that rounding may move by
        const double size = std::max({std::abs(x), std::abs(y), std::abs(z)});
        const double range = std::max({x, y, z}) - std::min({x, y, z});
        return range > 0.0 ? 0x1p-50 * size / range : 0.0;
    };
    rounded_uv_ = part(uv[0].x, uv[1].x, uv[2].x) + part(uv[0].y, uv[1].y, uv[2].y);
    points_.resize(uv_.size());
    return surface_.enclose({uv_.data(), uv_.size()}, {points_.data(), uv_.size()});
}

/// Heights over a member's plane, and distances inside its sides; nothing where it is too far off.
void Looker::measure(std::size_t m, double grown) {
    Neighbour& member = ring_.members[m];
    const std::size_t count = uv_.size();
    double* height = height_.data() + m * count;
    std::array<double, 3>* inside = inside_.data() + m * count;
    double highest = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
        const auto& [r, error] = points_[k];
        const Point3 x = r - member.plane.point;
        const double size = std::abs(x.x) + std::abs(x.y) + std::abs(x.z);
        height[k] = std::abs(dot(member.plane.normal, x)) + 2.0 * error +
                    (member.plane.tilt + ROUNDING) * size;
        highest = std::max(highest, height[k]);
    }
    const double beside = 2.0 * (grown + highest + ROUNDING * ring_.longest);
    member.is_near = true;
    for (std::size_t s = 0; s < 3; ++s) {
        double most = -intervals::INFINITE;
        for (std::size_t k = 0; k < count; ++k) {
            inside[k][s] = dot(member.inward[s], feet_[k] - member.corners[s]);
            most = std::max(most, inside[k][s]);
        }
        if (m > 0 && most < -beside) member.is_near = false;
    }
}

SurfaceStatus Looker::bound_by_cells(int level, double& found) {
    const std::size_t side = std::size_t{1} << level;
    const double scale = 1.0 / static_cast<double>(side * side);
    if (const auto status = compute_points(side); status != SurfaceStatus::DONE) return status;
    const std::size_t count = uv_.size();
    feet_.resize(count);
    height_.resize(ring_.count * count);
    inside_.resize(ring_.count * count);
    farthest_ = 0.0;
    for (std::size_t k = 0; k < count; ++k) feet_[k] = seen(axes_, points_[k].value - origin_);
    for (std::size_t m = 0; m < ring_.count; ++m) measure(m, scale * piece_.bounds.whole);
    for (std::size_t k = 0; k < count; ++k) {
        const auto& own = inside_[k];
        if (std::min({own[0], own[1], own[2]}) >= 0.0) continue;
        const auto& c = ring_.members[0].corners;
        farthest_ = std::max(farthest_, std::min({distance_to_segment(feet_[k], c[0], c[1]),
                                                  distance_to_segment(feet_[k], c[1], c[2]),
                                                  distance_to_segment(feet_[k], c[2], c[0])}));
    }
    found = intervals::INFINITE;
    farthest_ += scale * piece_.bounds.whole + (ROUNDING + rounded_uv_) * ring_.longest;
    if (!(farthest_ < ring_.free)) return SurfaceStatus::DONE;
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
    const double rounded = (ROUNDING + rounded_uv_) * ring_.longest;
    const double grown = scale * piece_.bounds.whole + rounded;
    const auto& [a, b, c] = cell;
    double most = 0.0, from_rim = intervals::INFINITE, own = 0.0;
    bool leaves = false;
    for (std::size_t m = 0; m < ring_.count; ++m) {
        const Neighbour& member = ring_.members[m];
        const bool has_rim = member.is_rim[0] || member.is_rim[1] || member.is_rim[2];
        if (!member.is_near && !has_rim) continue;
        const double* height = height_.data() + m * count;
        const std::array<double, 3>* inside = inside_.data() + m * count;
        const double sag = scale * (piece_.bounds.height + 2.0 * member.sine * piece_.bounds.whole);
        const double high = std::max({height[a], height[b], height[c]}) + sag + rounded;
        if (m == 0) own = high;
        // a foot along this member's normal is off by so much
        const double beside = grown + 2.0 * high * member.sine;
        bool is_over = true;
        for (std::size_t s = 0; s < 3; ++s) {
            if (std::max({inside[a][s], inside[b][s], inside[c][s]}) < -beside) is_over = false;
            if (!member.is_rim[s]) continue;
            const double away = beyond_rim(member, m, s, cell, grown, beside);
            if (away == 0.0) continue;
            leaves = true;
            from_rim = std::min(from_rim, std::sqrt(high * high + away * away) / member.cosine);
        }
        if (!is_over) continue;
        most = std::max(most, std::min(high / member.cosine, over_side(m, own, cell, grown)));
    }
    return leaves ? std::max(most, from_rim) : most;
}

/// Over a neighbour across one of the triangle's own sides: both planes meet in that side, so that
/// the height over the one is that over the other, and how far beyond the side times their slope.
double Looker::over_side(std::size_t m, double own, const Cell& cell, double grown) const {
    for (std::size_t s = 0; s < 3; ++s) {
        if (m == 0 || ring_.across[s] != m) continue;
        double least = 0.0;
        for (const std::size_t k : cell) least = std::min(least, inside_[k][s]);
        const Neighbour& member = ring_.members[m];
        const double slack = 2.0 * own * member.sine;  // along its normal, and not this one
        return own + (grown - least + slack) * member.sine / member.cosine;
    }
    return intervals::INFINITE;
}

/// How far the curves over the triangle's own rims are from them.
double Looker::farthest_at_rims(std::size_t side, double scale) const {
    const SpaceCorners& p = mesh_.corners[members_[0]];
    const auto row = [side](std::size_t i) { return i * (side + 1) - i * (i - 1) / 2; };
    double most = 0.0;
    for (std::size_t s = 0; s < 3; ++s) {
        if (!ring_.members[0].is_rim[s]) continue;
        const Point3 along = p[(s + 1) % 3] - p[s];
        for (std::size_t k = 0; k <= side; ++k) {
            const std::size_t at = s == 0 ? row(k) : s == 1 ? row(k) + side - k : k;
            const Point3 x = points_[at].value - p[s];
            const double away = norm(x - (dot(x, along) / dot(along, along)) * along);
            most = std::max(most, away + 2.0 * points_[at].error);
        }
    }
    const double rounded = (ROUNDING + rounded_uv_) * ring_.longest;
    return most > 0.0 ? most + scale * piece_.bounds.whole + piece_.bounds.corner + rounded : 0.0;
}

}  // namespace

SurfaceStatus look_closer(const Surface& surface, const ProofMesh& mesh, const PoleGaps& gaps,
                          std::span<const std::int32_t> which, std::span<const double> limits,
                          int levels, std::span<double> bound) {
    Looker looker(surface, mesh, gaps);
    for (const std::int32_t t : which) {
        const auto status = looker.look(t, limits[t], levels, bound[t]);
        if (status != SurfaceStatus::DONE) return status;
    }
    return SurfaceStatus::DONE;
}

}  // namespace surfmesh
