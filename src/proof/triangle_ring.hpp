// A triangle with those around it, as seen along its normal.
//
// In: the triangles of one face, their bounds so far; a triangle. Out: its plane and axes; those
// around it, layer by layer, each with its plane and its shadow on that of the triangle; how far
// the boundary of them all, but for rims, is from the triangle, less what the surface's curve over
// it is shifted by. Said to be of no use where a normal is turned by more than 60 degrees, where
// shadows fold, or where nothing is bounded.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "proof/side_distances.hpp"
#include "proof/triangle_bounds.hpp"
#include "values/array.hpp"
#include "values/conventions.hpp"

namespace surfmesh {

/// A plane through a triangle.
struct TrianglePlane {
    Point3 point, normal;
    double tilt;  // by how much the normal may be wrong
};

/// Two directions across a normal.
using Axes2 = std::array<Point3, 2>;

inline Point2 seen(const Axes2& axes, Point3 x) { return {dot(axes[0], x), dot(axes[1], x)}; }

/// One of the triangles around, as seen along the normal of the triangle that is looked at.
struct Neighbour {
    TrianglePlane plane;
    std::array<Point2, 3> corners, inward;  // unit normals of its sides, to the inside
    double cosine, sine;
    std::array<bool, 3> is_rim;  // of the sides
    bool is_near;                // may a cell lie over it?
};

/// Half-edges with a twin after them whose ends have other (u, v) in the twin's triangle: seams, and
/// sides that end in a pole.
Array<std::int32_t> parted_half_edges(std::span<const PlaneCorners> uv,
                                      std::span<const std::int32_t> twins);

/// The triangles at each vertex, as many rings ask for them.
class TrianglesAtVertices {
  public:
    /// vertices (3 m,): of m triangles.
    explicit TrianglesAtVertices(std::span<const std::int32_t> vertices);

    [[nodiscard]] std::span<const std::int32_t> operator[](std::int32_t vertex) const {
        return {triangles_.begin() + first_[vertex], triangles_.begin() + first_[vertex + 1]};
    }

  private:
    Array<std::int32_t> first_, triangles_;  // one vertex after the other
};

class TriangleRing {
  public:
    static constexpr double ROUNDING = 0x1p-45;  // relative, more than that of any sum here

    TriangleRing(const ProofMesh& mesh, const TrianglesAtVertices& at_vertices,
                 SideDistances& sides);

    /// Begin anew with one triangle alone; false where no statement is made with it.
    bool begin(std::int32_t t);
    /// Take all that share a vertex with those so far; false where no statement holds with them.
    bool add_layer();

    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] Neighbour& operator[](std::size_t member) { return ring_[member]; }
    [[nodiscard]] const Neighbour& operator[](std::size_t member) const { return ring_[member]; }
    [[nodiscard]] std::int32_t number(std::size_t member) const {
        return members_[static_cast<std::ptrdiff_t>(member)];
    }
    /// How far a member is from the triangle, as seen.
    [[nodiscard]] double apart(std::size_t member) const;
    /// Do all triangles across a member's sides belong to the ring?
    [[nodiscard]] bool is_within(std::size_t member) const;
    /// The member over the triangle's own side; 0: none.
    [[nodiscard]] std::size_t across(std::size_t side) const { return across_[side]; }
    /// How far the boundary, but for rims, is from the triangle, less what it is shifted by.
    [[nodiscard]] double free() const { return free_; }
    [[nodiscard]] double longest() const { return longest_; }
    /// A point as seen from the triangle.
    [[nodiscard]] Point2 foot(Point3 x) const { return seen(axes_, x - origin_); }

  private:
    static constexpr std::size_t MOST = 80;

    bool take(std::int32_t other);
    [[nodiscard]] bool is_folded(std::size_t h) const;
    [[nodiscard]] double free_around();
    [[nodiscard]] double shifted_sides(double little);

    ProofMesh mesh_;
    const TrianglesAtVertices& at_vertices_;
    SideDistances& sides_;
    Array<std::size_t> boundary_;  // half-edges of the ring, but for rims
    Array<std::int32_t> mark_, members_;
    Array<std::uint8_t> is_turned_;  // the normal, against that of the triangle
    std::array<Neighbour, MOST> ring_{};
    std::size_t count_ = 0;
    std::array<std::size_t, 3> across_{};
    Axes2 axes_{};
    Point3 origin_{};
    double free_ = 0.0, longest_ = 0.0;
};

}  // namespace surfmesh
