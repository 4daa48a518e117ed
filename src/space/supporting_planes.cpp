#include "space/supporting_planes.hpp"

#include <algorithm>

namespace surfmesh {
namespace {

constexpr SupportingPatches NO_SUPPORT = {NIL, NIL, NIL, NIL, NIL, NIL};
constexpr std::int32_t REFUTED = -2;  // there was a number, which does not hold

/// Put the number of a patch where there is none; where there is another, neither holds.
void put_alone(std::int32_t& place, std::int32_t patch) {
    place = place == NIL || place == patch ? patch : REFUTED;
}

class SupportSearch {
  public:
    SupportSearch(std::span<const Point3> points, std::span<const TriangleCorners> triangles,
                  std::span<const HalfEdge> twins, const GraphPatches& patches)
        : points_(points),
          triangles_(triangles),
          twins_(twins),
          patches_(patches),
          level_(patches.flat_across.size()),
          support_(patches.flat_across.size(), NO_SUPPORT) {}

    Array<SupportingPatches> run() {
        if (!look_at_flat_rims()) return std::move(support_);
        for (const HalfEdge e : patches_.rims) look_across(e);
        for (std::size_t t = 0; t < triangles_.size(); ++t) hold_against(t);
        for (SupportingPatches& found : support_)
            for (std::int32_t& patch : found) patch = std::max(patch, NIL);
        return std::move(support_);
    }

  private:
    /// Coordinate of a vertex along an axis.
    [[nodiscard]] double at(std::int32_t axis, Vertex v) const {
        const Point3 p = points_[v];
        return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
    }
    /// Where the k-th half-edge after one of its triangle starts.
    [[nodiscard]] Vertex corner(HalfEdge e, std::int32_t k) const {
        return corners_in_a_row(triangles_)[e - e % 3 + (e + k) % 3];
    }

    /// Where flat patches are, and which vertices of their rims are of which. Are there any?
    bool look_at_flat_rims() {
        flat_at_.resize(points_.size(), {NIL, NIL, NIL});
        bool is_any = false;
        for (const HalfEdge e : patches_.rims) {
            const std::int32_t patch = patches_.of(e), axis = patches_.flat_across[patch];
            if (axis == NIL) continue;
            is_any = true;
            level_[patch] = at(axis, corner(e, 0));
            put_alone(flat_at_[corner(e, 0)][axis], patch);
        }
        return is_any;
    }

    /// Is there a flat patch beside a side of a rim, which may support it?
    void look_across(HalfEdge e) {
        const std::int32_t flat = patches_.of(twins_[e]);
        const std::int32_t axis = flat == NIL ? NIL : patches_.flat_across[flat];
        if (axis == NIL) return;
        const double third = at(axis, corner(e, 2)), level = level_[flat];
        if (third != level)
            put_alone(support_[patches_.of(e)][third > level ? axis : axis + 3], flat);
    }

    /// Take back what does not hold for a triangle.
    void hold_against(std::size_t t) {
        const std::int32_t patch = patches_.of_triangles[t];
        if (patch == NIL || support_[patch] == NO_SUPPORT) return;
        for (std::int32_t axis = 0; axis < 3; ++axis) {
            std::int32_t &below = support_[patch][axis], &above = support_[patch][axis + 3];
            if (below >= 0 && !is_supported(t, axis, below, 1.0)) below = REFUTED;
            if (above >= 0 && !is_supported(t, axis, above, -1.0)) above = REFUTED;
        }
    }

    /// Is a triangle on one side of the plane of a flat patch, and what it has in it part of that,
    /// which is one side or one corner?
    [[nodiscard]] bool is_supported(std::size_t t, std::int32_t axis, std::int32_t flat,
                                    double side) const {
        const std::array<Vertex, 3> corners = {triangles_[t].a, triangles_[t].b, triangles_[t].c};
        std::array<double, 3> height;
        for (std::size_t k = 0; k < 3; ++k)
            height[k] = side * (at(axis, corners[k]) - level_[flat]);
        const double lowest = std::min(std::min(height[0], height[1]), height[2]);
        if (lowest != 0.0) return lowest > 0.0;
        if (height[0] == height[1] && height[1] == height[2]) return false;
        for (std::size_t k = 0; k < 3; ++k) {
            if (height[k] != 0.0) continue;
            if (flat_at_[corners[k]][axis] != flat) return false;
            if (height[(k + 1) % 3] == 0.0 && patches_.of(twins_[3 * t + k]) != flat) return false;
        }
        return true;
    }

    std::span<const Point3> points_;
    std::span<const TriangleCorners> triangles_;
    std::span<const HalfEdge> twins_;
    const GraphPatches& patches_;
    Array<double> level_;                         // of each flat patch, along its axis
    Array<std::array<std::int32_t, 3>> flat_at_;  // of each vertex, across each axis
    Array<SupportingPatches> support_;            // of each patch
};

}  // namespace

Array<SupportingPatches> supporting_patches(std::span<const Point3> points,
                                            std::span<const TriangleCorners> triangles,
                                            std::span<const HalfEdge> twins,
                                            const GraphPatches& patches) {
    return SupportSearch(points, triangles, twins, patches).run();
}

}  // namespace surfmesh
