#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>

#include "binding/arrays.hpp"
#include "binding/released.hpp"
#include "space/box_tree.hpp"
#include "space/edge_distances.hpp"
#include "space/edge_table.hpp"
#include "space/graph_patches.hpp"
#include "space/measure.hpp"
#include "space/orient_space.hpp"
#include "space/point_tree.hpp"
#include "space/supporting_planes.hpp"
#include "space/triangle_distance.hpp"
#include "space/triangle_pairs.hpp"
#include "space/triangle_planes.hpp"

namespace surfmesh::binding {

template <>
struct Row<MeetingTriangles> : RowOf<std::int32_t, 2> {};
template <>
struct Row<SupportingPatches> : RowOf<std::int32_t, 6> {};
template <>
struct Row<TriangleCorners> : RowOf<std::int32_t, 3> {};
template <>
struct Row<ThingPair> : RowOf<std::int32_t, 2> {};
template <>
struct Row<TangentPlaneOffset> : RowOf<double, 7> {};
template <>
struct Row<EdgeTable::Ends> : RowOf<std::int32_t, 2> {};
template <>
struct Row<EdgeTable::Sides> : RowOf<std::int32_t, 2> {};
template <>
struct Row<Box3> : RowOf<double, 6> {};

namespace {

using Triangles = Matrix<std::int32_t, 3>;
using HalfEdges = Matrix<std::int32_t, 2>;
using Indices = Vector<std::int64_t>;

void require_corners(const Triangles& triangles, std::size_t points) {
    require_indices(std::span(triangles.data(), triangles.size()), points, "triangles");
}

void require_patches(const Vector<std::int32_t>& patches, std::size_t triangles) {
    require_rows(patches.shape(0), triangles, "patches");
    for (const std::int32_t patch : rows<std::int32_t>(patches))
        if (patch < NIL || patch >= static_cast<std::int64_t>(triangles))
            throw nb::value_error("patches has a number that is out of range");
}

void require_support(const Matrix<std::int32_t, 6>& support,
                     const std::optional<Vector<std::int32_t>>& patches) {
    if (!patches) throw nb::value_error("support without patches");
    for (const std::int32_t patch : rows<std::int32_t>(*patches))
        if (patch >= static_cast<std::int64_t>(support.shape(0)))
            throw nb::value_error("support has fewer rows than there are patches");
}

void bind_triangle_pairs(nb::module_& m) {
    m.def(
        "orient_space",
        [](const Points3& corners) {
            require_rows(corners.shape(0), 4, "corners");
            const auto p = rows<Point3>(corners);
            return orient_space(p[0], p[1], p[2], p[3]);
        },
        nb::arg("corners"),
        "Six times the signed volume of abcd, the rows of (4, 3); its sign is exact: > 0 where abc "
        "is seen from d clockwise. nan where a coordinate is not finite.");
    m.def(
        "triangles_meet",
        [](const Points3& corners) {
            require_rows(corners.shape(0), 6, "corners");
            const auto triangles = rows<Point3>(corners);
            return triangles_meet({triangles[0], triangles[1], triangles[2]},
                                  {triangles[3], triangles[4], triangles[5]});
        },
        nb::arg("corners"),
        "Do two triangles, the rows of (6, 3), finite, meet where they should not?");
    m.def(
        "graph_patches",
        [](const Points3& points, const Triangles& triangles, const HalfEdges& half_edges) {
            require_corners(triangles, points.shape(0));
            const auto places = rows<Point3>(points);
            const auto corners = rows<TriangleCorners>(triangles);
            const auto [patches, support] = released([&] {
                const Array<HalfEdge> twins =
                    opposite_half_edges(corners, rows<EdgeTable::Sides>(half_edges));
                GraphPatches found = graph_patches(places, corners, twins);
                auto planes = supporting_patches(places, corners, twins, found);
                return std::pair(std::move(found.of_triangles), std::move(planes));
            });
            return std::tuple(view(patches), view(support));
        },
        nb::arg("points"), nb::arg("triangles"), nb::arg("half_edges"),
        "The number (m,) of each triangle's patch that cannot meet itself, -1 where none is "
        "proved; "
        "the flat patches (k, 6) whose planes each patch is above, across x, y, z, and below, "
        "without meeting them, -1: none.\n\npoints (n, 3), finite; triangles (m, 3); half_edges "
        "(ne, 2) as of ``edge_table``.");
    m.def(
        "meeting_triangles",
        [](const Points3& points, const Triangles& triangles, std::size_t most,
           const std::optional<Vector<std::int32_t>>& patches,
           const std::optional<Matrix<std::int32_t, 6>>& support) {
            require_corners(triangles, points.shape(0));
            if (patches) require_patches(*patches, triangles.shape(0));
            if (support) require_support(*support, patches);
            const auto found = released([&] {
                return meeting_triangles(
                    rows<Point3>(points), rows<TriangleCorners>(triangles),
                    patches ? rows<std::int32_t>(*patches) : std::span<const std::int32_t>{},
                    support ? rows<SupportingPatches>(*support)
                            : std::span<const SupportingPatches>{},
                    most);
            });
            return view(found);
        },
        nb::arg("points"), nb::arg("triangles"), nb::arg("most"), nb::arg("patches") = nb::none(),
        nb::arg("support") = nb::none(),
        "Pairs (k, 2) of triangles that meet where they should not, the lower first.\n\npoints "
        "(n, 3), finite; triangles (m, 3). The search ends where there are ``most`` pairs or a few "
        "more. patches (m,): those of one number that is not -1 do not meet, nor those of a patch "
        "those of one in its row of support (k, 6): both of ``graph_patches``.");
}

void bind_edge_table(nb::module_& m) {
    m.def(
        "edge_table",
        [](const Triangles& triangles) {
            const auto table =
                released([&] { return edge_table(rows<TriangleCorners>(triangles)); });
            return std::tuple(view(table.edges), view(table.half_edges), view(table.uses));
        },
        nb::arg("triangles"),
        "Edges (ne, 2) of triangles (m, 3), the lower vertex first, in order; the first two "
        "half-edges (ne, 2) along each, -1 where there is one; by how many triangles each is used "
        "(ne,). Half-edge 3 t + k runs from corner k of triangle t.");
    m.def(
        "edge_rows",
        [](const HalfEdges& edges, const HalfEdges& pairs) {
            const auto ends = rows<EdgeTable::Ends>(edges);
            if (!std::is_sorted(ends.begin(), ends.end()))
                throw nb::value_error("edges are not in order");
            const auto found =
                released([&] { return edge_rows(ends, rows<EdgeTable::Ends>(pairs)); });
            return view(found);
        },
        nb::arg("edges"), nb::arg("pairs"),
        "Rows (k,) of edges (ne, 2), as of ``edge_table``, of pairs (k, 2) of vertices in either "
        "order; -1 where there is none.");
}

void require_offsets(const Indices& offsets, std::size_t last, const char* what) {
    const auto values = rows<std::int64_t>(offsets);
    if (values.empty() || values.front() != 0 || values.back() != static_cast<std::int64_t>(last) ||
        !std::is_sorted(values.begin(), values.end()))
        throw nb::value_error((std::string(what) + " are no offsets").c_str());
}

void bind_edge_gaps(nb::module_& m) {
    m.def(
        "edge_gaps",
        [](const Points3& points, const Vector<double>& reach, const Indices& first,
           const Matrix<std::int64_t, 2>& ends, const Indices& edges,
           const Indices& first_of_face) {
            require_rows(reach.shape(0), points.shape(0), "reach");
            require_offsets(first, points.shape(0), "first");
            require_rows(ends.shape(0), first.shape(0) - 1, "ends");
            require_offsets(first_of_face, edges.shape(0), "first_of_face");
            require_indices(rows<std::int64_t>(edges), ends.shape(0), "edges");
            const auto found = released([&] {
                return edge_gaps({rows<Point3>(points), rows<double>(reach),
                                  rows<std::int64_t>(first), rows<SegmentEnds>(ends),
                                  rows<std::int64_t>(edges), rows<std::int64_t>(first_of_face)});
            });
            return std::pair(view(found.gap), view(found.boxes));
        },
        nb::arg("points"), nb::arg("reach"), nb::arg("first"), nb::arg("ends"), nb::arg("edges"),
        nb::arg("first_of_face"),
        "Distance (n,) of each sample from the edges that share a face with its own but no vertex, "
        "and boxes (e, 6) around the edges, rows (low, high).\n\npoints (n, 3): samples, of edge e "
        "those from first[e] to first[e + 1]; reach (n,): farther than this is not looked at, the "
        "distance is infinite. ends (e, 2): vertices; edges, first_of_face: those of each face in "
        "one row.");
    m.def(
        "edge_sags",
        [](const Points3& points, const Indices& first) {
            require_offsets(first, points.shape(0), "first");
            const auto found =
                released([&] { return sags(rows<Point3>(points), rows<std::int64_t>(first)); });
            return view(found);
        },
        nb::arg("points"), nb::arg("first"),
        "How far (e,) the segments between the samples of each edge lie off its curve, about, at "
        "most; points (n, 3), of edge e those from first[e] to first[e + 1].");
}

void bind_shapes(nb::module_& m) {
    m.def(
        "triangle_planes",
        [](const Points3& points, const Triangles& triangles, const Vector<std::int32_t>& chosen) {
            require_corners(triangles, points.shape(0));
            require_indices(rows<std::int32_t>(chosen), triangles.shape(0), "chosen");
            const auto found = released([&] {
                return triangle_planes(rows<Point3>(points), rows<TriangleCorners>(triangles),
                                       rows<std::int32_t>(chosen));
            });
            return std::tuple(view(found.normal), view(found.twice_area), view(found.longest));
        },
        nb::arg("points"), nb::arg("triangles"), nb::arg("chosen"),
        "Unit normals (k, 3), twice the areas (k,) and the longest sides (k,) of some triangles, "
        "rows (k,) of (m, 3). A triangle without area has the normal zero.");
    m.def(
        "triangle_shapes",
        [](const Points3& points, const Triangles& triangles) {
            require_corners(triangles, points.shape(0));
            const auto shapes = released([&] {
                return triangle_shapes(rows<Point3>(points), rows<TriangleCorners>(triangles));
            });
            return std::tuple(view(shapes.area), view(shapes.alpha), view(shapes.radius_ratio),
                              view(shapes.least_angle), view(shapes.largest_angle));
        },
        nb::arg("points"), nb::arg("triangles"),
        "Shape of every triangle, measured in 3D, each (m,): area; alpha = 4 sqrt(3) area / sum of "
        "squared edges; radius ratio 2 r_in / r_circum; smallest and largest angle in degrees.\n\n"
        "1 is best for alpha and the radius ratio, 0 is a triangle without area.");
    m.def(
        "interpolate",
        [](const nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>& values,
           const Triangles& corners, const Vector<std::int32_t>& triangle,
           const Vector<std::int32_t>& rule, const Matrix<double, 3>& weights) {
            require_corners(corners, values.shape(0));
            require_indices(rows<std::int32_t>(triangle), corners.shape(0), "triangle");
            require_rows(rule.shape(0), triangle.shape(0), "rule");
            require_indices(rows<std::int32_t>(rule), weights.shape(0), "rule");
            const std::size_t shape[] = {triangle.shape(0), values.shape(1)};
            const auto found = released([&] {
                return interpolate({values.data(), values.size()}, shape[1],
                                   rows<TriangleCorners>(corners), rows<std::int32_t>(triangle),
                                   rows<std::int32_t>(rule), rows<Weights>(weights));
            });
            return nb::ndarray<nb::numpy, double, nb::ndim<2>>(found.data(), 2, shape,
                                                               owner_of(found));
        },
        nb::arg("corner_values"), nb::arg("corners"), nb::arg("triangle"), nb::arg("rule"),
        nb::arg("weights"),
        "Values (k, d) at barycentric places in triangles.\n\ncorner_values (n, d); corners (m, "
        "3): "
        "rows of them; triangle (k,), rule (k,): the triangle of each sample, and its row of "
        "weights (w, 3).");
}

void bind_distances(nb::module_& m) {
    m.def(
        "tangent_plane_offsets",
        [](const Points3& points, const Points3& feet, const Points3& ru, const Points3& rv) {
            const std::size_t count = points.shape(0);
            require_rows(feet.shape(0), count, "feet");
            require_rows(ru.shape(0), count, "ru");
            require_rows(rv.shape(0), count, "rv");
            Array<TangentPlaneOffset> found;
            {
                const nb::gil_scoped_release released;
                found.reserve(count);
                for (std::size_t i = 0; i < count; ++i)
                    found.push_back(tangent_plane_offset(
                        rows<Point3>(points)[i],
                        {rows<Point3>(feet)[i], rows<Point3>(ru)[i], rows<Point3>(rv)[i]}));
            }
            return view(found);
        },
        nb::arg("points"), nb::arg("feet"), nb::arg("ru"), nb::arg("rv"),
        "Where points (n, 3) lie relative to the tangent planes at feet r(u, v) near them: (n, 7)."
        "\n\nUnit normal along r_u x r_v (zero where there is none); distance along it (the whole "
        "distance where there is none); distance within the tangent plane; the step in (u, v) that "
        "covers the latter (Gauss-Newton).");
    m.def(
        "triangle_distances",
        [](const Points3& points, const nb::ndarray<const double, nb::shape<-1, 3, 3>, nb::c_contig,
                                                    nb::device::cpu>& corners) {
            const std::size_t step = points.shape(0) == 1 ? 0 : 1;
            if (step == 1) require_rows(points.shape(0), corners.shape(0), "points");
            Array<double> found(corners.shape(0));
            {
                const nb::gil_scoped_release released;
                const auto* triangles = reinterpret_cast<const Triangle3*>(corners.data());
                for (std::size_t i = 0; i < found.size(); ++i)
                    found[i] = triangle_distance(rows<Point3>(points)[i * step], triangles[i]);
            }
            return view(found);
        },
        nb::arg("points"), nb::arg("corners"),
        "Distance (k,) of points (k, 3), or of one (1, 3), from triangles with corners (k, 3, 3).");
    m.def(
        "component_labels",
        [](std::size_t count, const Matrix<std::int32_t, 2>& pairs) {
            require_indices(std::span(pairs.data(), pairs.size()), count, "pairs");
            const auto labels =
                released([&] { return component_labels(count, rows<ThingPair>(pairs)); });
            return view(labels);
        },
        nb::arg("count"), nb::arg("pairs"),
        "Label (count,) things 0 .. count - 1 by connected component: the smallest member of each."
        "\n\npairs: (k, 2), things that belong together.");
}

void bind_nearest_points(nb::module_& m) {
    nb::class_<PointTree>(m, "PointTree", "The points of a set that are nearest to places.")
        .def(
            "__init__",
            [](PointTree* self, const Points3& points) {
                if (points.shape(0) == 0) throw nb::value_error("there are no points");
                const std::span<const double> numbers(points.data(), points.size());
                if (!std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); }))
                    throw nb::value_error("points are not finite");
                new (self) PointTree(rows<Point3>(points));
            },
            nb::arg("points"), "points (n, 3), n > 0, finite: copied.")
        .def(
            "nearest",
            [](const PointTree& tree, const Points3& places, std::size_t count) {
                count = std::min(count, tree.size());
                const std::size_t shape[] = {places.shape(0), count};
                Array<double> distance(shape[0] * count);
                Array<std::int32_t> number(shape[0] * count);
                {
                    const nb::gil_scoped_release released;
                    nearest_points(tree, rows<Point3>(places), count,
                                   {distance.data(), distance.size()},
                                   {number.data(), number.size()});
                }
                return std::pair(nb::ndarray<nb::numpy, double, nb::ndim<2>>(
                                     distance.data(), 2, shape, owner_of(distance)),
                                 nb::ndarray<nb::numpy, std::int32_t, nb::ndim<2>>(
                                     number.data(), 2, shape, owner_of(number)));
            },
            nb::arg("places"), nb::arg("count"),
            "Distances (p, count) of the nearest points of places (p, 3), and their numbers (p, "
            "count); the nearest first, of equally near ones the lower number. Fewer columns where "
            "there are fewer points.");
}

}  // namespace

void bind_space(nb::module_& m) {
    m.doc() = "What is measured and decided in space: shapes, distances, triangles that meet.";
    bind_triangle_pairs(m);
    bind_edge_table(m);
    bind_edge_gaps(m);
    bind_shapes(m);
    bind_distances(m);
    bind_nearest_points(m);
}

}  // namespace surfmesh::binding
