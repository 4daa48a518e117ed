// A vertex more where triangles are bad and no move, swap or removal betters them.
//
//     o-----------o            o-----------o
//     |`-.  bad .'|            |`-.     .-'|     segments of unlike lengths at a corner: an edge
//     |   `-. .'  |            |   `. .'   |     is split, the star of the new vertex takes over
//     o     .'.   |     ->     o----->o    |     triangles beside it while that is better, and
//     |   .'bad`-.|            |   .' `.   |     the vertex goes to where its star is best
//     | .'       `|            | .'     `. |
//     o-----------o            o-----------o
//
// In: a domain with its frames. Out: the same with two triangles more for each new vertex, whose
// frame the caller sets. Fixed edges, the border and all other vertices stay, every triangle is
// positive, exactly. Triangles are measured in space.
#pragma once

#include "optimisation/stars.hpp"
#include "optimisation/surface_frames.hpp"
#include "optimisation/vertex_marks.hpp"

namespace surfmesh {

/// Add vertices at triangles below the alpha ``least`` where that raises the smallest alpha of all
/// that it changes, and no edge gets below the limit. ``shape``: alpha of the triangles.
///
/// Returns the number of the first new vertex. New vertices, and those around them, become active
/// and dirty; stars must be found anew.
Vertex insert_at_worst(Triangulation& t, SurfaceFrames& s, VertexMarks& marks,
                       const Array<double>& shape, double least);

}  // namespace surfmesh
