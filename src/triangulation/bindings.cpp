#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>

#include "binding/arrays.hpp"
#include "binding/loop_arguments.hpp"
#include "binding/released.hpp"
#include "triangulation/compaction.hpp"
#include "triangulation/exact_sums.hpp"
#include "triangulation/inside_loops.hpp"
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
        "exact_sum",
        [](const Vector<double>& mantissas, const Vector<std::int32_t>& exponents) {
            require_rows(exponents.shape(0), mantissas.shape(0), "exponents");
            Array<ScaledNumber> terms;
            for (std::size_t k = 0; k < mantissas.shape(0); ++k)
                terms.push_back({mantissas.data()[k], exponents.data()[k]});
            return exact_sum({terms.data(), terms.size()});
        },
        nb::arg("mantissas"), nb::arg("exponents"),
        "About the sum of mantissas 2**exponents (n,), at most 255; its sign is exact.");
    m.def(
        "inside_loops",
        [](const Points2& corners, const Vector<std::int64_t>& first, const Points2& points) {
            const PlaneLoops loops = plane_loops(corners, first);
            const auto found = released([&] { return inside_loops(loops, rows<Point2>(points)); });
            return view(found);
        },
        nb::arg("corners"), nb::arg("first"), nb::arg("points"),
        "1 for each of points (n, 2) within an odd number of loops, 0 for others and for those on "
        "a loop.\n\ncorners (m, 2), finite, of loop k from first[k] to first[k + 1], not closed.");
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
    m.attr("BLOCK") = SEGMENT_BLOCK;
    m.def(
        "find_meetings",
        [](const Points2& points, const Matrix<std::int64_t, 2>& segments,
           const Matrix<std::int64_t, 2>& pairs, double tolerance) {
            require_indices(std::span(segments.data(), segments.size()), points.shape(0),
                            "segments");
            require_indices(std::span(pairs.data(), pairs.size()), segments.shape(0), "pairs");
            const auto found = released([&] {
                return find_meetings(rows<Point2>(points), rows<SegmentEnds>(segments),
                                     rows<SegmentPair>(pairs), tolerance);
            });
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
            const auto found = released([&] {
                return distances(rows<Point3>(points), rows<Segment3>(segments), rows<Box3>(boxes),
                                 rows<Box3>(groups));
            });
            return view(found);
        },
        nb::arg("points"), nb::arg("segments"), nb::arg("boxes"), nb::arg("groups"),
        "Distance (n,) of each point (n, 3) to the nearest segment (s, 6), rows (start, end).\n\n"
        "boxes: (ceil(s / BLOCK), 6), rows (low, high) that bound BLOCK segments in a row. groups: "
        "the same for BLOCK boxes in a row.");
}

using Numbers = Vector<std::int32_t>;
using Bytes = Vector<std::uint8_t>;

/// Twins point back, run the other way along one edge, and agree about being fixed.
void require_twins(const Triangulation& t) {
    for (HalfEdge e = 0; e < 3 * t.triangles(); ++e) {
        const HalfEdge f = t.adj[e];
        if (f == NIL || t.region[e / 3] == DEAD) continue;
        if (t.region[f / 3] == DEAD || t.adj[f] != e)
            throw nb::value_error("adj has a twin that does not point back");
        if (t.tri[e] != t.tri[next_half_edge(f)] || t.tri[next_half_edge(e)] != t.tri[f])
            throw nb::value_error("adj has twins that do not share an edge");
        if (t.has_segments() && t.fixed[e] != t.fixed[f])
            throw nb::value_error("fixed differs for the two half-edges of an edge");
    }
}

/// A triangulation of given arrays, checked so far that no search in it leaves them.
Triangulation triangulation_of(const Points2& xy, const SizeTensors& size, const Numbers& tri,
                               const Numbers& adj, const Bytes& region, const Bytes& fixed) {
    const std::size_t half_edges = 3 * region.shape(0);
    require_rows(size.shape(0), xy.shape(0), "size");
    require_rows(tri.shape(0), half_edges, "tri");
    require_rows(adj.shape(0), half_edges, "adj");
    if (fixed.shape(0) > 0) require_rows(fixed.shape(0), half_edges, "fixed");
    Triangulation t;
    t.xy = Array<Point2>(rows<Point2>(xy));
    t.size = Array<SizeTensor>(rows<SizeTensor>(size));
    t.tri = Array<Vertex>(rows<Vertex>(tri));
    t.adj = Array<HalfEdge>(rows<HalfEdge>(adj));
    t.region = Array<Region>(rows<Region>(region));
    t.fixed = Array<std::uint8_t>(rows<std::uint8_t>(fixed));
    t.mark.resize(region.shape(0), 0);
    for (HalfEdge e = 0; e < 3 * t.triangles(); ++e) {
        if (t.tri[e] < NIL || t.tri[e] >= t.vertices())
            throw nb::value_error("tri has a vertex that is out of range");
        if (t.adj[e] < NIL || t.adj[e] >= 3 * t.triangles())
            throw nb::value_error("adj has a half-edge that is out of range");
    }
    require_twins(t);
    return t;
}

