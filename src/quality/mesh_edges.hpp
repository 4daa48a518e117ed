// Edges of a finished mesh: their lengths, and the angles across them.
//
// In: points, triangles and the edge table (space/edge_table.hpp): the ends of each edge, the first
// two half-edges along it, by how many triangles it is used. Nothing changes.
#pragma once

#include <cstdint>
#include <span>

#include "space/box_tree.hpp"
#include "space/edge_table.hpp"
#include "values/array.hpp"

namespace surfmesh {

Array<double> edge_lengths(std::span<const Point3> points, std::span<const EdgeTable::Ends> edges);

/// The sizes at both ends of each edge: their mean, and by how much they are apart.
struct EdgeSizes {
    Array<double> mean, apart;
};
EdgeSizes edge_sizes(std::span<const EdgeTable::Ends> edges, std::span<const double> sizes);

/// The longest and the shortest edge at each vertex, NaN where one is: 0 and infinite without edges.
struct EdgeExtremes {
    Array<double> longest, shortest;
};

EdgeExtremes edge_extremes(std::span<const EdgeTable::Ends> edges, std::span<const double> lengths,
                           std::size_t vertices);

/// Along which edge sizes change most, over what is allowed, and along how many by more than ``most``
/// times that.
struct SizeChanges {
    std::int64_t steepest;  // the first of these edges; NIL where none has a length
    double largest;
    std::int64_t above;
};

/// apart: by how much sizes at the ends of each edge differ; slope: of that over the length, allowed.
/// Where the quotient is not finite there is no change.
SizeChanges size_changes(std::span<const double> apart, std::span<const double> lengths,
                         double slope, double most);

/// The edges between two triangles of one face, the face of each, and the angle there, degrees.
struct AnglesWithinFaces {
    Array<std::int64_t> edges;
    Array<std::int32_t> faces;
    Array<double> degrees;
};

AnglesWithinFaces angles_within_faces(std::span<const Point3> points,
                                      std::span<const TriangleCorners> triangles,
                                      std::span<const std::int32_t> faces,
                                      std::span<const EdgeTable::Sides> half_edges,
                                      std::span<const std::int32_t> uses);

}  // namespace surfmesh
