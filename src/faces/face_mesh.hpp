// One face of a CAD model: its boundary in, its triangles out.
//
// nodes of its edges -> (u, v) loops -> size field -> packing, boundary, optimisation
// (numbers, points)     seams twice     graded inward from the sizes of the edges
//
// The size field of a plane or a cylinder is grown here from its edges (mesh_inward); that of any
// other surface is given (mesh_face). What is out of the ordinary is a status: Python, which knows
// the exceptional ways and the words, goes on from there. Nothing that comes in is changed.
#pragma once

#include <memory>
#include <optional>

#include "faces/face_boundary.hpp"
#include "insertion/coincident_nodes.hpp"
#include "patch/patch_mesh.hpp"

namespace surfmesh {

enum class [[nodiscard]] FaceEnd : std::uint8_t {
    done,
    unprepared,    // no box, no positive sizes, or more cells than are allowed
    tubes,         // it may have thin tubes, which are meshed by themselves
    runs_twice,    // a segment runs twice the same way
    patch_failed,  // see ``patch``
    not_joined,    // its sides, at the non-manifold points of ``patch``
};

/// What sizes inside ask for along the edges, which know their surroundings only.
struct CoarseSegments {
    Array<Point3> points;
    Array<double> sizes;
    Array<Point3> along;  // unit directions of the segments there
};

struct FaceMesh {
    FaceEnd end = FaceEnd::done;
    PatchMesh patch;
    Array<std::int64_t> slots;  // of the points: their row in the boundary, -1 inside
    CoarseSegments coarse;      // of a first round
    Array<Point2> uv;           // of the nodes of the loops
    Array<Segment> segments;    // between these
};

/// How a face is meshed, whatever its sizes.
struct FaceManner {
    AskedAccuracy asked;
    bool optimise = true;
    bool first = true;            // the sizes come from no earlier round
    bool is_anisotropic = false;  // sizes are asked for that depend on the direction
    bool on_lattice = false;      // sizes are for a lattice laid along principal directions
};

/// A surface over the box of the face, its chart and size field.
struct FaceField {
    const Surface& surface;
    const Chart& chart;
    const Background& background;
};

[[nodiscard]] FaceMesh mesh_face(const FaceField& field, const FacePolygons& polygons,
                                 const FaceManner& manner, const PatchHooks& hooks);

/// How sizes grow from edges on a surface whose speeds are constant.
struct InwardGrowth {
    Point2 speeds;   // |r_u|, |r_v|
    double largest;  // no size is larger
    double slope;    // of the size, per length
};

/// A plane or a cylinder, of whose boundary no coedge is degenerate.
struct InwardFace {
    std::shared_ptr<const Surface> surface;
    std::shared_ptr<const FaceBoundary> boundary;
    InwardGrowth growth;
    FaceManner manner;
    bool look_for_tubes;  // thin tubes are not cut off it yet
};

[[nodiscard]] FaceMesh mesh_inward(const InwardFace& face, const PatchHooks& hooks);

/// What the sizes of the same field ask for within the loops: see area_within_loops.hpp. No number
/// where it cannot be made.
[[nodiscard]] double metric_area_inward(const InwardFace& face);

/// Loops whose segments may be far longer than the sizes beside them.
struct SegmentsInSpace {
    std::span<const Point2> uv;
    std::span<const Point3> points;
    std::span<const Segment> segments;
};

/// Segments more than twice as long as the sizes inside allow; nothing where there are none.
[[nodiscard]] CoarseSegments coarse_segments(const FaceField& field, const SegmentsInSpace& loops,
                                             double min_size, bool is_anisotropic);

/// The same of loops that are not meshed; nothing where a segment runs twice.
[[nodiscard]] CoarseSegments coarse_segments(const FaceField& field, const FacePolygons& polygons,
                                             double min_size, bool is_anisotropic);

}  // namespace surfmesh
