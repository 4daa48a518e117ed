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

/// Edges (k, 2) between so many vertices.
std::span<const EdgeTable::Ends> ends_of(const SidePairs& edges, std::size_t vertices) {
    require_indices(std::span(edges.data(), edges.size()), vertices, "edges");
    return {reinterpret_cast<const EdgeTable::Ends*>(edges.data()), edges.shape(0)};
}

void bind_lengths(nb::module_& m) {
    m.def(
        "edge_lengths",
        [](const Points3& points, const SidePairs& edges) {
            const auto ends = ends_of(edges, points.shape(0));
            const auto lengths = released([&] { return edge_lengths(rows<Point3>(points), ends); });
            return view(lengths);
        },
        nb::arg("points"), nb::arg("edges"), "Length (k,) of edges (k, 2) between points (n, 3).");
    m.def(
        "edge_sizes",
        [](const SidePairs& edges, const Vector<double>& sizes) {
            const auto ends = ends_of(edges, sizes.shape(0));
            const auto found = released([&] { return edge_sizes(ends, rows<double>(sizes)); });
            return std::tuple(view(found.mean), view(found.apart));
        },
        nb::arg("edges"), nb::arg("sizes"),
        "Of the sizes (n,) at both ends of edges (k, 2): their mean (k,), and by how much (k,) "
        "they "
        "are apart.");
    m.def(
        "size_changes",
        [](const Vector<double>& apart, const Vector<double>& lengths, double slope, double most) {
            require_rows(lengths.shape(0), apart.shape(0), "lengths");
            const nb::gil_scoped_release released;
            const SizeChanges found =
                size_changes(rows<double>(apart), rows<double>(lengths), slope, most);
            return std::tuple(found.steepest, found.largest, found.above);
        },
        nb::arg("apart"), nb::arg("lengths"), nb::arg("slope"), nb::arg("most"),
        "The first edge, -1 for none, along which the quotient of apart (k,) and slope times "
        "lengths (k,) is largest, 0 where it is not finite, that quotient, and how many are above "
        "``most``.");
    m.def(
        "edge_extremes",
        [](const SidePairs& edges, const Vector<double>& lengths, std::size_t vertices) {
            const auto ends = ends_of(edges, vertices);
            require_rows(lengths.shape(0), edges.shape(0), "lengths");
            const auto found =
                released([&] { return edge_extremes(ends, rows<double>(lengths), vertices); });
            return std::tuple(view(found.longest), view(found.shortest));
        },
        nb::arg("edges"), nb::arg("lengths"), nb::arg("vertices"),
        "Length (n,) of the longest and of the shortest of edges (k, 2), of lengths (k,), at each "
        "vertex; 0 and infinite where there is none.");
}

void bind_angles(nb::module_& m) {
    m.def(
        "angles_within_faces",
        [](const Points3& points, const VertexTriples& triangles, const Vector<std::int32_t>& faces,
           const SidePairs& half_edges, const Vector<std::int32_t>& uses) {
            require_indices(all_numbers(triangles), points.shape(0), "triangles");
            require_rows(faces.shape(0), triangles.shape(0), "faces");
            require_rows(uses.shape(0), half_edges.shape(0), "uses");
            const auto sides = half_edge_pairs(half_edges, triangles.shape(0));
            AnglesWithinFaces found;
            {
                const nb::gil_scoped_release released;
                found =
                    angles_within_faces(rows<Point3>(points), rows<TriangleCorners>(triangles),
                                        rows<std::int32_t>(faces), sides, rows<std::int32_t>(uses));
            }
            return std::tuple(view(found.edges), view(found.faces), view(found.degrees));
        },
        nb::arg("points"), nb::arg("triangles"), nb::arg("faces"), nb::arg("half_edges"),
        nb::arg("uses"),
        "Numbers (k,) of the edges between two triangles of one face, that face (k,), and the "
        "angle (k,) between their normals, degrees.\n\npoints (n, 3), triangles (m, 3), faces "
        "(m,); half_edges (ne, 2) and uses (ne,) of the edge table.");
}

void bind_rims(nb::module_& m) {
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
    m.def(
        "rim_losses",
        [](const Points3& points, const VertexTriples& triangles, const Numbers& faces,
           const SidePairs& half_edges, const Vector<std::int32_t>& uses,
           const Vector<std::int64_t>& edge, const Vector<double>& sagitta,
           const Vector<double>& distance, double sharpest, std::size_t count) {
            require_indices(all_numbers(triangles), points.shape(0), "triangles");
            require_rows(faces.shape(0), triangles.shape(0), "faces");
            require_indices(rows<std::int32_t>(faces), count, "faces");
            require_rows(uses.shape(0), half_edges.shape(0), "uses");
            require_rows(sagitta.shape(0), edge.shape(0), "sagitta");
            require_rows(distance.shape(0), triangles.shape(0), "distance");
            const std::span<const std::int64_t> given = rows<std::int64_t>(edge);
            for (const std::int64_t row : given)
                if (row < NIL || row >= static_cast<std::int64_t>(uses.shape(0)))
                    throw nb::value_error("edge has a row that is out of range");
            const JoinedTriangles mesh{
                rows<Point3>(points), rows<TriangleCorners>(triangles), rows<std::int32_t>(faces),
                half_edge_pairs(half_edges, triangles.shape(0)), rows<std::int32_t>(uses)};
            RimLosses lost;
            {
                const nb::gil_scoped_release released;
                lost = rim_losses(mesh, {given, rows<double>(sagitta)}, rows<double>(distance),
                                  sharpest, count);
            }
            return std::pair(view(lost.of_edges), view(lost.of_faces));
        },
        nb::arg("points"), nb::arg("triangles"), nb::arg("faces"), nb::arg("half_edges"),
        nb::arg("uses"), nb::arg("edge"), nb::arg("sagitta"), nb::arg("distance"),
        nb::arg("sharpest"), nb::arg("count"),
        "Area that rims lose: of edges (ne,), 0 where one is none, and of ``count`` faces, of "
        "edges "
        "of one or two triangles. It is length times the larger of sagitta and the distance (m,) "
        "of "
        "their triangles over the sine between these, not below ``sharpest``, at most the length."
        "\n\nRims are edges of one triangle, and the rows edge (k,) with sagitta (k,), -1 for "
        "none; points (n, 3), triangles (m, 3) of faces (m,), half_edges (ne, 2) and uses (ne,) of "
        "the edge table.");
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
    bind_lengths(m);
    bind_angles(m);
    bind_rims(m);
    bind_fans(m);
}

}  // namespace surfmesh::binding
