// Faces that are narrower than the chord all along: two sides, and what joins them at the ends.
//
//       a ----------- a ----------- a          sides a and b, nowhere farther apart than the narrow
//       |  start                    |  end     width; an end is a short chain of edges, or a tip in
//       b ----------- b ----------- b          which the sides meet
//
// In: the loops of faces with sampled edges, and up to which width each face is narrow. Out: the
// sides and ends of those that are. Ways to take a loop apart are tried, the longest ends first.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "edges/edge_chains.hpp"
#include "edges/edge_courses.hpp"

namespace surfmesh {

/// Coedges of a face that follow each other, from place ``start`` round its row of coedges.
struct CoedgeRun {
    std::int64_t start = 0, count = 0;
};

/// The second side comes back; ends go from the first side to the second, and back.
struct NarrowFace {
    std::array<CoedgeRun, 2> sides, ends;
    bool is_closed = false;  // each side is a loop
    double width = 0.0;      // the largest way across; below 0 where the face is not narrow
};

/// The coedges of a model, face after face and loop after loop, in walking order.
struct FaceLoops {
    std::span<const std::int64_t> first_of_face, first_of_loop;
    std::span<const std::int64_t> edge;
    std::span<const std::uint8_t> is_reversed;
    std::span<const double> length;  // of the edges, 0 of those that are a point
    std::span<const double> area;    // of the faces
    double diagonal;                 // of the model
};

/// Faces to be looked at.
struct NarrowRequest {
    std::span<const std::int64_t> faces;
    std::span<const double> width;   // up to which they are narrow
    const CurvePieces& pcurves;      // of all coedges
    const SharedSurfaces& surfaces;  // of ``faces``
};

/// The longest ways across a narrow face, and ends, in narrow widths: round a tube.
inline constexpr double ROUND_A_TUBE = 1.1 * 3.141592653589793;

/// One entry for each of the faces asked for.
std::vector<NarrowFace> narrow_faces(const SampledCurves& edges, const FaceLoops& loops,
                                     const NarrowRequest& asked);

}  // namespace surfmesh
