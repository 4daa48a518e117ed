// The boundaries of faces as numpy has them.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <tuple>

#include "binding/arrays.hpp"
#include "binding/released.hpp"
#include "faces/alike_faces.hpp"
#include "faces/boundary_builder.hpp"
#include "faces/shared_sides.hpp"
#include "insertion/boundary_arguments.hpp"
#include "surfaces/callback_surface.hpp"

namespace surfmesh::binding {

namespace {

using Ids = Vector<std::int64_t>;
using Sizes = Vector<double>;

template <class T, class Given>
Array<T> copied(const Given& given) {
    return Array<T>(rows<T>(given));
}

void construct(FaceBoundary* made, const Points2& uv, const Ids& numbers, const Points3& points,
               const Sizes& sizes, const Numbers& piece_end, const Bytes& degenerate,
               const Sizes& tolerance, const Numbers& loop_end) {
    require_finite(uv, "uv");
    FaceBoundary boundary{copied<Point2>(uv),
                          copied<std::int64_t>(numbers),
                          copied<Point3>(points),
                          copied<double>(sizes),
                          copied<std::int32_t>(piece_end),
                          copied<std::uint8_t>(degenerate),
                          copied<double>(tolerance),
                          copied<std::int32_t>(loop_end)};
    switch (boundary.check()) {
        case BoundaryFault::rows:
            throw nb::value_error("the arrays differ in length");
        case BoundaryFault::pieces:
            throw nb::value_error("piece_end is not that of the nodes");
        case BoundaryFault::loops:
            throw nb::value_error("loop_end is not that of the coedges");
        case BoundaryFault::none:
            break;
    }
    new (made) FaceBoundary(std::move(boundary));
}

void bind_boundary(nb::module_& m) {
    nb::class_<FaceBoundary> c(m, "FaceBoundary",
                               "The boundary of a face, cut into nodes: coedge after coedge, each "
                               "with both its ends, loop after loop.");
    c.def("__init__", &construct, nb::arg("uv"), nb::arg("numbers"), nb::arg("points"),
          nb::arg("sizes"), nb::arg("piece_end"), nb::arg("degenerate"), nb::arg("tolerance"),
          nb::arg("loop_end"));
    bind_read_only_array(c, "uv", &FaceBoundary::uv, "(n, 2)");
    bind_read_only_array(c, "numbers", &FaceBoundary::numbers, "(n,) int64 in the whole mesh");
    bind_read_only_array(c, "points", &FaceBoundary::points, "(n, 3) on the edges' curves");
    bind_read_only_array(c, "sizes", &FaceBoundary::sizes, "(n,) wanted lengths");
    bind_read_only_array(c, "piece_end", &FaceBoundary::piece_end,
                         "(p,) int32 of the coedges: the row after their last node");
    bind_read_only_array(
        c, "degenerate", &FaceBoundary::degenerate,
        "(p,) uint8 of the coedges: one point in space, cut when the metric is known");
    bind_read_only_array(c, "tolerance", &FaceBoundary::tolerance,
                         "(p,) of the coedges: so near is the edge to its p-curves, model units");
    bind_read_only_array(c, "loop_end", &FaceBoundary::loop_end,
                         "(l,) int32 of the loops: the coedge after their last one");
    c.def_prop_ro("has_degenerate", &FaceBoundary::has_degenerate);
    c.def_prop_ro(
        "box",
        [](const FaceBoundary& b) {
            const auto [low, high] = b.box();
            return std::pair(std::pair(low.x, high.x), std::pair(low.y, high.y));
        },
        "Of all nodes: (u0, u1), (v0, v1).");
    c.def("__len__", [](const FaceBoundary& b) { return b.uv.size(); });
    c.def(
        "__reduce__",
        [](nb::handle b) {
            return nb::make_tuple(
                b.type(), nb::make_tuple(b.attr("uv"), b.attr("numbers"), b.attr("points"),
                                         b.attr("sizes"), b.attr("piece_end"), b.attr("degenerate"),
                                         b.attr("tolerance"), b.attr("loop_end")));
        },
        "So that it can be copied and sent to other processes.");
}

void bind_looks_at_a_face(nb::module_& m) {
    m.def("may_have_tubes", &may_have_tubes, nb::arg("surface"), nb::arg("boundary"),
          nb::call_guard<nb::gil_scoped_release>(),
          "Is there a pole, or a seam so near to itself all round that no ring of wanted edges "
          "fits? A cheap look.");
    m.def(
        "extent_over",
        [](const Surface& surface, const std::pair<double, double>& u,
           const std::pair<double, double>& v) {
            Point3 found{};
            {
                const nb::gil_scoped_release released;
                found = extent_over(surface, {{u.first, v.first}, {u.second, v.second}});
            }
            if (std::isnan(found.x)) raise_failure(surface, SurfaceStatus::FAILED);
            return std::tuple(found.x, found.y, found.z);
        },
        nb::arg("surface"), nb::arg("u"), nb::arg("v"),
        "Width, depth and height of the bounding box of a plane or a cylinder over u (u0, u1) and "
        "v (v0, v1), from points of a coarse grid.");
    m.attr("FEWEST_STEPS") = FEWEST_STEPS;
    m.attr("APART") = APART;
    m.attr("WAY_SAMPLES") = WAY_SAMPLES;
}

EdgeNodeRows rows_of(const Points2& uv, const Ids& numbers, const Points3& points,
                     const Sizes& sizes) {
    require_finite(uv, "uv");
    require_rows(numbers.shape(0), uv.shape(0), "numbers");
    require_rows(points.shape(0), uv.shape(0), "points");
    require_rows(sizes.shape(0), uv.shape(0), "sizes");
    return {rows<Point2>(uv), rows<std::int64_t>(numbers), rows<Point3>(points),
            rows<double>(sizes)};
}

void bind_builder(nb::module_& m) {
    nb::class_<BoundaryBuilder>(m, "BoundaryBuilder",
                                "A boundary put together coedge by coedge, as loops are walked.")
        .def(nb::init<>())
        .def(
            "add",
            [](BoundaryBuilder& builder, const Points2& uv, const Ids& numbers,
               const Points3& points, const Sizes& sizes, bool is_degenerate, double tolerance) {
                if (uv.shape(0) < 2) throw nb::value_error("an edge has two nodes at least");
                builder.add(rows_of(uv, numbers, points, sizes), {false, is_degenerate, tolerance});
            },
            nb::arg("uv"), nb::arg("numbers"), nb::arg("points"), nb::arg("sizes"),
            nb::arg("is_degenerate"), nb::arg("tolerance"),
            "A use of an edge: its nodes in walking order.")
        .def("end_loop", &BoundaryBuilder::end_loop)
        .def("boundary", [](const BoundaryBuilder& builder) {
            FaceBoundary made = builder.boundary();
            if (made.check() != BoundaryFault::none) throw nb::value_error("a loop is not ended");
            return made;
        });
}

void require_boundaries(const std::vector<const FaceBoundary*>& boundaries) {
    for (const FaceBoundary* boundary : boundaries)
        if (boundary == nullptr) throw nb::type_error("None is no boundary");
}

void bind_figures(nb::module_& m) {
    m.def(
        "fewest_triangles",
        [](const std::vector<const FaceBoundary*>& boundaries) {
            require_boundaries(boundaries);
            Array<double> found;
            for (const FaceBoundary* boundary : boundaries)
                found.push_back(fewest_triangles(*boundary));
            return view(found);
        },
        nb::arg("boundaries"), "Within each of them (f,) when no node lies inside.");
    m.def(
        "alike_faces",
        [](const std::vector<const FaceBoundary*>& boundaries, const Sizes& areas,
           const Ids& sorts) {
            require_boundaries(boundaries);
            require_rows(areas.shape(0), boundaries.size(), "areas");
            require_rows(sorts.shape(0), boundaries.size(), "sorts");
            const AlikeFaces found =
                alike_faces(boundaries, rows<double>(areas), rows<std::int64_t>(sorts));
            return std::tuple(view(found.fewest), view(found.size), view(found.first_of),
                              view(found.class_of));
        },
        nb::arg("boundaries"), nb::arg("areas"), nb::arg("sorts"),
        "Faces whose loops have as many segments, as long, with sizes as large, and areas (f,) as "
        "large, all to six digits, if their sorts (f,) int64 are the same.\n\nThe fewest triangles "
        "(f,), the mean size at the nodes (f,), infinite where there are none, and the number of "
        "the class (f,) int64, from 0 on as they come.");
}

void bind_shared_sides(nb::module_& m) {
    using Corners = Matrix<std::int32_t, 3>;
    const auto checked = [](const Corners& triangles, const Bytes& shared) {
        require_indices(std::span(triangles.data(), triangles.size()), shared.shape(0),
                        "triangles");
        return rows<TriangleCorners>(triangles);
    };
    m.def(
        "has_crowded_side",
        [checked](const Corners& triangles, const Bytes& shared) {
            const auto corners = checked(triangles, shared);
            const nb::gil_scoped_release released;
            return has_crowded_side(corners, rows<std::uint8_t>(shared));
        },
        nb::arg("triangles"), nb::arg("shared"),
        "Is a side between two shared vertices used by more than two triangles (m, 3)?\n\nshared: "
        "(n,) uint8, of the vertices.");
    m.def(
        "triangles_of_shared",
        [checked](const Corners& triangles, const Bytes& shared) {
            const auto corners = checked(triangles, shared);
            const auto found =
                released([&] { return triangles_of_shared(corners, rows<std::uint8_t>(shared)); });
            return view(found);
        },
        nb::arg("triangles"), nb::arg("shared"),
        "Numbers (k,) of the triangles (m, 3) whose corners are all shared.");
}

void bind_polygons(nb::module_& m) {
    nb::class_<FacePolygons>(m, "FacePolygons",
                             "Loops as closed polygons: each coedge without its last node.")
        .def(
            "__init__",
            [](FacePolygons* made, const Points2& uv, const Ids& numbers, const Points3& points,
               const Ids& slots, const Numbers& lengths) {
                require_finite(uv, "uv");
                require_rows(numbers.shape(0), uv.shape(0), "numbers");
                require_rows(points.shape(0), uv.shape(0), "points");
                require_rows(slots.shape(0), uv.shape(0), "slots");
                require_lengths(lengths, uv.shape(0));
                new (made) FacePolygons{copied<Point2>(uv), copied<std::int64_t>(numbers),
                                        copied<Point3>(points), copied<std::int64_t>(slots),
                                        copied<std::int32_t>(lengths)};
            },
            nb::arg("uv"), nb::arg("numbers"), nb::arg("points"), nb::arg("slots"),
            nb::arg("lengths"),
            "uv (n, 2), numbers (n,), points (n, 3) of the nodes; slots (n,): their rows in the "
            "boundary; lengths (l,): nodes of each loop.")
        .def_static(
            "of",
            [](const FaceBoundary& boundary) {
                if (boundary.has_degenerate())
                    throw nb::value_error("a degenerate coedge is not cut yet");
                return polygons_of(boundary);
            },
            nb::arg("boundary"), "Those of a boundary without degenerate coedges.");
}

}  // namespace

void bind_boundaries(nb::module_& m) {
    bind_boundary(m);
    bind_looks_at_a_face(m);
    bind_builder(m);
    bind_figures(m);
    bind_shared_sides(m);
    bind_polygons(m);
}

}  // namespace surfmesh::binding
