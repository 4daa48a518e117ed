// Smaller wanted sizes where triangles lie too far from the surface, or at given vertices.
#pragma once

#include <span>

#include "optimisation/surface_frames.hpp"
#include "optimisation/vertex_marks.hpp"

namespace surfmesh {

/// What is not near enough with so small a scale of its sizes needs another field.
inline constexpr double SMALLEST_SCALE = 0.6;

/// Ask for smaller edges where the ``deviation`` of ``triangles`` exceeds ``limit``.
///
/// The sizes of their corners are scaled by what deviation, of second order in the size, needs;
/// they become active. No scale comes below ``smallest``. Returns the number of such triangles.
int shrink_far(const Triangulation& t, SurfaceFrames& s, VertexMarks& marks,
               std::span<const Triangle> triangles, std::span<const double> deviation, double limit,
               double smallest = SMALLEST_SCALE);

/// Scale the wanted lengths at ``vertices`` by ``factors``, down to ``smallest`` of what they were.
///
/// They become active. Returns how many were scaled.
int lower_sizes(SurfaceFrames& s, VertexMarks& marks, std::span<const Vertex> vertices,
                std::span<const double> factors, double smallest);

}  // namespace surfmesh
