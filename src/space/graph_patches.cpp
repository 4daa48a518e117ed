#include "space/graph_patches.hpp"

#include <algorithm>
#include <cmath>

#include "space/rim_sweep.hpp"
#include "triangulation/predicates.hpp"

namespace surfmesh {
namespace {

// of a normal: so much of it is along the axis of its patch, about 84 degrees away at most
constexpr double ALONG_AXIS = 0.1;
// triangles of a patch at least: to compare so few pair by pair costs less
constexpr std::size_t FEWEST = 6;

/// A way to look at space: along an axis, from before or behind.
struct View {
    int axis;
    bool from_behind;

    [[nodiscard]] Point2 operator()(Point3 p) const {
        const Point2 seen = axis == 0   ? Point2{p.y, p.z}
                            : axis == 1 ? Point2{p.z, p.x}
                                        : Point2{p.x, p.y};
        return from_behind ? Point2{seen.y, seen.x} : seen;
    }
    /// What of a normal comes towards the eye.
    [[nodiscard]] double towards(Point3 n) const {
        const double along = axis == 0 ? n.x : axis == 1 ? n.y : n.z;
        return from_behind ? -along : along;
    }
};

double along(int axis, Point3 p) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/// The one that a normal comes towards most.
View view_of(Point3 n) {
    const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    const int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    return {axis, (axis == 0 ? n.x : axis == 1 ? n.y : n.z) < 0.0};
}

class PatchSearch {
  public:
    PatchSearch(std::span<const Point3> points, std::span<const TriangleCorners> triangles,
                std::span<const HalfEdge> twins)
        : points_(points),
          triangles_(triangles),
          twins_(twins),
          patch_(triangles.size(), NIL),
          grown_(triangles.size(), NIL) {}

    GraphPatches run() {
        if (is_one_graph()) {
            patch_.fill(0);
            return {std::move(patch_), Array<std::int32_t>(1, NIL), std::move(sides_)};
        }
        for (std::size_t t = 0; t < triangles_.size(); ++t)
            if (grown_[t] == NIL) look_from(static_cast<std::int32_t>(t));
        return {std::move(patch_), std::move(flat_across_), std::move(rims_)};
    }

  private:
    [[nodiscard]] Point3 normal(std::size_t t) const {
        const TriangleCorners& k = triangles_[t];
        return cross(points_[k.b] - points_[k.a], points_[k.c] - points_[k.a]);
    }

    /// Is an open surface a patch as a whole, however steep? Over the plane that the sum of its
    /// normals says, no triangle has to be grown, and its rim is where there is nothing beside.
    bool is_one_graph() {
        if (std::find(twins_.begin(), twins_.end(), NIL) == twins_.end()) return false;
        Point3 sum{0.0, 0.0, 0.0};
        for (std::size_t t = 0; t < triangles_.size(); ++t) sum = sum + normal(t);
        const View view = view_of(sum);
        for (std::size_t t = 0; t < triangles_.size(); ++t)
            if (!turns_to(t, view)) return false;
        clear_rim();
        for (std::size_t e = 0; e < twins_.size(); ++e)
            if (twins_[e] == NIL)
                add_to_rim(static_cast<std::int32_t>(e / 3), static_cast<std::int32_t>(e % 3),
                           view);
        return is_simple_rim(rim_);
    }

    /// Does a triangle turn towards the eye? Exact.
    [[nodiscard]] bool turns_to(std::size_t t, const View& view) const {
        const TriangleCorners& k = triangles_[t];
        return orient(view(points_[k.a]), view(points_[k.b]), view(points_[k.c])) > 0.0;
    }

    /// Does it so not too steeply?
    [[nodiscard]] bool faces(std::size_t t, const View& view) const {
        const Point3 n = normal(t);
        const double towards = view.towards(n);
        if (!(towards > 0.0 && towards * towards >= ALONG_AXIS * ALONG_AXIS * dot(n, n)))
            return false;
        return turns_to(t, view);
    }

    /// Does it lie in a plane across the axis? Exact.
    [[nodiscard]] bool is_across(std::size_t t, int axis) const {
        const TriangleCorners& k = triangles_[t];
        const double a = along(axis, points_[k.a]);
        return a == along(axis, points_[k.b]) && a == along(axis, points_[k.c]);
    }

    /// Do two triangles beside each other turn by more than 60 degrees?
    [[nodiscard]] bool are_creased(std::size_t s, std::size_t t) const {
        const Point3 m = normal(s), n = normal(t);
        const double along = dot(m, n);
        return !(along > 0.0 && along * along > 0.25 * dot(m, m) * dot(n, n));
    }

