#include <nanobind/stl/tuple.h>

#include <tuple>
#include <vector>

#include "quality/segment_arguments.hpp"

namespace surfmesh::binding {

void bind_segments(nb::module_& m);

void bind_segments(nb::module_& m) {
    m.def(
        "segment_samples",
        [](const nb::list& curves, const Matrix<double, 2>& limits, const Numbers& edges,
           const Matrix<double, 2>& ends, const Matrix<std::int32_t, 2>& segments,
           const Points3& points, const Vector<double>& fractions, double on_curve) {
            const std::vector<const Curve*> known = curves_of(curves);
            const EdgeSegments all = edge_segments(known, limits, edges, ends, segments, points);
            require_indices(rows<std::int32_t>(edges), known.size(), "edges");
            SegmentSamples found;
            {
                const nb::gil_scoped_release released;
                found = segment_samples(all, rows<double>(fractions), on_curve);
            }
            return std::tuple(view(found.segments), view(found.points), view(found.off_arc));
        },
        nb::arg("curves"), nb::arg("limits"), nb::arg("edges"), nb::arg("ends"),
        nb::arg("segments"), nb::arg("points"), nb::arg("fractions"), nb::arg("on_curve"),
        "Which segments (g,) may lie off the curves of their edges, and points (g j, 3) of these "
        "at fractions (j,) of the way; and how far (g,) their nodes are from the curve where it is "
        "an ellipse and they are at most half a turn apart, else infinity.\n\ncurves: of the "
        "edges, None without one, from limits (e, 2) to limits; edges (k,) of the segments (k, 2), "
        "rows of points (n, 3), with ends (k, 2), "
        "fractions along the edge. Left out: segments on lines, and those whose nodes are farther "
        "from the curve than ``on_curve`` of their length.");
}

}  // namespace surfmesh::binding
