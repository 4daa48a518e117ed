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

    struct Tightest {
        double size;
        Point3 direction;
    };

    /// What the limits say at one place; they outlive it.
    class Here {
      public:
        Here(const SizeLimits& limits, Point3 place)
            : limits_(limits), count_(limits.tree_.nearest(place, near_)) {}

        /// Largest size in every direction.
        [[nodiscard]] double least() const;
        /// Largest size in a unit direction.
        [[nodiscard]] double along(Point3 direction) const;
        /// The smallest size in any direction of a tangent plane, and a unit direction it holds in.
        [[nodiscard]] Tightest tightest(Point3 normal) const;

      private:
        const SizeLimits& limits_;
        std::array<NearPoint, NEAREST_LIMITS> near_;
        std::size_t count_;
    };

    /// Largest size at a place.
    [[nodiscard]] double at(Point3 place) const { return Here(*this, place).least(); }

  private:
    PointTree tree_;
    Array<double> sizes_;
    double slope_;
    Array<MetricRoot3> metric_root_3d_;
};

}  // namespace surfmesh