    /// Find a patch that has a triangle, or parts of one. Where one across creases hides part of
    /// itself, as a floor and walls seen aslant, others of the mesh would: all end at creases then.
    void look_from(std::int32_t seed) {
        const View view = view_of(normal(seed));
        grow(seed, view);
        if (members_.size() < FEWEST) return;
        number_as_patch(members_, view);
        if (keeps_rim()) return;
        if (ends_at_creases_) return keep_halves(members_, view);
        ends_at_creases_ = true;
        for (const std::int32_t t : members_) patch_[t] = grown_[t] = NIL;
        look_from(seed);
    }

    /// Is it of the patch that is grown, if an edge of that is its own?
    [[nodiscard]] bool belongs(std::size_t t, const View& view) const {
        if (is_across(t, view.axis) != is_flat_) return false;
        return is_flat_ ? turns_to(t, view) : faces(t, view);
    }

    /// Fill ``members_``, across edges, with triangles that face the eye and are in no patch, and
    /// the rim with the sides where it goes no further.
    void grow(std::int32_t seed, const View& view) {
        members_.clear();
        clear_rim();
        members_.push_back(seed);
        grown_[seed] = seed;
        if (!faces(seed, view)) return members_.clear();
        is_flat_ = is_across(seed, view.axis);
        for (std::size_t k = 0; k < members_.size(); ++k)
            for (std::int32_t side = 0; side < 3; ++side) {
                const HalfEdge twin = twins_[3 * members_[k] + side];
                const std::int32_t beside = twin == NIL ? NIL : twin / 3;
                if (beside != NIL && grown_[beside] == seed) continue;
                if (beside == NIL || grown_[beside] != NIL || !belongs(beside, view) ||
                    (ends_at_creases_ && !is_flat_ && are_creased(members_[k], beside))) {
                    add_to_rim(members_[k], side, view);
                    continue;
                }
                grown_[beside] = seed;
                members_.push_back(beside);
            }
    }

    void number_as_patch(std::span<const std::int32_t> members, const View& view) {
        const auto number = static_cast<std::int32_t>(flat_across_.size());
        for (const std::int32_t t : members) patch_[t] = number;
        flat_across_.push_back(is_flat_ ? view.axis : NIL);
    }

    /// Is the rim that is gathered simple, and its triangles with a number of their own a patch?
    bool keeps_rim() {
        if (!is_simple_rim(rim_)) return false;
        for (const HalfEdge side : sides_) rims_.push_back(side);
        return true;
    }

    /// Triangles are no patch, but those of both halves may be: where it winds round an axis, parts of
    /// it are.
    void keep_halves(std::span<const std::int32_t> members, const View& view) {
        for (const std::int32_t t : members) patch_[t] = NIL;
        const std::size_t half = members.size() / 2;
        for (const auto part : {members.first(half), members.subspan(half)}) {
            if (part.size() < FEWEST) continue;
            number_as_patch(part, view);
            gather_rim(part, view);
            if (!keeps_rim()) keep_halves(part, view);
        }
    }

    /// The sides of triangles that have a number of their own beside others.
    void gather_rim(std::span<const std::int32_t> members, const View& view) {
        clear_rim();
        for (const std::int32_t t : members)
            for (std::int32_t side = 0; side < 3; ++side) {
                const HalfEdge twin = twins_[3 * t + side];
                if (twin == NIL || patch_[twin / 3] != patch_[t]) add_to_rim(t, side, view);
            }
    }

    void clear_rim() {
        rim_.clear();
        sides_.clear();
    }

    void add_to_rim(std::int32_t triangle, std::int32_t side, const View& view) {
        const TriangleCorners& c = triangles_[triangle];
        const Vertex corner[] = {c.a, c.b, c.c};
        const Vertex start = corner[side], end = corner[(side + 1) % 3];
        rim_.push_back({start, end, view(points_[start]), view(points_[end])});
        sides_.push_back(3 * triangle + side);
    }

    std::span<const Point3> points_;
    std::span<const TriangleCorners> triangles_;
    std::span<const HalfEdge> twins_;
    Array<std::int32_t> patch_;    // of each triangle, proved
    Array<std::int32_t> grown_;    // the seed of each triangle
    Array<std::int32_t> members_;  // of the patch that is grown
    bool is_flat_ = false;         // it too
    bool ends_at_creases_ = false;
    Array<RimEdge> rim_;     // of the triangles that are looked at
    Array<HalfEdge> sides_;  // the same
    Array<std::int32_t> flat_across_;
    Array<HalfEdge> rims_;
};

}  // namespace

GraphPatches graph_patches(std::span<const Point3> points,
                           std::span<const TriangleCorners> triangles,
                           std::span<const HalfEdge> twins) {
    return PatchSearch(points, triangles, twins).run();
}

}  // namespace surfmesh
