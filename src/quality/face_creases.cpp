#include "quality/face_creases.hpp"

#include <algorithm>
#include <limits>

#include "patch/creases.hpp"
#include "quality/by_face.hpp"

namespace surfmesh {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

struct Box {
    Point3 low{INFINITE, INFINITE, INFINITE}, high{-INFINITE, -INFINITE, -INFINITE};

    void add(Point3 p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
};

Vertex corner_of(const TriangleCorners& t, std::size_t k) {
    return k == 0 ? t.a : k == 1 ? t.b : t.c;
}

/// The boxes around the triangles of those faces that have edges.
Array<Box> boxes_of(const MeasuredMesh& mesh, const ByFace& edges) {
    Array<Box> boxes(mesh.surfaces.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::int32_t face = mesh.faces[t];
        if (edges.of(face).empty()) continue;
        const TriangleCorners& corners = mesh.triangles[t];
        for (const Vertex v : {corners.a, corners.b, corners.c}) boxes[face].add(mesh.points[v]);
    }
    return boxes;
}

/// The parameters of a triangle from the start of a half-edge on.
ParameterTriangle from_half_edge(const MeasuredMesh& mesh, HalfEdge e) {
    const TriangleCorners& t = mesh.uv_triangles[e / 3];
    ParameterTriangle found;
    for (std::size_t k = 0; k < 3; ++k) found[k] = mesh.uv[corner_of(t, (e % 3 + k) % 3)];
    return found;
}

Vertex start_of(const MeasuredMesh& mesh, HalfEdge e) {
    return corner_of(mesh.triangles[e / 3], e % 3);
}

}  // namespace

FaceCreases face_creases(const MeasuredMesh& mesh, std::span<const HalfEdgePair> edges,
                         std::span<const double> angle) {
    FaceCreases found{Array<std::uint8_t>(edges.size(), 0)};
    const ByFace sorted = by_face(edges.size(), mesh.surfaces.size(),
                                  [&](std::size_t k) { return mesh.faces[edges[k].first / 3]; });
    const Array<Box> boxes = boxes_of(mesh, sorted);
    Array<CornersBesideEdge> beside;
    Array<std::uint8_t> alike;
    for (std::size_t face = 0; face < mesh.surfaces.size(); ++face) {
        const std::span<const std::int32_t> members = sorted.of(face);
        if (members.empty()) continue;
        beside.clear();
        alike.clear();
        for (const std::int32_t k : members) {
            const auto [e, f] = edges[k];
            beside.push_back({from_half_edge(mesh, e), from_half_edge(mesh, f)});
            alike.push_back(start_of(mesh, e) == start_of(mesh, f) ? 1 : 0);
        }
        SurfaceReader surface(*mesh.surfaces[face]);
        const Array<std::uint8_t> bent =
            on_crease(surface, {beside.data(), beside.size()}, {alike.data(), alike.size()},
                      angle[face], norm(boxes[face].high - boxes[face].low));
        if (surface.failed()) {
            found.failed = static_cast<std::int32_t>(face);
            return found;
        }
        for (std::size_t j = 0; j < members.size(); ++j) found.bent[members[j]] = bent[j];
    }
    return found;
}

}  // namespace surfmesh
