#include "proof/triangle_ring.hpp"

#include <algorithm>
#include <cmath>

#include "values/segment.hpp"

namespace surfmesh {
namespace {

constexpr double LEAST_COSINE = 0.5;     // of 60 degrees
constexpr double FLATTEST = 0x1p-13;     // tilt of a normal, which heights and angles have in them
constexpr double LITTLE_SHIFTED = 0.25;  // of how far the boundary is: no need to look closer

TrianglePlane plane_of(const SpaceCorners& p, double corner) {
    const Point3 a = p[1] - p[0], b = p[2] - p[0], n = cross(a, b);
    const double area = norm(n), longest = std::max({norm(a), norm(b), norm(p[2] - p[1])});
    const double tilt = (32.0 * 0x1p-53 * longest * longest + 8.0 * corner * longest) / area;
    return {p[0], (1.0 / area) * n, tilt < FLATTEST ? tilt : intervals::INFINITE};
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

}  // namespace

Array<std::int32_t> parted_half_edges(std::span<const PlaneCorners> uv,
                                      std::span<const std::int32_t> twins) {
    Array<std::int32_t> found;
    const auto differ = [](Point2 a, Point2 b) { return a.x != b.x || a.y != b.y; };
    for (std::size_t h = 0; h < twins.size(); ++h) {
        if (twins[h] <= static_cast<std::int32_t>(h)) continue;
        const auto twin = static_cast<std::size_t>(twins[h]);
        const PlaneCorners &a = uv[h / 3], &b = uv[twin / 3];
        if (differ(a[h % 3], b[(twin % 3 + 1) % 3]) || differ(a[(h % 3 + 1) % 3], b[twin % 3]))
            found.push_back(static_cast<std::int32_t>(h));
    }
    return found;
}

TrianglesAtVertices::TrianglesAtVertices(std::span<const std::int32_t> vertices) {
    std::int32_t count = 0;
    for (const std::int32_t v : vertices) count = std::max(count, v + 1);
    first_.resize(static_cast<std::size_t>(count) + 1, 0);
    for (const std::int32_t v : vertices) ++first_[v + 1];
    for (std::int32_t v = 0; v < count; ++v) first_[v + 1] += first_[v];
    triangles_.resize(vertices.size());
    Array<std::int32_t> next(first_);
    for (std::size_t h = 0; h < vertices.size(); ++h)
        triangles_[next[vertices[h]]++] = static_cast<std::int32_t>(h / 3);
}

TriangleRing::TriangleRing(const ProofMesh& mesh, const TrianglesAtVertices& at_vertices,
                           SideDistances& sides)
    : mesh_(mesh),
      at_vertices_(at_vertices),
      sides_(sides),
      mark_(mesh.corners.size(), -1),
      is_turned_(mesh.corners.size(), 0) {}

bool TriangleRing::take(std::int32_t other) {
    if (count_ == MOST) return false;
    Neighbour& member = ring_[count_++];
    const SpaceCorners& p = mesh_.corners[other];
    const TriangleBounds& bounds = mesh_.bounds[other];
    member.plane = plane_of(p, bounds.corner);
    if (!(member.plane.tilt < FLATTEST) || !(bounds.whole < intervals::INFINITE)) return false;
    const TrianglePlane& own = ring_[0].plane;
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

bool TriangleRing::begin(std::int32_t t) {
    const SpaceCorners& p = mesh_.corners[t];
    const TrianglePlane own = plane_of(p, mesh_.bounds[t].corner);
    if (!(own.tilt < FLATTEST)) return false;
    const Point3 along = p[1] - p[0], first = (1.0 / norm(along)) * along;
    axes_ = {first, cross(own.normal, first)};
    origin_ = p[0];
    count_ = 0;
    across_ = {};
    ring_[0].plane = own;
    longest_ = std::max({norm(along), norm(p[2] - p[1]), norm(p[0] - p[2])});
    members_.clear();
    members_.push_back(t);
    return take(t);
}

bool TriangleRing::add_layer() {
    const std::int32_t t = members_[0];
    const std::size_t before = members_.size();
    for (std::size_t k = 0; k < 3 * before; ++k) {
        const std::int32_t member = members_[static_cast<std::ptrdiff_t>(k / 3)];
        const std::int32_t v = mesh_.vertices[3 * static_cast<std::size_t>(member) + k % 3];
        for (const std::int32_t other : at_vertices_[v]) {
            if (mark_[other] == t) continue;
            members_.push_back(other);
            if (!take(other)) return false;
            for (std::size_t s = 0; s < 3; ++s) {
                const std::int32_t twin = mesh_.twins[3 * static_cast<std::size_t>(t) + s];
                if (twin != NIL && twin / 3 == other) across_[s] = count_ - 1;
            }
        }
    }
    free_ = free_around();
    return true;
}

/// Do two members lie on the same side of their common side, as seen?
bool TriangleRing::is_folded(std::size_t h) const {
    const std::int32_t twin = mesh_.twins[h];
    const bool run_alike = mesh_.vertices[h] == mesh_.vertices[twin];
    return run_alike != (is_turned_[static_cast<std::ptrdiff_t>(h / 3)] != is_turned_[twin / 3]);
}

double TriangleRing::free_around() {
    const std::int32_t t = members_[0];
    const auto& own = ring_[0].corners;
    double nearest = 8.0 * longest_;
    boundary_.clear();
    for (const std::int32_t other : members_) {
        const SpaceCorners& p = mesh_.corners[other];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t h = 3 * static_cast<std::size_t>(other) + k;
            const std::int32_t twin = mesh_.twins[h];
            if (twin == NIL) continue;
            if (mark_[twin / 3] == t) {
                if (is_folded(h)) return 0.0;
                continue;
            }
            boundary_.push_back(h);
            const Point2 a = seen(axes_, p[k] - origin_), b = seen(axes_, p[(k + 1) % 3] - origin_);
            for (std::size_t s = 0; s < 3; ++s)
                nearest = std::min(nearest, distance_of_segments(own[s], own[(s + 1) % 3], a, b));
        }
    }
    const double shifted = shifted_sides(LITTLE_SHIFTED * nearest);
    return (1.0 - ROUNDING) * nearest - (1.0 + ROUNDING) * shifted - ROUNDING * longest_;
}

/// How far the curves over the boundary are from it; by their points where that may be more than a little.
double TriangleRing::shifted_sides(double little) {
    double most = 0.0;
    for (const std::size_t h : boundary_) {
        const TriangleBounds& bounds = mesh_.bounds[h / 3];
        const double shifted = 0.25 * bounds.shift + bounds.corner;
        most = std::max(most, shifted > little ? std::min(shifted, sides_.at(h)) : shifted);
    }
    return most;
}

double TriangleRing::apart(std::size_t member) const {
    const auto &own = ring_[0].corners, &other = ring_[member].corners;
    double least = intervals::INFINITE;
    for (std::size_t s = 0; s < 3; ++s)
        for (std::size_t k = 0; k < 3; ++k)
            least = std::min(least, distance_of_segments(own[s], own[(s + 1) % 3], other[k],
                                                         other[(k + 1) % 3]));
    return std::max(0.0, (1.0 - ROUNDING) * least - ROUNDING * longest_);
}

bool TriangleRing::is_within(std::size_t member) const {
    for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t twin = mesh_.twins[3 * static_cast<std::size_t>(number(member)) + k];
        if (twin != NIL && mark_[twin / 3] != members_[0]) return false;
    }
    return true;
}

}  // namespace surfmesh
