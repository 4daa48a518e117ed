#include <nanobind/stl/array.h>
#include <nanobind/stl/tuple.h>

#include "binding/arrays.hpp"
#include "binding/released.hpp"
#include "surfaces/callback_surface.hpp"
#include "surfaces/closest_point.hpp"
#include "surfaces/coincident_sides.hpp"
#include "surfaces/sharp_bends.hpp"

namespace surfmesh::binding {
namespace {

using ParameterTriangles =
    nb::ndarray<const double, nb::shape<-1, 3, 2>, nb::c_contig, nb::device::cpu>;

auto arrays_of(const ClosestPoints& found) {
    return std::tuple(view(found.uv), view(found.distance), view(found.foot));
}

void bind_coincident_sides(nb::module_& m) {
    m.attr("SAME_SIDE") = SAME_SIDE;
    m.def(
        "coincident_sides",
        [](const Surface& surface, const std::array<double, 4>& rounding) {
            SurfaceReader reader(surface);
            const auto found = released([&] { return coincident_sides(reader, rounding); });
            raise_failure(surface, reader.status());
            return std::tuple(found.collapsed, found.partner, found.reversed);
        },
        nb::arg("surface"), nb::arg("rounding"),
        "Of the four sides of a surface's domain, numbered as Python's ``sides``: is it one point "
        "in space, the side that it coincides with or -1, does it run against that.\n\nrounding: "
        "how far the rounding of a parameter moves each of them, a fraction of the surface.");
}

void bind_closest_points(nb::module_& m) {
    m.attr("PROJECTION_MARGIN") = PROJECTION_MARGIN;
    m.def(
        "closest_points",
        [](const Surface& surface, const Points3& points, const Points2& uv_guess, int steps,
           double margin) {
            require_rows(uv_guess.shape(0), points.shape(0), "uv_guess");
            if (steps < 1) throw nb::value_error("steps is at least 1");
            SurfaceReader reader(surface);
            const auto found = released([&] {
                return closest_points(reader, rows<Point3>(points), rows<Point2>(uv_guess), steps,
                                      margin);
            });
            raise_failure(surface, reader.status());
            return arrays_of(found);
        },
        nb::arg("surface"), nb::arg("points"), nb::arg("uv_guess"), nb::arg("steps") = 2,
        nb::arg("margin") = PROJECTION_MARGIN,
        "Nearest points of a surface to points (n, 3), from guesses (n, 2), never farther.\n\n"
        "margin: fraction of the domain by which they may leave it. Returns uv (n, 2), distance "
        "(n,), foot (n, 3).\nThe search is local: a nearer part of the surface that the guess does "
        "not lead to is not found.");
    m.def(
        "closest_points_in_triangles",
        [](const Surface& surface, const Points3& points, const Points2& uv,
           const ParameterTriangles& corners, const Vector<std::int64_t>& triangle, double limit,
           int steps) {
            require_rows(uv.shape(0), points.shape(0), "uv");
            require_rows(triangle.shape(0), points.shape(0), "triangle");
            require_indices(rows<std::int64_t>(triangle), corners.shape(0), "triangle");
            if (steps < 1) throw nb::value_error("steps is at least 1");
            SurfaceReader reader(surface);
            const auto found = released([&] {
                return closest_points_in_triangles(
                    reader, rows<Point3>(points), rows<Point2>(uv),
                    {reinterpret_cast<const ParameterTriangle*>(corners.data()), corners.shape(0)},
                    rows<std::int64_t>(triangle), limit, steps);
            });
            raise_failure(surface, reader.status());
            return std::tuple(view(found.uv), view(found.distance));
        },
        nb::arg("surface"), nb::arg("points"), nb::arg("uv"), nb::arg("corners"),
        nb::arg("triangle"), nb::arg("limit"), nb::arg("steps"),
        "Parameters (n, 2) of the nearest points of the surface, and the distances (n,).\n\n"
        "uv: (n, 2) first guesses. corners: (m, 3, 2) of triangles and ``triangle`` (n,) that of "
        "each point: the search begins anew from them where a point seems farther away than "
        "``limit``.");
}

}  // namespace

void bind_surface_searches(nb::module_& m) {
    bind_coincident_sides(m);
    bind_closest_points(m);
    m.def(
        "bends_sharply",
        [](const Surface& surface, const ParameterTriangles& triangles, double radius) {
            SurfaceReader reader(surface);
            const auto found = released([&] {
                return bends_sharply(reader,
                                     {reinterpret_cast<const ParameterTriangle*>(triangles.data()),
                                      triangles.shape(0)},
                                     radius);
            });
            raise_failure(surface, reader.status());
            return view(found);
        },
        nb::arg("surface"), nb::arg("triangles"), nb::arg("radius"),
        "Does the surface bend with less than ``radius`` (model units) within triangles (k, 3, 2) "
        "of (u, v)? (k,) of 0 and 1.\n\nBends are found where the curvature of a sample shows "
        "them, or where the normals of two samples differ.");
}

}  // namespace surfmesh::binding
