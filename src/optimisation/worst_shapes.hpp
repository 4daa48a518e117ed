// The few worst triangles: their corners move until all triangles around them are good enough.
//
// In: a domain with its frames and stars. The energy of smoothing adds up what is good and bad in a
// star; here only the worst triangle counts, whatever the lengths of edges. Fixed edges and the
// border stay, every triangle stays positive, exactly; the caller puts what has moved back on the
// surface.
#pragma once

#include "optimisation/stars.hpp"
#include "optimisation/surface_frames.hpp"
#include "optimisation/vertex_marks.hpp"

namespace surfmesh {

/// Move the free corners of triangles with alpha below ``least``; those that moved go to ``moved``.
///
/// In a large domain triangles that get below it on the way wait for the next call.
/// A search by steps in the unit tangent plane: eight ways at each radius, the best is taken. It
/// ends where all triangles of the star have ``least``: the others lose no more than they must.
void raise_worst(Triangulation& t, SurfaceFrames& s, const Stars& stars, VertexMarks& marks,
                 double least, Array<Vertex>& moved);

}  // namespace surfmesh
