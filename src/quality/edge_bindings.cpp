#include <nanobind/stl/optional.h>

#include <algorithm>
#include <array>
#include <optional>

#include "binding/arrays.hpp"
#include "binding/released.hpp"
#include "quality/mesh_arguments.hpp"
#include "quality/rim_losses.hpp"
#include "quality/sound_mesh.hpp"
#include "quality/triangle_fans.hpp"

namespace surfmesh::binding {

namespace {

using VertexTriples = Matrix<std::int32_t, 3>;
using SidePairs = Matrix<std::int32_t, 2>;

std::span<const Vertex> all_numbers(const VertexTriples& triangles) {
    return {triangles.data(), triangles.size()};
}

void bind_sagittas(nb::module_& m) {
    m.def(
        "edge_sagittas",
        [](const Points3& points, const SidePairs& segments, const Numbers& edges) {
            require_indices(std::span(segments.data(), segments.size()), points.shape(0),
                            "segments");
            require_rows(edges.shape(0), segments.shape(0), "edges");
            const std::span<const std::array<Vertex, 2>> ends{
                reinterpret_cast<const std::array<Vertex, 2>*>(segments.data()), segments.shape(0)};
            Array<double> found;
            {
                const nb::gil_scoped_release released;
                found = edge_sagittas(rows<Point3>(points), ends, rows<std::int32_t>(edges));
            }
            return view(found);
        },
        nb::arg("points"), nb::arg("segments"), nb::arg("edges"),
        "About twice the sagittas (k,) of segments (k, 2), rows of points (n, 3), by the angles "
        "between those that follow each other on one of the edges (k,); 0 where one is alone.");
}

void bind_soundness(nb::module_& m) {
    m.def(
        "unused_vertex",
        [](const VertexTriples& triangles, std::size_t vertices) {
            require_indices(all_numbers(triangles), vertices, "triangles");
            const nb::gil_scoped_release released;
            return unused_vertex(rows<TriangleCorners>(triangles), vertices);
        },
        nb::arg("triangles"), nb::arg("vertices"),
        "The first of so many vertices that belongs to none of triangles (m, 3), or -1.");
    m.def(
        "is_sound",
        [](const Points3& points, const VertexTriples& triangles,
           const std::optional<Vector<double>>& sizes, const std::optional<Points3>& mid_points,
           const std::optional<Points2>& uv, const std::optional<VertexTriples>& uv_triangles,
           const Numbers& faces, std::optional<std::size_t> surfaces) {
            const auto finite = [](const auto& array) {
                return !array || are_finite({array->data(), array->size()});
            };
            const nb::gil_scoped_release released;
            if (!are_proper(rows<TriangleCorners>(triangles), points.shape(0))) return false;
            if (uv && uv_triangles && !are_in_range(all_numbers(*uv_triangles), uv->shape(0)))
                return false;
            if (surfaces && !are_in_range(rows<std::int32_t>(faces), *surfaces)) return false;
            const bool are_positive =
                !sizes || std::all_of(sizes->data(), sizes->data() + sizes->size(),
                                      [](double size) { return size > 0.0; });
            return are_positive && are_finite({points.data(), points.size()}) && finite(sizes) &&
                   finite(mid_points) && finite(uv);
        },
        nb::arg("points"), nb::arg("triangles"), nb::arg("sizes").none(),
        nb::arg("mid_points").none(), nb::arg("uv").none(), nb::arg("uv_triangles").none(),
        nb::arg("faces"), nb::arg("surfaces").none(),
        "Does all hold that ``SurfaceMesh.broken_invariant`` is asked for? Corners of triangles "
        "(m, "
        "3) are all of points (n, 3), none twice in a triangle, no three of them twice, and no "
        "vertex left out; uv_triangles (m, 3) are rows of uv (k, 2), faces (m,) of so many "
        "surfaces; all numbers are finite, sizes (n,) positive.");
    m.def(
        "has_repeated_triangles",
        [](const VertexTriples& triangles, std::size_t vertices) {
            require_indices(all_numbers(triangles), vertices, "triangles");
            const nb::gil_scoped_release released;
            return has_repeated_triangles(rows<TriangleCorners>(triangles), vertices);
        },
        nb::arg("triangles"), nb::arg("vertices"),
        "Have two triangles (m, 3) the same three corners, in any order?");
}

}  // namespace

void bind_mesh_edges(nb::module_& m) {
    bind_sagittas(m);
    bind_soundness(m);
}

}  // namespace surfmesh::binding
