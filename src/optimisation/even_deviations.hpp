// Vertices move to where all triangles lie about as far from the surface, and none too far.
//
// In: a domain with its frames and stars. Around vertices with five or seven triangles, edges that
// are alike leave some triangles farther off than others. Smoothing makes edges alike; here each
// vertex takes a Newton step to less of
//
//     E = sum over triangles of 1 / (4 alpha^4) + weight / p (x_e^p + x_c^p)  +  unit edges
//
// with x the distance of the surface from the middle of an edge and from the centre, as
// ``triangle_deviation`` estimates them, over what is allowed. The high power lets the farthest
// count, and they spread what they have too much of over their neighbours. A vertex that has moved
// stays on the quadric through its neighbours until the caller puts it on the surface. Fixed edges
// and the border stay, every triangle stays positive, exactly.
#pragma once

#include "optimisation/stars.hpp"
#include "optimisation/surface_frames.hpp"
#include "optimisation/vertex_marks.hpp"

namespace surfmesh {

/// Move every active vertex by one step; those that moved go to ``moved``.
///
/// allowed: distance from the surface, model units. A move that would turn a triangle over, or make
/// a bad star worse, is not made. Vertices that have moved far, and their neighbours, stay active.
/// In a large domain the parts are done side by side, then the vertices whose stars lie in several.
void even_deviations(Triangulation& t, SurfaceFrames& s, const Stars& stars, VertexMarks& marks,
                     double allowed, Array<Vertex>& moved);

}  // namespace surfmesh
