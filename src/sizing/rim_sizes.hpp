// The edge length that the curvature of a rim allows, the part within the surface included.
//
// A rim is a space curve: between two nodes h apart it sags by h^2 k / 8 from its chord, where k is
// its own curvature. The surface's normal curvature is only a part of that: a flat disc has none.
//
//       .--- rim ---.        k^2 = (normal curvature along the rim)^2 + (geodesic curvature)^2
//     o-- mesh edge --o
#pragma once

#include "surfaces/surface_reader.hpp"

namespace surfmesh {

/// Fraction of ``chord`` that an edge of the wanted length may sag by: a line is cut into equal
/// edges, which are never much longer than wanted, unlike the sides of triangles.
inline constexpr double RIM_RESERVE = 0.95;

/// In ``chord``: a shorter edge is within ``chord`` of its arc, whatever the curvature.
inline constexpr double LEAST_RIM = 2.0;

/// A size that holds along a rim only: infinite where the rim is straight.
struct RimSize {
    double size;
    Point3 tangent;  // unit, or zero where the line has no speed, as at a pole
};

/// At points i of what was read to order 2, of lines of (u, v) in the directions ``step``.
RimSize rim_size(const SurfaceReader& surface, std::size_t i, Point2 step, double chord);

}  // namespace surfmesh
