#include "faces/face_mesh.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "faces/surface_over_box.hpp"
#include "fields/area_within_loops.hpp"
#include "fields/coverage.hpp"
#include "surfaces/chart_making.hpp"

namespace surfmesh {
namespace {

/// The plane of a surface whose speeds are the same everywhere.
Chart uniform_chart(const PlaneBox& box, Point2 speeds) {
    return {linear_axis(box.low.x, box.high.x, speeds.x),
            linear_axis(box.low.y, box.high.y, speeds.y)};
}

bool is_box(const PlaneBox& box) {
    return std::isfinite(box.low.x) && std::isfinite(box.low.y) && std::isfinite(box.high.x) &&
           std::isfinite(box.high.y) && box.low.x < box.high.x && box.low.y < box.high.y;
}

/// Sizes that grow from the nodes of the edges. Places are in the scaled plane.
GrownTree grown_inward(const FaceBoundary& b, const PlaneBox& box, const InwardGrowth& growth,
                       Point2 extent, Fineness fineness) {
    Array<Point2> place;
    place.reserve(b.uv.size());
    for (const Point2 uv : b.uv) {
        const Point2 p = uv - box.low;
        place.push_back({p.x * growth.speeds.x, p.y * growth.speeds.y});
    }
    const Sources sources{place, b.sizes, 1.0, 0.0, 1.0, growth.slope, growth.largest};
    return grow_sizes(sources, {{0.0, 0.0}, extent}, fineness);
}

bool are_sizes(const FaceBoundary& b) {
    for (const double size : b.sizes)
        if (!(size > 0.0)) return false;
    return true;
}

/// A face whose sizes are known inside.
struct InwardField {
    PlaneBox box;
    Chart chart;
    Background background;
};

/// Nothing where there is no box, no positive sizes, or more cells than are allowed.
std::optional<InwardField> field_inward(const InwardFace& face, Fineness fineness) {
    const FaceBoundary& boundary = *face.boundary;
    const PlaneBox box = boundary.box();
    if (!is_box(box) || !are_sizes(boundary)) return {};
    Chart chart = uniform_chart(box, face.growth.speeds);
    GrownTree grown = grown_inward(boundary, box, face.growth, chart.extent(), fineness);
    if (grown.status != TreeStatus::grown) return {};
    return InwardField{box, std::move(chart), std::move(grown.background)};
}

/// Of the points: the rows of their nodes in the boundary.
Array<std::int64_t> slots_of_points(const PatchMesh& patch, std::span<const std::int64_t> slots) {
    Array<std::int64_t> of_vertex(patch.domain.t.xy.size(), -1);
    for (std::size_t k = 0; k < slots.size(); ++k)
        if (patch.domain.node[k] != NIL) of_vertex[patch.domain.node[k]] = slots[k];
    Array<std::int64_t> found;
    found.reserve(patch.mapped.seamless.vertex.size());
    for (const std::int64_t v : patch.mapped.seamless.vertex) found.push_back(of_vertex[v]);
    return found;
}

/// The loops of a face, what is one node being one.
struct FaceLoops {
    LoopNodes nodes;
    Array<Point2> uv;
    Array<Point3> points;
    Array<std::int64_t> slots;

    [[nodiscard]] SegmentsInSpace in_space() const { return {uv, points, nodes.segments}; }
};

FaceLoops loops_of(const FacePolygons& polygons) {
    FaceLoops found;
    found.nodes = loop_nodes(polygons.uv, polygons.numbers, polygons.lengths);
    for (const std::int32_t k : found.nodes.nodes) {
        found.uv.push_back(polygons.uv[k]);
        found.points.push_back(polygons.points[k]);
        found.slots.push_back(polygons.slots[k]);
    }
    return found;
}

}  // namespace

FaceMesh mesh_face(const FaceField& field, const FacePolygons& polygons, const FaceManner& manner,
                   const PatchHooks& hooks) {
    const FaceLoops loops = loops_of(polygons);
    const SegmentsInSpace in_space = loops.in_space();
    FaceMesh made;
    made.uv = loops.uv;
    made.segments = loops.nodes.segments;
    if (loops.nodes.runs_twice) {
        made.end = FaceEnd::runs_twice;
        return made;
    }
    const Array<Point2> xy = field.chart.to_plane(in_space.uv);
    const Point2 extent = field.chart.extent();
    const PatchTask task{field.surface,
                         field.chart,
                         field.background,
                         manner.asked,
                         {0.0, 0.0},
                         extent,
                         expected_circles(field.background, extent),
                         manner.optimise,
                         manner.first,
                         manner.is_anisotropic,
                         manner.on_lattice};
    const Array<std::int64_t>& identity = loops.nodes.identity;
    const LoopBoundary boundary{xy, in_space.segments, {}, identity, in_space.points};
    made.patch = mesh_patch(task, in_space.uv, boundary, hooks);
    if (made.patch.end != PatchEnd::done) {
        made.end = FaceEnd::patch_failed;
        return made;
    }
    made.slots = slots_of_points(made.patch, loops.slots);
    if (!made.patch.mapped.seamless.non_manifold.empty())
        made.end = FaceEnd::not_joined;
    else if (manner.first)
        made.coarse =
            coarse_segments(field, in_space, manner.asked.min_size, manner.is_anisotropic);
    return made;
}

CoarseSegments coarse_segments(const FaceField& field, const FacePolygons& polygons,
                               double min_size, bool is_anisotropic) {
    const FaceLoops loops = loops_of(polygons);
    if (loops.nodes.runs_twice) return {};
    return coarse_segments(field, loops.in_space(), min_size, is_anisotropic);
}

FaceMesh mesh_inward(const InwardFace& face, const PatchHooks& hooks) {
    const FaceBoundary& boundary = *face.boundary;
    const auto ended = [](FaceEnd end) {
        FaceMesh made;
        made.end = end;
        return made;
    };
    if (face.look_for_tubes && may_have_tubes(*face.surface, boundary))
        return ended(FaceEnd::tubes);
    const std::optional<InwardField> field = field_inward(face, Fineness::for_mesh);
    if (!field) return ended(FaceEnd::unprepared);
    const SurfaceOverBox over(*face.surface, {field->box.low, field->box.high});
    return mesh_face({over, field->chart, field->background}, polygons_of(boundary), face.manner,
                     hooks);
}

double metric_area_inward(const InwardFace& face) {
    const std::optional<InwardField> field = field_inward(face, Fineness::for_estimate);
    if (!field) return std::numeric_limits<double>::quiet_NaN();
    const FacePolygons polygons = polygons_of(*face.boundary);
    const Array<Point2> xy = field->chart.to_plane(polygons.uv);
    Array<std::int64_t> first(1, 0);
    for (const std::int32_t length : polygons.lengths) first.push_back(first.back() + length);
    return metric_area_within(field->background, {xy, first}, Between::sizes);
}

}  // namespace surfmesh