/// Refuse what is no half-edge of a live triangle.
void require_half_edge(const Triangulation& t, HalfEdge e) {
    if (e < 0 || e >= 3 * t.triangles() || t.region[e / 3] == DEAD)
        throw nb::value_error("there is no such half-edge");
}

/// Refuse a triangulation with a border: searches are at home in the whole plane.
void require_whole_plane(const Triangulation& t) {
    for (HalfEdge e = 0; e < 3 * t.triangles(); ++e)
        if (t.adj[e] == NIL && t.region[e / 3] != DEAD)
            throw nb::value_error("a half-edge has no twin: the triangulation has a border");
}

/// Insert a vertex at p, found from half-edge ``start``: its number, or NIL where p cannot be had.
Vertex insert_vertex(Triangulation& t, HalfEdge start, Point2 p, SizeTensor h, bool wide) {
    const Location place = locate(t, start, p, true);
    if (place.barrier != NIL || !open_cavity(t, place.triangle, p, h, wide)) return NIL;
    const Vertex v = t.add_vertex(p, h);
    fill_cavity(t, v);
    return v;
}

void bind_searches(nb::class_<Triangulation>& c) {
    c.def(
        "locate",
        [](const Triangulation& t, HalfEdge start, double x, double y, bool stop) {
            require_half_edge(t, start);
            require_whole_plane(t);
            const Location found = locate(t, start, {x, y}, stop);
            return std::pair(found.triangle, found.barrier);
        },
        nb::arg("start"), nb::arg("x"), nb::arg("y"), nb::arg("stop") = false,
        "Walk from a half-edge to the triangle of (x, y): the triangle, and NIL or, with "
        "``stop``, the barrier that is in the way.");
    c.def(
        "insert_vertex",
        [](Triangulation& t, HalfEdge start, double x, double y, std::array<double, 3> h,
           bool wide) {
            require_half_edge(t, start);
            require_whole_plane(t);
            return insert_vertex(t, start, {x, y}, {h[0], h[1], h[2]}, wide);
        },
        nb::arg("start"), nb::arg("x"), nb::arg("y"), nb::arg("size"), nb::arg("wide") = true,
        "Insert a vertex at (x, y) with size tensor (h11, h12, h22), found from a half-edge.\n\n"
        "``wide``: its star takes the triangles whose metric circumcircle holds it. Returns the "
        "vertex, or NIL where a barrier is in the way or no valid star can be made.");
}

void bind_local_operations(nb::class_<Triangulation>& c) {
    c.def(
        "is_convex",
        [](const Triangulation& t, HalfEdge e) {
            require_half_edge(t, e);
            return is_convex(t, e);
        },
        nb::arg("e"), "Can e be swapped: is its quadrilateral strictly convex at both ends of e?");
    c.def(
        "swap_edge",
        [](Triangulation& t, HalfEdge e) {
            require_half_edge(t, e);
            if (!is_convex(t, e)) throw nb::value_error("the quadrilateral of e is not convex");
            swap_edge(t, e);
        },
        nb::arg("e"), "Replace the edge a-b by c-d; the two triangles keep their slots.");
    c.def(
        "remove_vertex",
        [](Triangulation& t, HalfEdge e) {
            require_half_edge(t, e);
            if (!t.has_segments()) throw nb::value_error("the triangulation has no ``fixed``");
            return t.tri[e] == NIL ? NIL : remove_vertex(t, e);
        },
        nb::arg("e"),
        "Remove the vertex at the start of e: a half-edge of the new triangles, or NIL where it "
        "cannot go. Two slots go DEAD.");
}

void bind_triangulation_class(nb::module_& m) {
    nb::class_<Triangulation> c(
        m, "Triangulation",
        "A triangulation in flat arrays. Arrays are views: they go stale where it grows.");
    c.def(nb::new_(&triangulation_of), nb::arg("xy"), nb::arg("size"), nb::arg("tri"),
          nb::arg("adj"), nb::arg("region"), nb::arg("fixed"));
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
    bind_searches(c);
    bind_local_operations(c);
}

}  // namespace

void bind_triangulation(nb::module_& m) {
    m.doc() = "The triangulation of the plane, its predicates, and its local changes.";
    m.attr("TODO") = TODO;
    m.attr("DONE") = DONE;
    m.attr("INSIDE") = INSIDE;
    m.attr("DEAD") = DEAD;
    bind_predicates(m);
    bind_segments(m);
    bind_triangulation_class(m);
}

}  // namespace surfmesh::binding
