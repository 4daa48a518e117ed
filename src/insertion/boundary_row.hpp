// The row of vertices along a boundary, where equilateral triangles over its segments have them.
//
//       o     o     o     <- apexes; at a corner two of them become one
//      / \   / \   / \        .
//     a --- b --- c --- d    segments, the inside on their left
//
// In: a packing as a triangulation of the plane, and segments of the boundary to be inserted. Out:
// the packing with that row in it. The packing knows nothing of the boundary, and what is left
// between the two is irregular. With this row the misfit lies one row inside, where vertices can
// move to share it.
#pragma once

#include <span>

#include "fields/background.hpp"
#include "insertion/segment_recovery.hpp"
#include "triangulation/triangulation.hpp"

namespace surfmesh {

// In metric lengths: how far apart the vertices of the row are, how near to them others are
// removed, and how low the row's triangles may be where segments are long.
inline constexpr double APART = 0.65, AROUND = 0.6, LOWEST = 0.7;

/// Apexes of isosceles triangles with unit legs on the left of segments between nodes.
///
/// Two nodes at one place have none.
Array<Point2> apexes(const Background& background, std::span<const Point2> nodes,
                     std::span<const Segment> segments);

/// Insert the apexes with their size tensors and clear the packing around them.
///
/// Apexes too near to an earlier one are joined to it; vertices of the packing that are too near
/// are removed. Returns the number of the first new vertex.
Vertex insert_row(Triangulation& t, std::span<const Point2> apex, std::span<const SizeTensor> size);

}  // namespace surfmesh
