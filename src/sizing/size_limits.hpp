// Upper bounds of the size near points: where a round of meshing has found it too large, or where
// edges have been cut.
//
// At distance d from point k the size is at most sizes[k] + slope d. Where tensors W are given, in
// the unit direction e it is at most 1 / |W e| there.
#pragma once

#include <array>
#include <span>

#include "space/point_tree.hpp"
#include "values/array.hpp"
#include "values/point.hpp"
#include "values/size_tensor.hpp"

namespace surfmesh {

/// How many of the points may decide at a place: the others are farther and not much finer.
inline constexpr std::size_t NEAREST_LIMITS = 8;

class SizeLimits {
  public:
    /// metric_root_3d: W of each point, or none where sizes hold in every direction.
    SizeLimits(std::span<const Point3> points, std::span<const double> sizes, double slope,
               std::span<const MetricRoot3> metric_root_3d);

    /// Largest size at a place.
    [[nodiscard]] double at(Point3 place) const;
    /// Largest size there in a unit direction.
    [[nodiscard]] double along(Point3 place, Point3 direction) const;
    /// The smallest size in any direction of a tangent plane, and a unit direction it holds in.
    struct Tightest {
        double size;
        Point3 direction;
    };
    [[nodiscard]] Tightest tightest(Point3 place, Point3 normal) const;

  private:
    using Near = std::array<NearPoint, NEAREST_LIMITS>;
    [[nodiscard]] double least_of(const Near& near, std::size_t count) const;

    PointTree tree_;
    Array<double> sizes_;
    double slope_;
    Array<MetricRoot3> metric_root_3d_;
};

}  // namespace surfmesh
