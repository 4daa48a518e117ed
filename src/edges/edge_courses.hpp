// Points, tangents and curvature along edges, and the curvature of the surfaces that they lie on.
//
// In: pieces of curves with places on them (curve_pieces.hpp). Out: an entry for each place. Of a
// straight piece only the points are asked for; its tangent is that from end to end.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "edges/curve_pieces.hpp"
#include "surfaces/surface.hpp"

namespace surfmesh {

struct EdgeCourses {
    Array<Point3> points, tangents;  // of the places; tangents are unit vectors
    Array<double> curvature;         // of the places; 0 where it is straight or not known
    Array<double> total_curvature;   // of the pieces: its integral, radians
};

/// straight: of each piece in places.which.
EdgeCourses edge_courses(const CurvePieces& pieces, const PiecePlaces& places,
                         std::span<const std::uint8_t> straight);

using SharedSurfaces = std::vector<std::shared_ptr<const Surface>>;

struct SurfaceCurvatures {
    Array<double> k1, k2;            // principal curvatures at the places, 1 / length
    Array<std::uint8_t> degenerate;  // where they are not known
    std::int64_t refused = -1;       // a surface without second derivatives, by its row
};

/// Principal curvatures of surfaces at places on coedges; surfaces: of each piece in places.which.
SurfaceCurvatures curvatures_along(const CurvePieces& coedges, const PiecePlaces& places,
                                   const SharedSurfaces& surfaces);

/// The same at parameters (u, v): those of surface i from first[i] to first[i + 1].
SurfaceCurvatures curvatures_at(std::span<const Point2> uv, std::span<const std::int64_t> first,
                                const SharedSurfaces& surfaces);

}  // namespace surfmesh
