#include <nanobind/stl/tuple.h>

#include <tuple>
#include <vector>

#include "binding/arrays.hpp"
#include "quality/mesh_deviation.hpp"
#include "quality/solid_counts.hpp"
#include "quality/surface_points.hpp"
#include "quality/triangle_stars.hpp"
#include "surfaces/callback_surface.hpp"

namespace surfmesh::binding {

template <>
struct Row<float> : RowOf<float, 1> {};

namespace {

using Triangles = Matrix<std::int32_t, 3>;
using Numbers = Vector<std::int32_t>;

std::vector<const Surface*> surfaces_of(const nb::list& given) {
    std::vector<const Surface*> surfaces;
    surfaces.reserve(given.size());
    for (const nb::handle surface : given) surfaces.push_back(&nb::cast<const Surface&>(surface));
    return surfaces;
}

void require_corners(const Triangles& triangles, std::size_t count, const char* what) {
    require_indices(std::span(triangles.data(), triangles.size()), count, what);
}

/// A number of each of so many things, found with the interpreter released.
template <class Work>
auto number_of_each(std::size_t count, const Work& work) {
    Array<double> found(count);
    {
        const nb::gil_scoped_release released;
        for (std::size_t i = 0; i < count; ++i) found[i] = work(i);
    }
    return view(found);
}

void bind_surface_points(nb::module_& m) {
    m.def(
        "surface_points",
        [](const nb::list& surfaces, const Numbers& faces, const Points2& uv, int order) {
            if (order < 0 || order > 1) throw nb::value_error("order is 0 or 1");
            const std::vector<const Surface*> all = surfaces_of(surfaces);
            require_indices(rows<std::int32_t>(faces), all.size(), "faces");
            require_rows(uv.shape(0), faces.shape(0), "uv");
            SurfacePoints found;
            {
                const nb::gil_scoped_release released;
                found = surface_points(all, rows<std::int32_t>(faces), rows<Point2>(uv), order);
            }
            if (found.failed >= 0) raise_failure(*all[found.failed], SurfaceStatus::FAILED);
            nb::list values;
            for (const Array<Point3>& array : found.values) values.append(view(array));
            return nb::tuple(values);
        },
        nb::arg("surfaces"), nb::arg("faces"), nb::arg("uv"), nb::arg("order"),
        "Points (n, 3) of the surfaces of faces (n,) at uv (n, 2); at order 1 r_u and r_v too.");
}

void bind_mesh_deviation(nb::module_& m) {
    m.def(
        "mesh_deviation",
        [](const nb::list& surfaces, const Points3& points, const Triangles& triangles,
           const Points2& uv, const Triangles& uv_triangles, const Numbers& faces,
           const Matrix<std::int32_t, 2>& edges, const Vector<double>& area) {
            const std::vector<const Surface*> all = surfaces_of(surfaces);
            const std::size_t count = triangles.shape(0);
            require_corners(triangles, points.shape(0), "triangles");
            require_rows(uv_triangles.shape(0), count, "uv_triangles");
            require_corners(uv_triangles, uv.shape(0), "uv_triangles");
            require_rows(faces.shape(0), count, "faces");
            require_indices(rows<std::int32_t>(faces), all.size(), "faces");
            require_rows(area.shape(0), count, "area");
            const std::span<const EdgeSides> sides{reinterpret_cast<const EdgeSides*>(edges.data()),
                                                   edges.shape(0)};
            for (const EdgeSides& side : sides) {
                const auto end = static_cast<std::int64_t>(3 * count);
                if (side.half_edge < 0 || side.half_edge >= end || side.twin < -1 ||
                    side.twin >= end)
                    throw nb::value_error("edges has a half-edge that is out of range");
            }
            const MeasuredMesh mesh{all,
                                    rows<Point3>(points),
                                    rows<TriangleCorners>(triangles),
                                    rows<Point2>(uv),
                                    rows<TriangleCorners>(uv_triangles),
                                    rows<std::int32_t>(faces)};
            MeshDeviation found;
            {
                const nb::gil_scoped_release released;
                found = mesh_deviation(mesh, sides, rows<double>(area));
            }
            if (found.failed >= 0) raise_failure(*all[found.failed], SurfaceStatus::FAILED);
            return std::tuple(view(found.largest), view(found.mean_square), view(found.cosine));
        },
        nb::arg("surfaces"), nb::arg("points"), nb::arg("triangles"), nb::arg("uv"),
        nb::arg("uv_triangles"), nb::arg("faces"), nb::arg("edges"), nb::arg("area"),
        "Of triangles (m, 3) with uv_triangles (m, 3), rows of points (n, 3) and uv (q, 2), on "
        "the surfaces of faces (m,): the largest distance (m,) at vertices, middles and centroid, "
        "the mean of its square (m,), the cosine (m,) between the normals, 1 where one is missing."
        "\n\nedges (k, 2): half-edges and those that share what is found, or -1; area (m,).");
}

void bind_stars(nb::module_& m) {
    nb::class_<TriangleStars>(m, "TriangleStars",
                              "The triangles at each vertex, and distances of points from them.")
        .def(
            "__init__",
            [](TriangleStars* self, const Points3& points, const Triangles& triangles) {
                require_corners(triangles, points.shape(0), "triangles");
                new (self) TriangleStars(rows<Point3>(points), rows<TriangleCorners>(triangles));
            },
            nb::arg("points"), nb::arg("triangles"), "points (n, 3), triangles (m, 3): copied.")
        .def(
            "distances",
            [](const TriangleStars& stars, const Points3& places, const Numbers& triangle) {
                require_rows(triangle.shape(0), places.shape(0), "triangle");
                require_indices(rows<std::int32_t>(triangle), stars.triangles(), "triangle");
                return number_of_each(places.shape(0), [&](std::size_t i) {
                    return stars.from(rows<Point3>(places)[i], triangle.data()[i]);
                });
            },
            nb::arg("places"), nb::arg("triangle"),
            "Distance (k,) of places (k, 3) from one triangle each (k,).")
        .def(
            "walk",
            [](const TriangleStars& stars, const Points3& places, const Numbers& triangle,
               const Vector<double>& distance) {
                require_rows(triangle.shape(0), places.shape(0), "triangle");
                require_rows(distance.shape(0), places.shape(0), "distance");
                require_indices(rows<std::int32_t>(triangle), stars.triangles(), "triangle");
                return number_of_each(places.shape(0), [&](std::size_t i) {
                    return stars.walk(rows<Point3>(places)[i], triangle.data()[i],
                                      distance.data()[i]);
                });
            },
            nb::arg("places"), nb::arg("triangle"), nb::arg("distance"),
            "The least of the distances (k,) known of places (k, 3) and those from the triangles "
            "that are met from triangle (k,) on, from neighbour to nearer neighbour.")
        .def(
            "distances_from_stars",
            [](const TriangleStars& stars, const Points3& places,
               const nb::ndarray<const std::int32_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>&
                   vertices) {
                require_rows(vertices.shape(0), places.shape(0), "vertices");
                require_indices(std::span(vertices.data(), vertices.size()), stars.vertices(),
                                "vertices");
                const std::size_t count = vertices.shape(1);
                return number_of_each(places.shape(0), [&](std::size_t i) {
                    return stars.from_stars(rows<Point3>(places)[i],
                                            {vertices.data() + i * count, count});
                });
            },
            nb::arg("places"), nb::arg("vertices"),
            "Distance (k,) of places (k, 3) from all triangles at vertices (k, j).");
}

void bind_solids(nb::module_& m) {
    m.def(
        "solid_counts",
        [](const Triangles& triangles, const Numbers& solid, std::size_t vertices,
           std::size_t solids) {
            require_corners(triangles, vertices, "triangles");
            require_rows(solid.shape(0), triangles.shape(0), "solid");
            require_indices(rows<std::int32_t>(solid), solids, "solid");
            SolidCounts found;
            {
                const nb::gil_scoped_release released;
                found = solid_counts(rows<TriangleCorners>(triangles), rows<std::int32_t>(solid),
                                     vertices, solids);
            }
            return std::tuple(view(found.vertices), view(found.edges), view(found.open_edges));
        },
        nb::arg("triangles"), nb::arg("solid"), nb::arg("vertices"), nb::arg("solids"),
        "Vertices, edges and open edges (s,) of each of so many solids, by triangles (k, 3) around "
        "solid (k,), facing outwards.\n\nAn edge is open where it is not run along as often one "
        "way as the other.");
}

}  // namespace

void bind_quality(nb::module_& m) {
    m.doc() = "What a report measures of a finished mesh: its distance from its surfaces and back.";
    bind_surface_points(m);
    bind_mesh_deviation(m);
    bind_stars(m);
    bind_solids(m);
}

}  // namespace surfmesh::binding
