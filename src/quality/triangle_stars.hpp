// The triangles at each vertex of a mesh, and how far points lie from those near them.
//
//        o---o           p x      walk: from a triangle to the nearest of those that share a
//       / \ / \                   corner with it, as long as one is nearer; among long thin
//      o---o---o                  triangles it may end early, so what is found is a bound
//       \ / \ /
//        o---o
//
// In: points and triangles, which outlive the stars; all numbers are in range. Nothing changes.
#pragma once

#include <cstdint>
#include <span>

#include "space/box_tree.hpp"
#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

class TriangleStars {
  public:
    TriangleStars(std::span<const Point3> points, std::span<const TriangleCorners> triangles);

    [[nodiscard]] std::size_t vertices() const { return points_.size(); }
    [[nodiscard]] std::size_t triangles() const { return corners_.size(); }
    /// Distance from one triangle.
    [[nodiscard]] double from(Point3 place, std::int32_t triangle) const;
    /// Distance from the triangle where the walk from ``triangle`` ends, if it is less.
    [[nodiscard]] double walk(Point3 place, std::int32_t triangle, double distance) const;
    /// Distance from all triangles, if it is less.
    [[nodiscard]] double from_all(Point3 place, double distance) const;
    /// Distance from the triangles at some vertices; infinite where there is none.
    [[nodiscard]] double from_stars(Point3 place, std::span<const std::int32_t> vertices) const;

  private:
    [[nodiscard]] std::span<const std::int32_t> at(Vertex vertex) const {
        return {members_.data() + first_[vertex],
                static_cast<std::size_t>(first_[vertex + 1] - first_[vertex])};
    }

    std::span<const Point3> points_;
    std::span<const TriangleCorners> corners_;
    Array<std::int32_t> members_, first_;
};

}  // namespace surfmesh
