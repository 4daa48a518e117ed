#include <nanobind/stl/tuple.h>

#include <array>
#include <tuple>

#include "binding/arrays.hpp"
#include "binding/released.hpp"
#include "quality/corner_places.hpp"
#include "quality/histogram.hpp"
#include "quality/largest_values.hpp"
#include "quality/mesh_arguments.hpp"
#include "quality/solid_boxes.hpp"
#include "quality/spread.hpp"

namespace surfmesh::binding {

namespace {

void require_vertices(const Triangles& triangles, std::size_t count, const char* what) {
    require_indices(std::span(triangles.data(), triangles.size()), count, what);
}

void bind_places(nb::module_& m) {
    m.def(
        "solid_boxes",
        [](const Points3& points, const Triangles& triangles, const Matrix<std::int32_t, 2>& solids,
           std::size_t count) {
            require_vertices(triangles, points.shape(0), "triangles");
            require_rows(solids.shape(0), triangles.shape(0), "solids");
            for (const std::int32_t solid : std::span(solids.data(), solids.size()))
                if (solid >= static_cast<std::int64_t>(count))
                    throw nb::value_error("solids has an index that is out of range");
            const std::span<const std::array<std::int32_t, 2>> beside{
                reinterpret_cast<const std::array<std::int32_t, 2>*>(solids.data()),
                solids.shape(0)};
            SolidBoxes found;
            {
                const nb::gil_scoped_release released;
                found = solid_boxes(rows<Point3>(points), rows<TriangleCorners>(triangles), beside,
                                    count);
            }
            return std::tuple(view(found.low), view(found.high));
        },
        nb::arg("points"), nb::arg("triangles"), nb::arg("solids"), nb::arg("count"),
        "The lowest and the highest coordinates (count, 3) of each solid, infinite without a "
        "triangle; solids (m, 2): behind and before each of triangles (m, 3), below 0 for none.");
    m.def(
        "corner_places",
        [](const Triangles& triangles, const Triangles& uv_triangles, std::size_t vertices,
           std::size_t places) {
            require_vertices(triangles, vertices, "triangles");
            require_vertices(uv_triangles, places, "uv_triangles");
            require_rows(uv_triangles.shape(0), triangles.shape(0), "uv_triangles");
            Array<std::int32_t> found;
            {
                const nb::gil_scoped_release released;
                found = corner_places(rows<TriangleCorners>(triangles),
                                      rows<TriangleCorners>(uv_triangles), vertices, places);
            }
            return view(found);
        },
        nb::arg("triangles"), nb::arg("uv_triangles"), nb::arg("vertices"), nb::arg("places"),
        "How many places of (u, v) each vertex (n,) has, by the corners of triangles (m, 3) and "
        "those of uv_triangles (m, 3).");
}

void bind_order(nb::module_& m) {
    m.def(
        "largest_values",
        [](const Vector<double>& values, std::size_t count) {
            Array<std::int32_t> found;
            {
                const nb::gil_scoped_release released;
                found = largest_values(rows<double>(values), count);
            }
            return view(found);
        },
        nb::arg("values"), nb::arg("count"),
        "Numbers of the ``count`` largest of values (n,), rising, or of all where there are no "
        "more; of equal ones those that come first. NaN is as large as infinity.");
    m.def(
        "least_values",
        [](const Vector<double>& values, std::size_t count) {
            return view(released([&] { return least_values(rows<double>(values), count); }));
        },
        nb::arg("values"), nb::arg("count"),
        "Numbers of the ``count`` least of values (n,), the least first; of equal ones those that "
        "come first. NaN is not among them.");
    m.def(
        "spread",
        [](const Vector<double>& values) {
            const nb::gil_scoped_release released;
            const Spread found = spread_of(rows<double>(values));
            return std::tuple(found.least, found.mean, found.largest, found.deviation);
        },
        nb::arg("values"),
        "Least, mean, largest and standard deviation of values (n,); NaN where one is, or none.");
    m.def(
        "quantile",
        [](const Vector<double>& values, double fraction) {
            if (values.shape(0) == 0) throw nb::value_error("values is empty");
            if (!(fraction >= 0.0 && fraction <= 1.0))
                throw nb::value_error("fraction is from 0 to 1");
            const nb::gil_scoped_release released;
            return quantile(rows<double>(values), fraction);
        },
        nb::arg("values"), nb::arg("fraction"),
        "As ``np.quantile`` has it, of values (n,), n > 0: linear between two of them in their "
        "order, NaN where one is.");
}

}  // namespace

void bind_figures(nb::module_& m) {
    bind_order(m);
    bind_places(m);
    m.def(
        "binned_counts",
        [](const Vector<double>& values, double low, double high, std::size_t bins) {
            if (!(low < high) || bins < 1) throw nb::value_error("there is no bin");
            Array<std::int64_t> counts;
            {
                const nb::gil_scoped_release released;
                counts = binned_counts(rows<double>(values), low, high, bins);
            }
            return view(counts);
        },
        nb::arg("values"), nb::arg("low"), nb::arg("high"), nb::arg("bins"),
        "How many of values (k,) lie in each of ``bins`` equal bins from low to high: others in "
        "those at the ends, what is not finite in none.");
}

}  // namespace surfmesh::binding
