#include <nanobind/stl/pair.h>

#include "binding/arrays.hpp"
#include "patch/deviation.hpp"
#include "patch/folds.hpp"
#include "patch/limits.hpp"
#include "patch/samples.hpp"
#include "surfaces/callback_surface.hpp"

namespace surfmesh::binding {

template <>
struct Row<BarycentricWeights> : RowOf<double, 3> {};

namespace {

using SpaceTriangles =
    nb::ndarray<const double, nb::shape<-1, 3, 3>, nb::c_contig, nb::device::cpu>;
using PlaneTriangles =
    nb::ndarray<const double, nb::shape<-1, 3, 2>, nb::c_contig, nb::device::cpu>;

template <class T, class Given>
std::span<const T> shaped_rows(const Given& array) {
    return {reinterpret_cast<const T*>(array.data()), array.shape(0)};
}

/// What a measure of a surface gives, with the interpreter released; what the surface raises.
template <class Measure>
auto measured(const Surface& surface, Measure measure) {
    SurfaceReader reader(surface);
    auto found = [&] {
        const nb::gil_scoped_release released;
        return measure(reader);
    }();
    raise_failure(surface, reader.status());
    return found;
}

void bind_deviations(nb::module_& m) {
    m.def(
        "point_deviations",
        [](const Surface& surface, const Points3& points, const Points2& uv,
           const Vector<double>& size) {
            require_rows(uv.shape(0), points.shape(0), "uv");
            require_rows(size.shape(0), points.shape(0), "size");
            const PointDeviations found = measured(surface, [&](SurfaceReader& reader) {
                return point_deviations(reader, rows<Point3>(points), rows<Point2>(uv),
                                        rows<double>(size));
            });
            return std::pair(view(found.distance), view(found.normal));
        },
        nb::arg("surface"), nb::arg("points"), nb::arg("uv"), nb::arg("size"),
        "Distances (n,) of points (n, 3) from the surface, and its normals (n, 3) near them.\n\n"
        "uv: (n, 2) parameters of a surface point nearby; size: (n,) of the triangle. Read in the "
        "tangent plane where the foot is near, else in the one a Newton step further, else by "
        "projection.");
    m.def(
        "vertex_deviations",
        [](const Surface& surface, const Points3& points, const Points2& uv,
           const Vector<double>& size) {
            require_rows(uv.shape(0), points.shape(0), "uv");
            require_rows(size.shape(0), points.shape(0), "size");
            return view(measured(surface, [&](SurfaceReader& reader) {
                return vertex_deviations(reader, rows<Point3>(points), rows<Point2>(uv),
                                         rows<double>(size));
            }));
        },
        nb::arg("surface"), nb::arg("points"), nb::arg("uv"), nb::arg("size"),
        "The same (n,) of points that should be r(u, v) itself: looked at closely only if not.");
    m.def(
        "triangle_deviations",
        [](const Surface& surface, const Chart& chart, const SpaceTriangles& corners,
           const PlaneTriangles& xy, double limit) {
            require_rows(xy.shape(0), corners.shape(0), "xy");
            return view(measured(surface, [&](SurfaceReader& reader) {
                return triangle_deviations(reader, chart, shaped_rows<SpaceTriangle>(corners),
                                           shaped_rows<PlaneTriangle>(xy), limit);
            }));
        },
        nb::arg("surface"), nb::arg("chart"), nb::arg("corners"), nb::arg("xy"), nb::arg("limit"),
        "Largest distance (n,) from the surface at samples of triangles (n, 3, 3) with corners on "
        "it.\n\nxy: (n, 3, 2) the corners in the plane of ``chart``. Four samples each, read in "
        "the tangent planes; where these come near to ``limit``, the samples of the report, each "
        "with its nearest point.");
}

}  // namespace

void bind_accuracy(nb::module_& m) {
    m.attr("LEAST_OF_CHORD") = LEAST_OF_CHORD;
    m.def(
        "dense_samples", [] { return view(Array<BarycentricWeights>(std::span(DENSE_SAMPLES))); },
        "Barycentric places (25, 3) at which the mesher looks at triangles that are nearly too "
        "far: those of the report without the corners, which lie on the surface.");
    bind_deviations(m);
    m.def(
        "cosines_with_surface",
        [](const Surface& surface, const SpaceTriangles& corners, const Points2& uv) {
            require_rows(uv.shape(0), corners.shape(0), "uv");
            return view(measured(surface, [&](SurfaceReader& reader) {
                return cosines_with_surface(reader, shaped_rows<SpaceTriangle>(corners),
                                            rows<Point2>(uv));
            }));
        },
        nb::arg("surface"), nb::arg("corners"), nb::arg("uv"),
        "Of the angles (n,) between triangles (n, 3, 3) and the surface's normals at uv (n, 2).\n\n"
        "NaN where there is no normal.");
}

}  // namespace surfmesh::binding
