// Triangles that lie too far from the surface: their corners move until those around are near.
//
// In: a domain with its frames and stars. Smoothing makes edges alike and triangles equilateral; how
// far they lie from the surface follows from that on the average only, and some triangles are larger
// than others. Here the farthest triangle of a star counts, and its worst shape. Fixed edges and
// the border stay, every triangle stays positive, exactly; the caller puts what has moved back on
// the surface.
#pragma once

#include <span>

#include "optimisation/stars.hpp"
#include "optimisation/surface_frames.hpp"
#include "optimisation/vertex_marks.hpp"

namespace surfmesh {

/// What a triangle may be like, by the estimate from its corners.
struct StarBounds {
    double farthest;  // distance from the surface, model units
    double least;     // alpha
};

/// The squares of what a triangle exceeds the bounds by; infinite where it is turned over.
[[nodiscard]] double excess_of(const SurfaceFrames& s, Vertex a, Vertex b, Vertex c,
                               StarBounds bounds);

/// Move the free corners of ``triangles`` while that brings their stars nearer to ``bounds``.
///
/// Those that moved go to ``moved``. A search by steps in the unit tangent plane, as for the worst
/// shapes; the surface around a vertex is the quadric through its neighbours on the average.
void bring_nearer(Triangulation& t, SurfaceFrames& s, const Stars& stars, VertexMarks& marks,
                  std::span<const Triangle> triangles, StarBounds bounds, Array<Vertex>& moved);

}  // namespace surfmesh
