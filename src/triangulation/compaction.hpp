// From the triangulation of the plane to that of a domain: what is INSIDE, numbered anew.
#pragma once

#include "triangulation/triangulation.hpp"

namespace surfmesh {

struct DomainTriangulation {
    Triangulation t;              // half-edges on its border have no twin (NIL)
    Array<Vertex> vertex_number;  // of the old vertices, NIL where no triangle inside uses one
};

/// The triangles inside and their vertices, in the order they have. There are segments.
///
/// A large domain is numbered along a space-filling curve, its triangles by their first vertices,
/// and cut into parts.
DomainTriangulation cut_inside(const Triangulation& t);

}  // namespace surfmesh
