// The points of a set that are nearest to a place: a k-d tree with a few points a leaf.
//
// In: points in space. Out: for any place the nearest of them with their distances, the nearest
// first; of equally near ones that with the smaller number. The set does not change.
//
// Source: J.L. Bentley, Multidimensional binary search trees used for associative searching,
// Communications of the ACM 18, 1975.
#pragma once

#include <cstdint>
#include <span>

#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

struct NearPoint {
    double distance;  // its square while it is searched for
    std::int32_t number;
};

class PointTree {
  public:
    explicit PointTree(std::span<const Point3> points);

    [[nodiscard]] std::size_t size() const { return points_.size(); }
    /// The near.size() nearest points, or as many as there are: so many are written.
    std::size_t nearest(Point3 place, std::span<NearPoint> near) const;

  private:
    /// A part of the points: those from ``first`` to ``last``, within a box.
    struct Part {
        double low[3], high[3];
        std::int32_t first, last;
        std::int32_t child;  // number of the first of two halves, or NIL
    };

    void build(std::int32_t part);
    void search(std::int32_t part, Point3 place, std::span<NearPoint> near,
                std::size_t& found) const;

    Array<Point3> points_;        // part by part
    Array<std::int32_t> number_;  // of each in the given set
    Array<Part> parts_;           // halves stand side by side
};

/// The ``count`` nearest points of each place, place by place; count <= tree.size(). distance,
/// number: so many for each.
void nearest_points(const PointTree& tree, std::span<const Point3> places, std::size_t count,
                    std::span<double> distance, std::span<std::int32_t> number);

}  // namespace surfmesh
