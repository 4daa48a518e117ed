#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>

#include "binding/arrays.hpp"
#include "binding/released.hpp"
#include "optimisation/dihedral.hpp"
#include "optimisation/marked_triangles.hpp"
#include "optimisation/smoothing.hpp"
#include "optimisation/splits.hpp"
#include "optimisation/surface_frames.hpp"
#include "optimisation/swaps.hpp"
#include "optimisation/vertex_arguments.hpp"

namespace surfmesh::binding {

template <>
struct Row<HalfEdgePair> : RowOf<std::int32_t, 2> {};

void bind_frames(nb::module_& m);

namespace {

using Numbers = Vector<std::int32_t>;

/// Refuse frames that are not those of the triangulation, and one that is not of a domain.
void require_domain(const Triangulation& t, const SurfaceFrames& s) {
    require_rows(s.point.size(), t.xy.size(), "frames");
    if (!t.has_segments() && t.triangles() > 0)
        throw nb::value_error("the triangulation has no ``fixed``");
    for (HalfEdge e = 0; e < 3 * t.triangles(); ++e)
        if (t.tri[e] == NIL && t.region[e / 3] != DEAD)
            throw nb::value_error("the triangulation has a ghost triangle");
}

void require_stars(const Triangulation& t, const Stars& stars) {
    require_rows(stars.start.size(), t.xy.size(), "stars");
    for (Vertex v = 0; v < t.vertices(); ++v) {
        const HalfEdge e = stars.start[v];
        if (e == NIL) continue;
        if (e < 0 || e >= 3 * t.triangles() || t.tri[e] != v || t.region[e / 3] == DEAD)
            throw nb::value_error("stars are not those of the triangulation");
    }
}

void require_marks(const Triangulation& t, const VertexMarks& marks) {
    require_rows(marks.active.size(), t.xy.size(), "marks");
    require_rows(marks.dirty.size(), t.xy.size(), "marks");
}

void bind_marks(nb::module_& m) {
    nb::class_<Stars> stars(m, "Stars", "The star of each vertex of a domain.");
    stars.def(
        "__init__",
        [](Stars* made, const Triangulation& t) {
            require_domain(t, SurfaceFrames(t.xy.size(), false));
            find_stars(t, *new (made) Stars);
        },
        nb::arg("t"));
    bind_array(stars, "start", &Stars::start, "(vertices,): a half-edge that leaves it, or NIL");
    bind_array(stars, "frozen", &Stars::frozen, "(vertices,): on the border or a fixed edge");
    bind_array(stars, "degree", &Stars::degree, "(vertices,): how many triangles it has");
    nb::class_<VertexMarks> marks(m, "VertexMarks",
                                  "What the passes of the optimiser tell each other.");
    marks.def(nb::init<std::size_t>(), nb::arg("vertices"));
    bind_array(marks, "active", &VertexMarks::active,
               "(vertices,): smoothing and splits look at it");
    bind_array(marks, "dirty", &VertexMarks::dirty,
               "(vertices,): its triangles have changed since swaps last looked at them");
}

void bind_swaps(nb::module_& m) {
    m.def(
        "swap_for_shape",
        [](Triangulation& t, const SurfaceFrames& s, VertexMarks& marks, double good, int sweeps) {
            require_domain(t, s);
            require_marks(t, marks);
            Array<double> shape;
            const SwapsMade made = swap_for_shape(t, s, shape, nullptr, marks, good, sweeps);
            return std::pair(made.count, view(shape));
        },
        nb::arg("t"), nb::arg("frames"), nb::arg("marks"), nb::arg("good"), nb::arg("sweeps"),
        "Swap edges at dirty vertices while that raises the smaller alpha of the pair.\n\n"
        "Only of triangles below ``good``. Returns the swaps made, and alpha (triangles,) of those "
        "at dirty vertices, 1 for others.");
    m.def(
        "swap_for_degree",
        [](Triangulation& t, const SurfaceFrames& s, Stars& stars, VertexMarks& marks,
           double least) {
            require_domain(t, s);
            require_stars(t, stars);
            require_marks(t, marks);
            return swap_for_degree(t, s, stars, marks, least).count;
        },
        nb::arg("t"), nb::arg("frames"), nb::arg("stars"), nb::arg("marks"), nb::arg("least"),
        "Swap edges that bring the degrees of their four vertices nearer to six.\n\n"
        "Only where the new triangles are better than ``least``. Returns the swaps made.");
}

void bind_smoothing(nb::module_& m) {
    m.def(
        "newton_step",
        [](const Triangulation& t, const SurfaceFrames& s, const Stars& stars, Vertex v,
           double stiffness) {
            require_domain(t, s);
            require_stars(t, stars);
            require_vertex(s, v);
            if (stars.frozen[v] != 0 || stars.start[v] == NIL)
                throw nb::value_error("the vertex has no whole star");
            const NewtonStep found = newton_step(t, s, v, stars.start[v], stiffness);
            return std::tuple(found.step.x, found.step.y, found.worst);
        },
        nb::arg("t"), nb::arg("frames"), nb::arg("stars"), nb::arg("v"), nb::arg("stiffness"),
        "The step of v in its unit tangent plane that lowers the energy of its star.\n\n"
        "Returns x, y and the smallest alpha of the star, -1 where a triangle is turned over.");
    m.def(
        "smooth",
        [](Triangulation& t, SurfaceFrames& s, const Stars& stars, VertexMarks& marks,
           double stiffness) {
            require_domain(t, s);
            require_stars(t, stars);
            require_marks(t, marks);
            Array<Vertex> moved;
            smooth(t, s, stars, marks, stiffness, s.is_anisotropic ? STILL_STRETCHED : STILL,
                   moved);
            return view(moved);
        },
        nb::arg("t"), nb::arg("frames"), nb::arg("stars"), nb::arg("marks"), nb::arg("stiffness"),
        "Move every active vertex by one Newton step; returns the vertices that moved.");
}

void bind_splits(nb::module_& m) {
    m.def(
        "split_edge",
        [](Triangulation& t, HalfEdge e, double x, double y) {
            if (e < 0 || e >= 3 * t.triangles() || t.region[e / 3] == DEAD || t.adj[e] == NIL)
                throw nb::value_error("there is no such edge in the interior");
            for (const Triangle k : {e / 3, t.adj[e] / 3})
                for (const HalfEdge h : {3 * k, 3 * k + 1, 3 * k + 2})
                    if (t.tri[h] == NIL) throw nb::value_error("a ghost triangle is beside e");
            if (!t.has_segments() || t.fixed[e] != 0)
                throw nb::value_error("the edge is fixed, or the triangulation has no ``fixed``");
            return split_edge(t, e, {x, y});
        },
        nb::arg("t"), nb::arg("e"), nb::arg("x"), nb::arg("y"),
        "Put a vertex at (x, y), on or near the interior edge e, and join it to four corners.\n\n"
        "Returns the vertex, or NIL when a triangle would not be positive.");
}

void bind_triangles(nb::module_& m) {
    m.def(
        "find_folded",
        [](const Triangulation& t, const SurfaceFrames& s, double least, double at_apex) {
            require_domain(t, s);
            return view(find_folded(t, s, least, at_apex));
        },
        nb::arg("t"), nb::arg("frames"), nb::arg("least"), nb::arg("at_apex"),
        "Which triangles (triangles,) are turned against the surface at one of their corners.\n\n"
        "``least``: cosine of the largest angle between the normals; ``at_apex``: the same where "
        "a corner has no normal.");
    m.def(
        "dihedral_angles",
        [](const Points3& points, const Matrix<std::int32_t, 3>& triangles,
           const Matrix<std::int32_t, 2>& half_edges) {
            const std::span<const Vertex> corners{triangles.data(), triangles.size()};
            require_indices(corners, points.shape(0), "triangles");
            const std::span<const HalfEdgePair> edges = rows<HalfEdgePair>(half_edges);
            for (const auto [first, second] : edges)
                if (first < 0 || second < NIL ||
                    static_cast<std::size_t>(std::max(first, second)) >= corners.size())
                    throw nb::value_error("half_edges has an index that is out of range");
            const auto angles =
                released([&] { return dihedral_angles(rows<Point3>(points), corners, edges); });
            return view(angles);
        },
        nb::arg("points"), nb::arg("triangles"), nb::arg("half_edges"),
        "Radians (k,) between the normals of the triangles at pairs of half-edges (k, 2).\n\n"
        "points: (n, 3). triangles: (m, 3). -1 in the second column: 0, there is no angle. Where "
        "both run the same way, as somewhere on a Moebius strip, one triangle is turned over.");
}

}  // namespace

void bind_optimisation(nb::module_& m) {
    m.doc() = "Swaps, smoothing and splits, measured on the surface.";
    bind_frames(m);
    bind_marks(m);
    bind_swaps(m);
    bind_smoothing(m);
    bind_splits(m);
    bind_triangles(m);
}

}  // namespace surfmesh::binding
