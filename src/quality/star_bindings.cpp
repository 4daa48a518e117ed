#include <nanobind/stl/array.h>

#include <array>

#include "quality/mesh_arguments.hpp"
#include "quality/triangle_stars.hpp"

namespace surfmesh::binding {

void bind_stars(nb::module_& m);

namespace {

/// With the arrays that they are of.
struct HeldStars : TriangleStars {
    HeldStars(const Points3& given_points, const Triangles& given_triangles)
        : TriangleStars(rows<Point3>(given_points), rows<TriangleCorners>(given_triangles)),
          held_points(given_points),
          held_triangles(given_triangles) {}

    Points3 held_points;
    Triangles held_triangles;
};

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

using VertexRows = nb::ndarray<const std::int32_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

auto distances_from_stars(const HeldStars& stars, const Points3& places,
                          const VertexRows& vertices) {
    require_rows(vertices.shape(0), places.shape(0), "vertices");
    require_indices(std::span(vertices.data(), vertices.size()), stars.vertices(), "vertices");
    const std::size_t count = vertices.shape(1);
    return number_of_each(places.shape(0), [&](std::size_t i) {
        return stars.from_stars(rows<Point3>(places)[i], {vertices.data() + i * count, count});
    });
}

}  // namespace

void bind_stars(nb::module_& m) {
    nb::class_<HeldStars>(m, "TriangleStars",
                          "The triangles at each vertex, and distances of points from them.")
        .def(
            "__init__",
            [](HeldStars* self, const Points3& points, const Triangles& triangles) {
                require_indices(std::span(triangles.data(), triangles.size()), points.shape(0),
                                "triangles");
                new (self) HeldStars(points, triangles);
            },
            nb::arg("points"), nb::arg("triangles"),
            "points (n, 3), triangles (m, 3): kept, not copied.")
        .def(
            "distances",
            [](const HeldStars& stars, const Points3& places, const Numbers& triangle) {
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
            [](const HeldStars& stars, const Points3& places, const Numbers& triangle,
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
            "distance_from_all",
            [](const HeldStars& stars, const std::array<double, 3>& place, double distance) {
                const nb::gil_scoped_release released;
                return stars.from_all({place[0], place[1], place[2]}, distance);
            },
            nb::arg("place"), nb::arg("distance"),
            "The less of the distance known of a place and that from all triangles.")
        .def("distances_from_stars", &distances_from_stars, nb::arg("places"), nb::arg("vertices"),
             "Distance (k,) of places (k, 3) from all triangles at vertices (k, j).");
}

}  // namespace surfmesh::binding
