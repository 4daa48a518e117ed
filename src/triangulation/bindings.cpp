#include <nanobind/stl/pair.h>

#include "binding/arrays.hpp"
#include "triangulation/compaction.hpp"
#include "triangulation/local_operations.hpp"
#include "triangulation/predicates.hpp"
#include "triangulation/segments.hpp"
#include "triangulation/triangulation.hpp"

namespace surfmesh::binding {
namespace {

void bind_predicates(nb::module_& m) {
    m.def(
        "orient",
        [](double ax, double ay, double bx, double by, double cx, double cy) {
            return orient({ax, ay}, {bx, by}, {cx, cy});
        },
        nb::arg("ax"), nb::arg("ay"), nb::arg("bx"), nb::arg("by"), nb::arg("cx"), nb::arg("cy"),
        "Twice the signed area of abc; its sign is exact: > 0 for counter-clockwise.");
    m.def(
        "first_not_ccw",
        [](const Points2& xy, const Matrix<std::int64_t, 3>& triangles) {
            const std::span<const std::int64_t> corners{triangles.data(), triangles.size()};
            require_indices(corners, xy.shape(0), "triangles");
            const nb::gil_scoped_release released;
            return first_not_ccw(rows<Point2>(xy), corners);
        },
        nb::arg("xy"), nb::arg("triangles"),
        "The first of the triangles (m, 3) that is not counter-clockwise, or -1; judged exactly.");
}

void bind_segments(nb::module_& m) {
    m.attr("CROSSING") = CROSSING;
    m.attr("BLOCK") = BLOCK;
    m.def(
        "find_meetings",
        [](const Points2& points, const Matrix<std::int64_t, 2>& segments,
           const Matrix<std::int64_t, 2>& pairs, double tolerance) {
            require_indices(std::span(segments.data(), segments.size()), points.shape(0),
                            "segments");
            require_indices(std::span(pairs.data(), pairs.size()), segments.shape(0), "pairs");
            Meetings found;
            {
                const nb::gil_scoped_release released;
                found = find_meetings(rows<Point2>(points), rows<SegmentEnds>(segments),
                                      rows<SegmentPair>(pairs), tolerance);
            }
            return std::pair(view(found.flags), view(found.places));
        },
        nb::arg("points"), nb::arg("segments"), nb::arg("pairs"), nb::arg("tolerance"),
        "How the segments of each pair meet: flags (k,), and places (k, 2), nan where they do not "
        "cross.\n\nFlags of a pair ab, cd: 1 a near cd, 2 b near cd, 4 c near ab, 8 d near ab, "
        "CROSSING.");
    m.def(
        "distances",
        [](const Points3& points, const Matrix<double, 6>& segments, const Matrix<double, 6>& boxes,
           const Matrix<double, 6>& groups) {
            if (segments.shape(0) == 0) throw nb::value_error("there are no segments");
            Array<double> found;
            {
                const nb::gil_scoped_release released;
                found = distances(rows<Point3>(points), rows<Segment3>(segments), rows<Box3>(boxes),
                                  rows<Box3>(groups));
            }
            return view(found);
        },
        nb::arg("points"), nb::arg("segments"), nb::arg("boxes"), nb::arg("groups"),
        "Distance (n,) of each point (n, 3) to the nearest segment (s, 6), rows (start, end).\n\n"
        "boxes: (ceil(s / BLOCK), 6), rows (low, high) that bound BLOCK segments in a row. groups: "
        "the same for BLOCK boxes in a row.");
}

/// A property that gives an array of the triangulation as a view.
template <class T>
void bind_array(nb::class_<Triangulation>& c, const char* name, Array<T> Triangulation::* member,
                const char* doc) {
    c.def_prop_ro(name, [member](const Triangulation& t) { return view(t.*member); }, doc);
}

void bind_triangulation_class(nb::module_& m) {
    nb::class_<Triangulation> c(
        m, "Triangulation",
        "A triangulation in flat arrays. Arrays are views: they go stale where it grows.");
    bind_array(c, "xy", &Triangulation::xy, "(vertices, 2)");
    bind_array(c, "size", &Triangulation::size, "(vertices, 3): size tensors H");
    bind_array(c, "tri", &Triangulation::tri, "(3 triangles,) vertices, NIL in a ghost triangle");
    bind_array(c, "adj", &Triangulation::adj, "(3 triangles,) twin half-edges");
    bind_array(c, "region", &Triangulation::region, "(triangles,)");
    bind_array(c, "fixed", &Triangulation::fixed,
               "(3 triangles,), or (0,) while there are no segments");
    c.def_prop_ro("vertices", &Triangulation::vertices, "How many vertices there are.");
    c.def_prop_ro("triangles", &Triangulation::triangles,
                  "How many triangles there are, dead ones included.");
}

}  // namespace

void bind_triangulation(nb::module_& m) {
    m.doc() = "The triangulation of the plane, its predicates, and its local changes.";
    m.attr("TODO") = TODO;
    m.attr("DONE") = DONE;
    m.attr("OUTSIDE") = OUTSIDE;
    m.attr("INSIDE") = INSIDE;
    m.attr("DEAD") = DEAD;
    bind_predicates(m);
    bind_segments(m);
    bind_triangulation_class(m);
}

}  // namespace surfmesh::binding
