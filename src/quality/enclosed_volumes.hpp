// The volumes that triangles enclose: sums of signed tetrahedra (divergence theorem).
//
// In: triangles around solids, facing outwards, and for each solid a point near it, which the
// tetrahedra share: to one far away the volumes would cancel in rounding. Out: one volume a solid,
// summed up without the rounding of long sums; NaN or infinite where a coordinate is.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "space/box_tree.hpp"
#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// solid: of the triangles, rows of ``apexes``.
Array<double> enclosed_volumes(std::span<const Point3> points,
                               std::span<const TriangleCorners> triangles,
                               std::span<const std::int32_t> solid, std::span<const Point3> apexes);

/// The solid behind a triangle and the one before it, or NIL.
using SolidsBeside = std::array<std::int32_t, 2>;

/// Of each solid; a triangle between two of them counts for both.
struct SolidFigures {
    Array<std::int64_t> triangles;
    Array<double> area, volume;
    std::int64_t behind = 0, before = 0, both = 0;  // triangles with a solid there
};

/// Figures of triangles: how much is between each, if it is curved, and its straight one; or none.
struct SolidParts {
    std::span<const double> area, bulge;
};

SolidFigures solid_figures(std::span<const Point3> points,
                           std::span<const TriangleCorners> triangles,
                           std::span<const SolidsBeside> beside, const SolidParts& parts,
                           std::size_t solids);

}  // namespace surfmesh
