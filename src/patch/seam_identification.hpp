// From the parameter plane to space: joined sides are identified.
//
//  ____B____                Sides A and A are one curve in space, nodes on them one point. An
// |         |               edge on a side that is a single point vanishes, and with it its
// A         A               triangle. What must come of it follows from Euler's number; where
// |____B____|               sizes are too coarse an edge has more than two triangles.
//
// In: the triangles of a domain, and which nodes of its boundary are one point in space. Out: the
// points, each with the vertex that it is computed from, triangles between them, and where
// identification has not made a surface. Only topology: no coordinate is read.
#pragma once

#include <cstdint>
#include <span>

#include "insertion/outcome.hpp"
#include "triangulation/triangulation.hpp"

namespace surfmesh {

/// A triangulated domain: three vertices and three twins a triangle, NIL on the border.
struct DomainTriangles {
    std::span<const Vertex> tri;
    std::span<const HalfEdge> adj;
    std::span<const Region> region;  // of the triangles
    Vertex vertices;
};

/// The boundary of a domain, whose nodes coincide in space with the first of their identity.
struct IdentifiedBoundary {
    std::span<const Vertex> node;            // the vertex of each node, NIL where there is none
    std::span<const Segment> segments;       // between nodes
    std::span<const std::int64_t> identity;  // of the nodes
};

struct SurfaceTriangles {
    Array<std::int32_t> triangles;     // three points each
    Array<Vertex> corners;             // of the triangles, in the domain: three vertices each
    Array<std::int64_t> vertex;        // of the domain, that each point is computed from
    Array<std::int64_t> non_manifold;  // points where identification has not made a surface
};

/// Triangles with two corners on one collapsed side are dropped: they are edges in space.
SurfaceTriangles identify_seams(const DomainTriangles& domain, const IdentifiedBoundary& boundary);

}  // namespace surfmesh
