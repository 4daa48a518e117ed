// Swaps of edges: for the shape of triangles, and for the degrees of vertices.
//
// In: a domain with its frames. What is better is measured in space; a swap is made only where it
// keeps both triangles positive in the plane, exactly, and where the new edge is short in the
// plane as it is in space. Fixed edges and the border stay. Vertices of swapped edges become
// active and dirty, and their stars are found anew. In a large domain the parts are done side by
// side, then what is in several.
#pragma once

#include <span>

#include "optimisation/closer_stars.hpp"
#include "optimisation/stars.hpp"
#include "optimisation/surface_frames.hpp"
#include "optimisation/vertex_marks.hpp"

namespace surfmesh {

struct SwapsMade {
    int count;
    bool stars_known;  // are the stars up to date? Not where two borders meet in a vertex
};

/// Swap edges while that raises the smaller alpha of the pair.
///
/// stars: null where they are stale.
/// ``shape`` keeps alpha of the triangles from call to call; only triangles with a dirty corner
/// are measured again and looked at, and of these only those below ``good``, in at most
/// ``sweeps`` sweeps. No vertex is dirty afterwards.
SwapsMade swap_for_shape(Triangulation& t, const SurfaceFrames& s, Array<double>& shape,
                         Stars* stars, VertexMarks& marks, double good, int sweeps);

/// Swap edges that bring the degrees of their four vertices nearer to six.
///
/// A 7-7 edge between two 5s is the whole of a pair of dislocations: swapping it leaves four
/// regular vertices, and the smoothing that follows a regular patch. Only where the new
/// triangles are better than ``least``.
SwapsMade swap_for_degree(Triangulation& t, const SurfaceFrames& s, Stars& stars,
                          VertexMarks& marks, double least);

/// The same at triangles of alpha below ``bad``, as ``shape`` has it, on borders that are straight,
/// where vertices of three triangles are regular.
///
///     ---c-----a---      the border: c has 2 triangles, a has 4; d inside has 5, b has 6
///         \   /|\        a-b becomes c-d:
///          \ / | \       c and a have 3, d has 6, b has 5
///           b--d
SwapsMade swap_at_border(Triangulation& t, const SurfaceFrames& s, Stars& stars, VertexMarks& marks,
                         const Array<double>& shape, double bad, double least);

/// Swap edges of ``triangles`` while that brings the pair nearer to ``bounds``.
SwapsMade swap_nearer(Triangulation& t, const SurfaceFrames& s, Stars& stars, VertexMarks& marks,
                      std::span<const Triangle> triangles, StarBounds bounds);

}  // namespace surfmesh
