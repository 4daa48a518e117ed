// Splits of edges that are too long, or lie too far from the surface.
//
// In: a domain with its frames; the arrays of all grow. A new vertex lies in the middle of its
// chord, with what is known of its ends, until the caller puts it on the surface. Fixed edges and
// the border stay, every triangle stays positive, exactly. Stars are stale afterwards.
#pragma once

#include <span>

#include "optimisation/surface_frames.hpp"
#include "optimisation/vertex_marks.hpp"

namespace surfmesh {

/// Put a vertex at ``place``, on or near the interior edge e, and join it to four corners.
///
///         c                      c
///        / \                    /|\          (a, b, c) -> (a, p, c) in its slot, (p, b, c)
///       / e \                  / | \         .
///      a-----b      ->        a--p--b
///       \ f /                  \ | /         (b, a, d) -> (b, p, d) in its slot, (p, a, d)
///        \ /                    \|/
///         d                      d
///
/// Returns the vertex, or NIL when a triangle would not be positive.
Vertex split_edge(Triangulation& t, HalfEdge e, Point2 place);

/// Tell the new vertex p what is known in the middle between a and b; it is active and dirty.
void set_between(Triangulation& t, SurfaceFrames& s, VertexMarks& marks, Vertex p, Vertex a,
                 Vertex b);

/// Split interior edges of active vertices longer than ``longest``.
///
/// In a large domain those of vertices that become active on the way wait for the next call.
/// Returns the first of the new vertices.
Vertex split_long_edges(Triangulation& t, SurfaceFrames& s, VertexMarks& marks, double longest);

/// Split, in each of the triangles, the edge that lies farthest from the surface.
///
/// One edge a triangle and a call: those whose neighbours have been split are passed over.
/// Returns the first of the new vertices.
Vertex split_far_edges(Triangulation& t, SurfaceFrames& s, VertexMarks& marks,
                       std::span<const Triangle> triangles);

}  // namespace surfmesh
