#include "quality/least_triangles.hpp"

#include <nanobind/stl/tuple.h>

#include <tuple>

#include "quality/mesh_arguments.hpp"

namespace surfmesh::binding {

void bind_least_triangles(nb::module_& m);

void bind_least_triangles(nb::module_& m) {
    m.def(
        "least_triangles",
        [](const nb::list& surfaces, const Points3& points, const Triangles& triangles,
           const Points2& uv, const Triangles& uv_triangles, const Numbers& faces,
           const Matrix<std::int32_t, 2>& edges, const Vector<double>& area,
           const Vector<double>& chord, const Vector<std::uint8_t>& corner, bool balanced) {
            const std::vector<const Surface*> all = surfaces_of(surfaces);
            const MeasuredMesh mesh =
                measured_mesh(all, points, triangles, uv, uv_triangles, faces);
            require_mesh(mesh);
            require_rows(area.shape(0), mesh.triangles.size(), "area");
            require_rows(chord.shape(0), all.size(), "chord");
            require_rows(corner.shape(0), mesh.points.size(), "corner");
            const std::span<const EdgeSides> sides = sides_of(edges, mesh.triangles.size());
            LeastTriangles found;
            {
                const nb::gil_scoped_release released;
                found = least_triangles(
                    mesh, sides, rows<double>(area),
                    {rows<double>(chord), {corner.data(), corner.size()}, balanced});
            }
            if (found.failed >= 0) raise_failure(*all[found.failed], SurfaceStatus::FAILED);
            return std::tuple(view(found.least), view(found.equilateral));
        },
        nb::arg("surfaces"), nb::arg("points"), nb::arg("triangles"), nb::arg("uv"),
        nb::arg("uv_triangles"), nb::arg("faces"), nb::arg("edges"), nb::arg("area"),
        nb::arg("chord"), nb::arg("corner"), nb::arg("balanced"),
        "The fewest triangles (f,) that the chord (f,) of each face allows, whatever their shape, "
        "and the fewest equilateral ones (f,).\n\nThe mesh is as for ``mesh_deviation``; edges "
        "(k, 2): both sides of every edge, or -1; area (m,); corner (n,): 1 where the lines around "
        "faces end. balanced: vertices may lie off the surface.");
}

}  // namespace surfmesh::binding
