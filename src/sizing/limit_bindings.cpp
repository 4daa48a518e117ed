#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>

#include <optional>

#include "binding/arrays.hpp"
#include "sizing/size_limits.hpp"

namespace surfmesh::binding {

void bind_size_limits(nb::module_& m);

namespace {

using Roots = Matrix<double, 6>;
using Directions = nb::ndarray<const double, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu>;
using SizeRows = nb::ndarray<nb::numpy, double, nb::ndim<2>>;

void construct(SizeLimits* made, const Points3& points, const Vector<double>& sizes, double slope,
               const std::optional<Roots>& metric_root_3d) {
    if (points.shape(0) == 0) throw nb::value_error("there are no points");
    require_rows(sizes.shape(0), points.shape(0), "sizes");
    std::span<const MetricRoot3> roots;
    if (metric_root_3d) {
        require_rows(metric_root_3d->shape(0), points.shape(0), "metric_root_3d");
        roots = rows<MetricRoot3>(*metric_root_3d);
    }
    const nb::gil_scoped_release released;
    new (made) SizeLimits(rows<Point3>(points), rows<double>(sizes), slope, roots);
}

SizeRows along(const SizeLimits& limits, const Points3& points, const Directions& directions) {
    require_rows(directions.shape(1), points.shape(0), "directions");
    const std::size_t count = points.shape(0);
    const auto* direction = reinterpret_cast<const Point3*>(directions.data());
    Array<double> found(directions.shape(0) * count);
    {
        const nb::gil_scoped_release released;
        for (std::size_t i = 0; i < found.size(); ++i)
            found[i] =
                SizeLimits::Here(limits, rows<Point3>(points)[i % count]).along(direction[i]);
    }
    const std::size_t shape[] = {directions.shape(0), count};
    return SizeRows(found.data(), 2, shape, nb::cast(view(found)));
}

}  // namespace

void bind_size_limits(nb::module_& m) {
    nb::class_<SizeLimits>(m, "SizeLimits", "Upper bounds of the size near points.")
        .def("__init__", &construct, nb::arg("points"), nb::arg("sizes"), nb::arg("slope"),
             nb::arg("metric_root_3d") = nb::none(),
             "points (k, 3), sizes (k,), metric_root_3d (k, 6) or None, for every direction.")
        .def(
            "at",
            [](const SizeLimits& limits, const Points3& points) {
                Array<double> found(points.shape(0));
                {
                    const nb::gil_scoped_release released;
                    for (std::size_t i = 0; i < found.size(); ++i)
                        found[i] = limits.at(rows<Point3>(points)[i]);
                }
                return view(found);
            },
            nb::arg("points"), "Largest size (n,) at points (n, 3).")
        .def("along", &along, nb::arg("points"), nb::arg("directions"),
             "Largest sizes (k, n) at points (n, 3) in k unit directions (k, n, 3).")
        .def(
            "tightest",
            [](const SizeLimits& limits, const Points3& points, const Points3& normals) {
                require_rows(normals.shape(0), points.shape(0), "normals");
                Array<double> sizes(points.shape(0));
                Array<Point3> directions(points.shape(0));
                {
                    const nb::gil_scoped_release released;
                    for (std::size_t i = 0; i < sizes.size(); ++i) {
                        const auto [size, direction] =
                            SizeLimits::Here(limits, rows<Point3>(points)[i])
                                .tightest(rows<Point3>(normals)[i]);
                        sizes[i] = size;
                        directions[i] = direction;
                    }
                }
                return std::pair(view(sizes), view(directions));
            },
            nb::arg("points"), nb::arg("normals"),
            "The smallest size (n,) in any direction of the tangent planes at points (n, 3) with "
            "unit normals (n, 3), and a unit direction (n, 3) it holds in.");
}

}  // namespace surfmesh::binding
