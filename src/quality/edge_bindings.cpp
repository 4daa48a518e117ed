#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>

#include <array>
#include <tuple>

#include "binding/arrays.hpp"
#include "binding/released.hpp"
#include "quality/mesh_arguments.hpp"
#include "quality/mesh_edges.hpp"
#include "quality/rim_losses.hpp"
#include "quality/triangle_fans.hpp"

namespace surfmesh::binding {

template <>
struct Row<EdgeSides> : RowOf<std::int32_t, 2> {};

namespace {

using VertexTriples = Matrix<std::int32_t, 3>;
using SidePairs = Matrix<std::int32_t, 2>;

std::span<const Vertex> all_numbers(const VertexTriples& triangles) {
    return {triangles.data(), triangles.size()};
}

void bind_sides(nb::module_& m) {
    m.def(
        "edges_of_faces",
        [](const SidePairs& half_edges, const Vector<std::int32_t>& faces) {
            const auto sides = half_edge_pairs(half_edges, faces.shape(0));
            const auto seen =
                released([&] { return edges_of_faces(sides, rows<std::int32_t>(faces)); });
            return view(seen);
        },
        nb::arg("half_edges"), nb::arg("faces"),
        "Edges for ``mesh_deviation``: half_edges (ne, 2) as they are within a face; of those "
        "between two faces (m,) of triangles the first, and at the end the second.");
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

void bind_fans(nb::module_& m) {
    m.def(
        "triangle_fans",
        [](const VertexTriples& triangles, std::size_t vertices, const SidePairs& half_edges) {
            require_indices(all_numbers(triangles), vertices, "triangles");
            const auto sides = half_edge_pairs(half_edges, triangles.shape(0));
            Array<std::int64_t> fans;
            {
                const nb::gil_scoped_release released;
                fans = triangle_fans(rows<TriangleCorners>(triangles), vertices, sides);
            }
            return view(fans);
        },
        nb::arg("triangles"), nb::arg("vertices"), nb::arg("half_edges"),
        "Fans (n,) of triangles (m, 3) at each vertex. half_edges (k, 2): pairs that join their "
        "triangles along an edge, whichever way they run; -1 in the second column: none.");
    m.def(
        "clashing_edges",
        [](const VertexTriples& triangles, const SidePairs& half_edges,
           const Vector<std::int32_t>& uses) {
            require_rows(uses.shape(0), half_edges.shape(0), "uses");
            const auto sides = half_edge_pairs(half_edges, triangles.shape(0));
            Array<std::int32_t> clashing;
            {
                const nb::gil_scoped_release released;
                clashing = clashing_edges(rows<TriangleCorners>(triangles), sides,
                                          rows<std::int32_t>(uses));
            }
            return view(clashing);
        },
        nb::arg("triangles"), nb::arg("half_edges"), nb::arg("uses"),
        "Numbers (k,) of the edges whose two triangles run along them the same way.");
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
        "are_proper",
        [](const VertexTriples& triangles, std::size_t vertices) {
            const nb::gil_scoped_release released;
            return are_proper(rows<TriangleCorners>(triangles), vertices);
        },
        nb::arg("triangles"), nb::arg("vertices"),
        "Are the corners of triangles (m, 3) all of so many vertices, none twice in a triangle, no "
        "three of them twice, and no vertex left out?");
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
    bind_sides(m);
    bind_sagittas(m);
    bind_fans(m);
}

}  // namespace surfmesh::binding
