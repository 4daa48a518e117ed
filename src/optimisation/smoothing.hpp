// Smoothing: each vertex goes to where its star has good shapes and unit edges.
//
// In: a domain with its frames and stars. A vertex moves by one Newton step in its unit tangent
// plane, in the parameter plane and in space alike, and keeps its frame: the caller puts it back on
// the surface where it has drifted far. Fixed edges and the border stay, every triangle stays
// positive, exactly.
#pragma once

#include "optimisation/stars.hpp"
#include "optimisation/surface_frames.hpp"
#include "optimisation/vertex_marks.hpp"

namespace surfmesh {

/// A vertex that moves less, in unit lengths, leaves its neighbours alone.
inline constexpr double STILL = 0.03, STILL_STRETCHED = 0.02;

/// A step in the unit tangent plane, and the smallest alpha of the star before it.
struct NewtonStep {
    Point2 step;
    double worst;
};

/// The step of v, in its unit tangent plane, that lowers the energy of its star from ``start``.
///
/// E = sum over triangles of (1 / alpha)^2 / 2 + stiffness * sum over edges of (l - 1)^2: the
/// first term is a barrier against bad shape, the second asks for unit edges. One Newton step
/// with the exact gradient and a positive definite Hessian. No step, and a worst alpha of -1,
/// where a triangle is turned over.
NewtonStep newton_step(const Triangulation& t, const SurfaceFrames& s, Vertex v, HalfEdge start,
                       double stiffness);

/// Move every active vertex by one Newton step; the vertices that moved go to ``moved``.
///
/// A move that would turn a triangle over, or make a bad star worse, is not made. Vertices that
/// have moved by more than ``still``, and their neighbours, stay active. In a large domain the parts are done
/// side by side, then the vertices whose stars lie in several.
void smooth(Triangulation& t, SurfaceFrames& s, const Stars& stars, VertexMarks& marks,
            double stiffness, double still, Array<Vertex>& moved);

}  // namespace surfmesh
