#include "quality/far_corners.hpp"

#include <algorithm>

#include "quality/by_face.hpp"
#include "space/triangle_corners.hpp"

namespace surfmesh {
namespace {

/// One corner at each place in (u, v) that a triangle uses, in the order of these.
Array<HalfEdge> corners_of_places(const MeasuredMesh& mesh,
                                  std::span<const std::uint8_t> left_out) {
    Array<HalfEdge> corner_of(mesh.uv.size(), NIL);
    const std::span<const Vertex> places = corners_in_a_row(mesh.uv_triangles);
    for (std::size_t e = 0; e < places.size(); ++e)
        if (left_out[e / 3] == 0) corner_of[places[e]] = static_cast<HalfEdge>(e);
    corner_of.resize(static_cast<std::size_t>(std::remove(corner_of.begin(), corner_of.end(), NIL) -
                                              corner_of.begin()));
    return corner_of;
}

}  // namespace

FarCorners far_corners(const MeasuredMesh& mesh, std::span<const std::uint8_t> left_out,
                       double limit) {
    FarCorners found;
    const Array<HalfEdge> corners = corners_of_places(mesh, left_out);
    const std::span<const Vertex> vertices = corners_in_a_row(mesh.triangles),
                                  places = corners_in_a_row(mesh.uv_triangles);
    const ByFace sorted = by_face(corners.size(), mesh.surfaces.size(),
                                  [&](std::size_t k) { return mesh.faces[corners[k] / 3]; });
    Array<Point2> uv;
    SurfaceValues values;
    for (std::size_t face = 0; face < mesh.surfaces.size(); ++face) {
        const auto members = sorted.of(face);
        if (members.empty()) continue;
        uv.clear();
        for (const std::int32_t k : members) uv.push_back(mesh.uv[places[corners[k]]]);
        if (values.evaluate(*mesh.surfaces[face], {uv.data(), uv.size()}, 0) !=
            SurfaceStatus::DONE) {
            found.failed = static_cast<std::int32_t>(face);
            return found;
        }
        for (std::size_t j = 0; j < members.size(); ++j) {
            const HalfEdge corner = corners[members[j]];
            if (norm(values[0][j] - mesh.points[vertices[corner]]) > limit)
                found.half_edges.push_back(corner);
        }
    }
    return found;
}

}  // namespace surfmesh
