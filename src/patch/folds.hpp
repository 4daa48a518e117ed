// Angles between the normals of triangles and surface.
#pragma once

#include <span>

#include "patch/deviation.hpp"
#include "surfaces/surface_reader.hpp"

namespace surfmesh {

/// Cosines of the angles between triangles and the surface's normals at uv; nan where there is no
/// normal.
Array<double> cosines_with_surface(SurfaceReader& surface, std::span<const SpaceTriangle> corners,
                                   std::span<const Point2> uv);

}  // namespace surfmesh
