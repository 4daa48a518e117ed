// The nodes of a size field under construction: what is asked for there, and the surface there.
//
// In: blocks of nodes as a law gives them. Out: what a background stores at its nodes. Lengths are
// in model units. The fields from `longer` on are empty where sizes are isotropic. Where they are
// not, `size` holds at right angles to `along` and is the shorter one, before gradation.
#pragma once

#include <cstdint>
#include <span>

#include "values/array.hpp"
#include "values/point.hpp"
#include "values/size_tensor.hpp"

namespace surfmesh {

/// r_x and r_y, by rows.
struct PlaneJacobian {
    double x[3][2];
};

/// Two numbers of a node: sizes, principal curvatures, or the rates of a direction.
struct NumberPair {
    double first, second;
};

struct FieldNodes {
    Array<double> size;         // wanted edge length
    Array<double> target_size;  // the same before sources and gradation have lowered it
    Array<SizeTensor> root;     // I^(1/2) in the scaled plane
    Array<Point3> normal;       // unit, zero at degenerate points
    Array<Point3> point;
    Array<double> longer;  // wanted length along `along`
    Array<double> longer_target;
    Array<Point3> along;  // unit tangent
    Array<PlaneJacobian> jacobian;
    Array<NumberPair> asked;       // size and longer before gradation
    Array<NumberPair> curvature;   // principal curvatures
    Array<NumberPair> turn_rates;  // at which `along` fans out and bends; 0 where it hardly counts

    [[nodiscard]] std::size_t count() const { return size.size(); }
    [[nodiscard]] bool is_anisotropic() const { return !longer.empty(); }
    /// Are all arrays as long as the first, or empty where sizes are isotropic?
    [[nodiscard]] bool is_complete() const;
    /// The others behind these.
    void append(const FieldNodes& others);
    /// Where one size was asked for: gradation may stretch it, but only along `along`.
    [[nodiscard]] bool is_round(std::ptrdiff_t node) const;
    /// The same metric with the longer size along `along`: gradation may have swapped them.
    void put_in_order();
    /// A = H^-1 = M^(1/2) in the scaled plane.
    [[nodiscard]] SizeTensor metric_root(std::ptrdiff_t node) const;
    /// W = Id / h - (1 / h - 1 / longer) t t^T, t = along; empty where sizes are isotropic.
    ///
    /// Across the surface the shorter size holds, so that W does not change where the surface
    /// bends about its straighter direction alone.
    [[nodiscard]] Array<MetricRoot3> metric_roots_3d() const;
};

}  // namespace surfmesh
