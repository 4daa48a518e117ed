#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>

#include <algorithm>
#include <optional>
#include <string>

#include "binding/arrays.hpp"
#include "binding/released.hpp"
#include "edges/checked_arguments.hpp"
#include "edges/curve_pieces.hpp"
#include "edges/edge_courses.hpp"
#include "edges/edge_cutting.hpp"
#include "edges/edge_gradation.hpp"
#include "edges/gradation_over_faces.hpp"
#include "edges/rim_sags.hpp"

namespace surfmesh::binding {

void bind_rows_of_edges(nb::module_& m);
void bind_sides(nb::module_& m);

namespace {

CurvePieces pieces_of(const nb::list& curves, const Numbers& t0, const Numbers& t1) {
    require_rows(t0.shape(0), curves.size(), "t0");
    require_rows(t1.shape(0), curves.size(), "t1");
    CurvePieces pieces{{}, Array<double>(rows<double>(t0)), Array<double>(rows<double>(t1))};
    pieces.curves.reserve(curves.size());
    for (const nb::handle curve : curves)
        pieces.curves.push_back(curve.is_none() ? nullptr
                                                : nb::cast<std::shared_ptr<Curve>>(curve));
    return pieces;
}

PiecePlaces checked_places(const CurvePieces& pieces, const Indices& which, const Indices& first,
                           const Numbers& fraction) {
    const auto numbers = rows<std::int64_t>(which);
    require_indices(numbers, pieces.size(), "which");
    require_offsets(first, which.shape(0), fraction.shape(0), "first");
    for (const std::int64_t piece : numbers)
        if (!pieces.curves[static_cast<std::size_t>(piece)])
            throw nb::value_error("which has a piece without a curve");
    return {numbers, rows<std::int64_t>(first), rows<double>(fraction)};
}

auto arrays_of(const SurfaceCurvatures& found) {
    if (found.refused >= 0)
        throw nb::value_error(
            ("surface " + std::to_string(found.refused) + " has no second derivatives").c_str());
    return std::tuple(view(found.k1), view(found.k2), view(found.degenerate));
}

EdgeNetwork checked_network(const Points3& points, const Indices& first,
                            const Matrix<std::int64_t, 2>& ends, std::size_t vertices) {
    require_offsets(first, ends.shape(0), points.shape(0), "first");
    require_indices(std::span(ends.data(), ends.size()), vertices, "ends");
    return {rows<Point3>(points), rows<std::int64_t>(first), rows<SegmentEnds>(ends), vertices};
}

void bind_pieces(nb::module_& m) {
    nb::class_<CurvePieces>(m, "CurvePieces",
                            "The curves of all edges, or coedges, of a model between their ends.")
        .def(
            "__init__",
            [](CurvePieces* self, const nb::list& curves, const Numbers& t0, const Numbers& t1) {
                new (self) CurvePieces(pieces_of(curves, t0, t1));
            },
            nb::arg("curves"), nb::arg("t0"), nb::arg("t1"),
            "curves: n of the core, or None; t0, t1 (n,): parameters at the ends.")
        .def("__len__", &CurvePieces::size)
        .def(
            "points",
            [](const CurvePieces& pieces, const Indices& which, const Indices& first,
               const Numbers& fraction) {
                const PiecePlaces places = checked_places(pieces, which, first, fraction);
                const auto found = released([&] { return points_on(pieces, places); });
                return view(found);
            },
            nb::arg("which"), nb::arg("first"), nb::arg("fraction"),
            "Points (n, 3), with z = 0 of curves in the plane, at fractions (n,) of the ranges of "
            "pieces which (k,); of row i those from first[i] to first[i + 1].")
        .def(
            "sags",
            [](const CurvePieces& pieces, std::int64_t which, const Numbers& fraction) {
                const std::int64_t piece[] = {which};
                require_indices(std::span<const std::int64_t>(piece), pieces.size(), "which");
                if (!pieces.curves[static_cast<std::size_t>(which)] || fraction.size() < 2)
                    throw nb::value_error("a piece with a curve, and two nodes at least");
                RimSags found;
                rim_sags(pieces, which, rows<double>(fraction), found);
                return std::pair(view(found.sag), view(found.length));
            },
            nb::arg("which"), nb::arg("fraction"),
            "How far one piece lies from the chords (n,) between fractions (n + 1,) of its range, "
            "at a quarter, the middle and three quarters of each, and how long these are.");
}

void bind_courses(nb::module_& m) {
    m.def(
        "edge_courses",
        [](const CurvePieces& pieces, const Indices& which, const Indices& first,
           const Numbers& fraction, const Flags& straight) {
            const PiecePlaces places = checked_places(pieces, which, first, fraction);
            require_rows(straight.shape(0), which.shape(0), "straight");
            const auto found = released(
                [&] { return edge_courses(pieces, places, rows<std::uint8_t>(straight)); });
            return std::tuple(view(found.points), view(found.tangents), view(found.curvature),
                              view(found.total_curvature));
        },
        nb::arg("pieces"), nb::arg("which"), nb::arg("first"), nb::arg("fraction"),
        nb::arg("straight"),
        "Points and unit tangents (n, 3), curvature (n,) along pieces which (k,) at fractions (n,) "
        "of their ranges, and the integral of the curvature (k,), radians.\n\nstraight: (k,) "
        "uint8, "
        "the piece is of a line.");
    m.def(
        "curvatures_along",
        [](const CurvePieces& pieces, const Indices& which, const Indices& first,
           const Numbers& fraction, const nb::list& surfaces) {
            const PiecePlaces places = checked_places(pieces, which, first, fraction);
            const SharedSurfaces shared = surfaces_of(surfaces, which.shape(0));
            const auto found = released([&] { return curvatures_along(pieces, places, shared); });
            return arrays_of(found);
        },
        nb::arg("pieces"), nb::arg("which"), nb::arg("first"), nb::arg("fraction"),
        nb::arg("surfaces"),
        "Principal curvatures k1 >= k2 (n,) of surfaces along their coedges, and where they are "
        "degenerate (n,).\n\npieces: the coedges; surfaces: k, one for each of which (k,).");
    m.def(
        "curvatures_at",
        [](const Points2& uv, const Indices& first, const nb::list& surfaces) {
            require_offsets(first, surfaces.size(), uv.shape(0), "first");
            const SharedSurfaces shared = surfaces_of(surfaces, surfaces.size());
            const auto found = released(
                [&] { return curvatures_at(rows<Point2>(uv), rows<std::int64_t>(first), shared); });
            return arrays_of(found);
        },
        nb::arg("uv"), nb::arg("first"), nb::arg("surfaces"),
        "The same of k surfaces at uv (n, 2); of surface i those from first[i] to first[i + 1].");
}

void bind_gradation(nb::module_& m) {
    m.def(
        "graded_along_edges",
        [](const Points3& points, const Numbers& sizes, const Indices& first,
           const Matrix<std::int64_t, 2>& ends, std::size_t vertices, double slope,
           double least_step) {
            const EdgeNetwork edges = checked_network(points, first, ends, vertices);
            require_rows(sizes.shape(0), points.shape(0), "sizes");
            const auto found = released(
                [&] { return graded_along_edges(edges, rows<double>(sizes), slope, least_step); });
            return view(found);
        },
        nb::arg("points"), nb::arg("sizes"), nb::arg("first"), nb::arg("ends"), nb::arg("vertices"),
        nb::arg("slope"), nb::arg("least_step"),
        "Sizes (n,) that grow by no more than slope times the way along edges and through "
        "vertices.\n\npoints (n, 3), sizes (n,): samples, of edge e those from first[e] to "
        "first[e + 1]; ends (e, 2): vertices; steps between samples count as least_step at least.");
    m.def(
        "graded_over_faces",
        [](const Points3& points, const Numbers& sizes, const Indices& first,
           const Matrix<std::int64_t, 2>& ends, std::size_t vertices, const Indices& first_of_face,
           const Indices& edges_of_face, double slope, double least_step,
           const std::optional<Numbers>& before) {
            const EdgeNetwork edges = checked_network(points, first, ends, vertices);
            require_rows(sizes.shape(0), points.shape(0), "sizes");
            if (before) require_rows(before->shape(0), points.shape(0), "before");
            if (first_of_face.shape(0) == 0) throw nb::value_error("first_of_face is empty");
            require_offsets(first_of_face, first_of_face.shape(0) - 1, edges_of_face.shape(0),
                            "first_of_face");
            require_indices(rows<std::int64_t>(edges_of_face), ends.shape(0), "edges_of_face");
            const auto found = released([&] {
                return graded_over_faces(
                    edges, {rows<std::int64_t>(first_of_face), rows<std::int64_t>(edges_of_face)},
                    rows<double>(sizes), slope, least_step,
                    before ? rows<double>(*before) : std::span<const double>());
            });
            return view(found);
        },
        nb::arg("points"), nb::arg("sizes"), nb::arg("first"), nb::arg("ends"), nb::arg("vertices"),
        nb::arg("first_of_face"), nb::arg("edges_of_face"), nb::arg("slope"), nb::arg("least_step"),
        nb::arg("before") = nb::none(),
        "The same where sizes grow straight across faces too.\n\nedges_of_face (k,): each once, "
        "those of face f from first_of_face[f] to first_of_face[f + 1]. before: what this has "
        "found "
        "for sizes none of which was smaller: only what is smaller now grows.");
}

void bind_cutting(nb::module_& m) {
    m.def(
        "cut_to_metric_length",
        [](const CurvePieces& curves, const Points3& points, const Numbers& fraction,
           const Numbers& sizes, const Indices& first, const Matrix<std::int64_t, 2>& ends,
           const Points3& corners, const Indices& which, const Indices& fewest,
           const Indices& first_given, const Numbers& given, const Numbers& chord,
           const Numbers& shortest, double most) {
            const EdgeNetwork edges = checked_network(points, first, ends, corners.shape(0));
            require_rows(fraction.shape(0), points.shape(0), "fraction");
            require_rows(sizes.shape(0), points.shape(0), "sizes");
            require_rows(curves.size(), ends.shape(0), "curves");
            require_rows(fewest.shape(0), which.shape(0), "fewest");
            require_rows(chord.shape(0), which.shape(0), "chord");
            require_rows(shortest.shape(0), which.shape(0), "shortest");
            require_offsets(first_given, which.shape(0), given.shape(0), "first_given");
            require_indices(rows<std::int64_t>(which), ends.shape(0), "which");
            for (const std::int64_t edge : rows<std::int64_t>(which))
                if (edges.first[edge] == edges.first[edge + 1] ||
                    !curves.curves[static_cast<std::size_t>(edge)])
                    throw nb::value_error("which has an edge without samples");
            if (!std::all_of(fewest.data(), fewest.data() + fewest.size(),
                             [](std::int64_t pieces) { return pieces > 0; }))
                throw nb::value_error("an edge has one piece at least");
            const auto found = released([&] {
                return cut_to_metric_length(curves, edges, rows<double>(fraction),
                                            rows<double>(sizes), rows<Point3>(corners),
                                            {rows<std::int64_t>(which), rows<std::int64_t>(fewest),
                                             rows<std::int64_t>(first_given), rows<double>(given),
                                             rows<double>(chord), rows<double>(shortest), most});
            });
            return std::tuple(view(found.first), view(found.t), view(found.points),
                              view(found.sizes), found.refused, found.pieces);
        },
        nb::arg("curves"), nb::arg("points"), nb::arg("fraction"), nb::arg("sizes"),
        nb::arg("first"), nb::arg("ends"), nb::arg("corners"), nb::arg("which"), nb::arg("fewest"),
        nb::arg("first_given"), nb::arg("given"), nb::arg("chord"), nb::arg("shortest"),
        nb::arg("most"),
        "Nodes of the edges in which (k,): offsets (k + 1,), fractions t (m,), points (m, 3), "
        "sizes "
        "(m,); and the row of an edge of more than ``most`` pieces with their number, or -1.\n\n"
        "points (n, 3), fraction (n,), sizes (n,): samples, of edge e those from first[e] to "
        "first[e + 1]; ends (e, 2): rows of corners (v, 3). fewest (k,): pieces. given: the nodes "
        "of row i from first_given[i] to first_given[i + 1], none where they are to be found. "
        "chord (k,): what a found piece may sag by at most, infinite for nothing, unless its chord "
        "is no longer than shortest (k,).");
}

}  // namespace

void bind_edges(nb::module_& m) {
    m.doc() = "The edges of a CAD model: samples, gradation along them, nodes.";
    bind_pieces(m);
    bind_courses(m);
    bind_gradation(m);
    bind_cutting(m);
    bind_rows_of_edges(m);
    bind_sides(m);
}

}  // namespace surfmesh::binding
