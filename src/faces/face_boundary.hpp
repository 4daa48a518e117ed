// The boundary of a face of a CAD model, cut into nodes: coedge after coedge, loop after loop.
//
//     loop 0: | coedge 0: n n n n | coedge 1: n n n | ...      each with both its ends, so that
//     loop 1: | coedge k: ...                                  ends stand twice, in (u, v) too
//
// The place of a node in these rows is its slot. A degenerate coedge is one point in space: it has
// two nodes of the same number, and is cut when the metric is known.
#pragma once

#include <cstdint>
#include <span>

#include "fields/grown_sizes.hpp"
#include "surfaces/surface.hpp"
#include "values/array.hpp"

namespace surfmesh {

enum class BoundaryFault : std::uint8_t {
    none,
    rows,    // arrays of different lengths
    pieces,  // ends of coedges that do not rise to the number of nodes by two each at least
    loops,   // ends of loops that do not rise to the number of coedges
};

struct FaceBoundary {
    Array<Point2> uv;
    Array<std::int64_t> numbers;     // in the whole mesh
    Array<Point3> points;            // in space, on the edge's curve
    Array<double> sizes;             // wanted lengths; infinite on degenerate coedges
    Array<std::int32_t> piece_end;   // of the coedges: the row after their last node
    Array<std::uint8_t> degenerate;  // of the coedges
    Array<double> tolerance;         // of the coedges: so near is the edge to its images
    Array<std::int32_t> loop_end;    // of the loops: the coedge after their last one

    [[nodiscard]] BoundaryFault check() const;
    [[nodiscard]] std::int32_t pieces() const {
        return static_cast<std::int32_t>(piece_end.size());
    }
    [[nodiscard]] std::int32_t begin_of(std::int32_t piece) const {
        return piece == 0 ? 0 : piece_end[piece - 1];
    }
    [[nodiscard]] bool has_degenerate() const;
    /// Of all nodes in (u, v); without width and height where there are none.
    [[nodiscard]] PlaneBox box() const;
};

/// Loops as closed polygons: each coedge without its last node.
struct FacePolygons {
    Array<Point2> uv;
    Array<std::int64_t> numbers;
    Array<Point3> points;
    Array<std::int64_t> slots;
    Array<std::int32_t> lengths;  // nodes of each loop
};

/// Those of a boundary without degenerate coedges.
[[nodiscard]] FacePolygons polygons_of(const FaceBoundary& boundary);

/// May thin tubes be cut off the face: is there a pole, or a seam near to itself all round?
///
/// A cheap look; where it says so, thin_tubes.py looks closely.
[[nodiscard]] bool may_have_tubes(const Surface& surface, const FaceBoundary& boundary);

/// Width, depth and height of the bounding box in space of a surface that is straight along v, from
/// a coarse grid; nan where the surface failed.
[[nodiscard]] Point3 extent_over(const Surface& surface, const ParameterBox& box);

inline constexpr double FEWEST_STEPS = 2.5;  // round a tube: with less it is thin
inline constexpr double APART = 1e-3;        // of the box: images of an edge nearer are no two
inline constexpr int WAY_SAMPLES = 33;       // of the way round

}  // namespace surfmesh
