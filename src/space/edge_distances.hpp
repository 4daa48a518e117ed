// How far the edges of a face are apart: distances from samples of one to the others.
#pragma once

#include <cstdint>
#include <span>

#include "triangulation/segments.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// Samples along edges, and which edges each face has.
struct SampledEdges {
    std::span<const Point3> points;
    std::span<const double> reach;                // of the samples: farther is not looked at
    std::span<const std::int64_t> first;          // samples of edge e: first[e] to first[e + 1]
    std::span<const SegmentEnds> ends;            // of the edges: vertices
    std::span<const std::int64_t> edges;          // those of each face in one row
    std::span<const std::int64_t> first_of_face;  // where they begin, and how many there are
};

inline bool have_common_vertex(SegmentEnds a, SegmentEnds b) {
    return a.start == b.start || a.start == b.end || a.end == b.start || a.end == b.end;
}

struct EdgeGaps {
    Array<double> gap;  // of the samples, infinite where nothing is in reach
    Array<Box3> boxes;  // of the edges, around their samples
};

/// Distance of each sample from the edges that share a face with its own but no vertex. By threads,
/// edge by edge: the gaps of an edge are lowered in the order of its faces.
EdgeGaps edge_gaps(const SampledEdges& sampled);

/// How far the segments between the samples of each edge lie off its curve, about, at most: an
/// eighth of the largest second difference; first: see there.
Array<double> sags(std::span<const Point3> points, std::span<const std::int64_t> first);

}  // namespace surfmesh
