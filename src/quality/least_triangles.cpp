#include "quality/least_triangles.hpp"

#include <algorithm>
#include <array>

#include "quality/by_face.hpp"
#include "quality/face_rims.hpp"
#include "sizing/least_counts.hpp"
#include "surfaces/surface_reader.hpp"

namespace surfmesh {
namespace {

// Triangles that are looked at: their sum is known to a few thousandths from so many, as the least
// changes slowly. Of each face at least so many, or all.
constexpr std::size_t LOOKED_AT = 8'192, OF_EACH_FACE = 256;

constexpr std::size_t TOGETHER = 1024;  // places that a surface is asked for at once

/// The triangles of a face that are looked at: each so many.
std::size_t step_over(std::size_t own, std::size_t all) {
    return std::max<std::size_t>(std::min(own / OF_EACH_FACE, all / LOOKED_AT), 1);
}

Point2 middle_of(const MeasuredMesh& mesh, std::int32_t triangle) {
    const TriangleCorners& t = mesh.uv_triangles[triangle];
    return (1.0 / 3.0) * (mesh.uv[t.a] + mesh.uv[t.b] + mesh.uv[t.c]);
}

LeastDensity density_at(const SurfaceReader& r, std::size_t k, double chord, bool balanced) {
    const FundamentalForms forms = fundamental_forms(r[1][k], r[2][k], {r[3][k], r[4][k], r[5][k]});
    return least_density(principal_curvatures(forms), chord, balanced);
}

/// What the area of a face needs; nothing where its surface fails.
LeastDensity over_area(const MeasuredMesh& mesh, std::span<const double> area,
                       std::span<const std::int32_t> triangles, SurfaceReader& surface,
                       double chord, bool balanced) {
    const std::size_t step = step_over(triangles.size(), mesh.triangles.size());
    Array<std::int32_t> some;
    double whole = 0.0, seen = 0.0;
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        whole += area[triangles[k]];
        if (k % step == 0) some.push_back(triangles[k]);
    }
    LeastDensity sum{0.0, 0.0};
    Array<Point2> middles;
    for (std::size_t from = 0; from < some.size(); from += TOGETHER) {
        const std::size_t count = std::min(TOGETHER, some.size() - from);
        middles.clear();
        for (std::size_t k = 0; k < count; ++k) middles.push_back(middle_of(mesh, some[from + k]));
        surface.read({middles.data(), count}, 2);
        for (std::size_t k = 0; k < count; ++k) {
            const double weight = area[some[from + k]];
            const LeastDensity density = density_at(surface, k, chord, balanced);
            seen += weight;
            sum.least += weight * density.least;
            sum.equilateral += weight * density.equilateral;
        }
    }
    const double times = seen > 0.0 ? whole / seen : 0.0;
    return {times * sum.least, times * sum.equilateral};
}

/// Where a half-edge starts, and where the next one of its triangle does.
std::array<Vertex, 2> ends_of(const MeasuredMesh& mesh, std::int32_t half_edge) {
    const TriangleCorners& t = mesh.triangles[half_edge / 3];
    const std::int32_t k = half_edge % 3;
    return {k == 0 ? t.a : k == 1 ? t.b : t.c, k == 0 ? t.b : k == 1 ? t.c : t.a};
}

/// The segments around all faces; between two faces once for each.
Array<RimSegment> rim_segments(const MeasuredMesh& mesh, std::span<const EdgeSides> edges,
                               std::span<const double> chord) {
    Array<RimSegment> segments;
    for (const EdgeSides& edge : edges) {
        const std::int32_t h = edge.half_edge, face = mesh.faces[h / 3];
        const std::int32_t beyond = edge.twin == NIL ? NIL : mesh.faces[edge.twin / 3];
        if (beyond == face) continue;
        const double allowed = beyond == NIL ? chord[face] : std::min(chord[face], chord[beyond]);
        segments.push_back({ends_of(mesh, h), face, allowed});
        if (beyond != NIL) segments.push_back({ends_of(mesh, h), beyond, allowed});
    }
    return segments;
}

/// Vertices of each face.
Array<std::int32_t> vertices_by_face(const MeasuredMesh& mesh, const ByFace& triangles) {
    Array<std::int32_t> count(mesh.surfaces.size(), 0), last(mesh.points.size(), NIL);
    for (std::size_t face = 0; face < mesh.surfaces.size(); ++face)
        for (const std::int32_t t : triangles.of(face)) {
            const TriangleCorners& corners = mesh.triangles[t];
            for (const Vertex v : {corners.a, corners.b, corners.c}) {
                if (last[v] == static_cast<std::int32_t>(face)) continue;
                last[v] = static_cast<std::int32_t>(face);
                ++count[face];
            }
        }
    return count;
}

}  // namespace

LeastTriangles least_triangles(const MeasuredMesh& mesh, std::span<const EdgeSides> edges,
                               std::span<const double> area, const LeastRequest& request) {
    const std::size_t faces = mesh.surfaces.size();
    LeastTriangles found{Array<double>(faces), Array<double>(faces)};
    const ByFace triangles =
        by_face(mesh.triangles.size(), faces, [&](std::size_t t) { return mesh.faces[t]; });
    const Array<RimSegment> segments = rim_segments(mesh, edges, request.chord);
    const ByFace around =
        by_face(segments.size(), faces, [&](std::size_t s) { return segments[s].face; });
    const Array<std::int32_t> vertices = vertices_by_face(mesh, triangles);
    FaceRims rims(mesh.points, request.is_corner, {segments.data(), segments.size()});
    for (std::size_t face = 0; face < faces; ++face) {
        const auto own = triangles.of(face);
        if (own.empty()) continue;
        SurfaceReader surface(*mesh.surfaces[face]);
        const LeastDensity needed =
            over_area(mesh, area, own, surface, request.chord[face], request.balanced);
        if (surface.failed()) {
            found.failed = static_cast<std::int32_t>(face);
            return found;
        }
        double lines = 0.0;
        rims.for_each_line(around.of(face), [&](const RimLine& line) {
            lines += least_segments({line.points.data(), line.points.size()}, line.closed,
                                    line.chord, request.balanced);
        });
        const auto bounded = static_cast<double>(around.of(face).size() + own.size());
        const double by_rims = lines + bounded - 2.0 * vertices[face];  // n - 2 x
        found.least[face] = std::max(needed.least, by_rims);
        found.equilateral[face] = std::max(needed.equilateral, by_rims);
    }
    return found;
}

}  // namespace surfmesh
