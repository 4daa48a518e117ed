#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "binding/arrays.hpp"
#include "insertion/boundary_arguments.hpp"
#include "insertion/boundary_clearing.hpp"
#include "insertion/boundary_insertion.hpp"
#include "insertion/boundary_recovery.hpp"
#include "insertion/boundary_row.hpp"
#include "insertion/coincident_nodes.hpp"
#include "insertion/inside.hpp"
#include "insertion/inside_regions.hpp"

namespace surfmesh::binding {

namespace {

/// Refuse what is no triangulation of the whole plane, for instance one that was used up.
void require_plane(const Triangulation& t) {
    bool has_ghost = false, is_closed = true;
    for (const Vertex v : t.tri) has_ghost = has_ghost || v == NIL;
    for (const HalfEdge e : t.adj) is_closed = is_closed && e >= 0;
    if (!has_ghost || !is_closed) throw nb::value_error("t is no triangulation of the plane");
}

/// The triangulation, taken away from Python: nobody else may see it while it changes.
Triangulation taken(Triangulation& t) {
    require_plane(t);
    Triangulation own;
    std::swap(own, t);
    return own;
}

RecoveredDomain recover_loops(Triangulation& t, const Background& background, const Points2& nodes,
                              const Pairs& segments, const Pairs& inner,
                              const Vector<std::int64_t>& identity,
                              const std::optional<Points3>& points) {
    const LoopBoundary boundary = loop_boundary(nodes, segments, inner, identity, points);
    Triangulation packing = taken(t);
    const nb::gil_scoped_release released;
    return recover(std::move(packing), background, boundary);
}

void bind_outcomes(nb::module_& m) {
    nb::enum_<Recovery>(m, "Recovery", "How the insertion of a boundary ends.")
        .value("FINISHED", Recovery::finished)
        .value("NODE_TAKEN", Recovery::node_taken, "a node lies on an earlier node or segment")
        .value("CROSSING", Recovery::crossing, "a segment crosses an earlier one")
        .value("SEGMENT_ON_NODE", Recovery::segment_on_node, "a segment runs through a node")
        .value("NOT_RECOVERED", Recovery::not_recovered, "swaps did not end")
        .value("LOST", Recovery::lost, "a segment is no edge any more")
        .value("LEAK", Recovery::leak, "a loop is open or runs the wrong way")
        .value("DIFFERENT_LOOPS", Recovery::different_loops,
               "a region lies in different loops by different ways")
        .value("UNREACHABLE_REGION", Recovery::unreachable_region,
               "a region cannot be reached from the infinite one")
        .value("NOTHING_INSIDE", Recovery::nothing_inside, "the holes cover all of the domain");
    nb::class_<BoundaryOutcome>(m, "BoundaryOutcome", "How an insertion ended, and where.")
        .def_ro("status", &BoundaryOutcome::status)
        .def_ro("number", &BoundaryOutcome::number,
                "Of the node, segment or region reached, or NIL.")
        .def_ro("half_edge", &BoundaryOutcome::half_edge, "The one concerned, or NIL.");
}

/// Step 1: what is one node.
void bind_nodes(nb::module_& m) {
    m.def(
        "coincident_nodes",
        [](const Points2& uv, const Vector<std::int64_t>& numbers, const Pairs& segments) {
            require_rows(numbers.shape(0), uv.shape(0), "numbers");
            require_pairs(segments, uv.shape(0), "segments");
            const CoincidentNodes found = coincident_nodes(
                rows<Point2>(uv), rows<std::int64_t>(numbers), rows<Segment>(segments));
            return std::pair(view(found.nodes), view(found.row));
        },
        nb::arg("uv"), nb::arg("numbers"), nb::arg("segments"),
        "Which nodes of a boundary are one: by number in space, by place in (u, v).\n\nuv (k, 2), "
        "numbers (k,) int64, segments (s, 2) int32: pairs of nodes. Returns the nodes (n,) that "
        "are kept,\nrising, and for each node (k,) where its own is among these.");
    m.def(
        "loop_nodes",
        [](const Points2& uv, const Vector<std::int64_t>& numbers, const Numbers& lengths) {
            require_rows(numbers.shape(0), uv.shape(0), "numbers");
            require_lengths(lengths, uv.shape(0));
            const LoopNodes found = loop_nodes(rows<Point2>(uv), rows<std::int64_t>(numbers),
                                               rows<std::int32_t>(lengths));
            return std::tuple(view(found.nodes), view(found.segments), view(found.identity),
                              found.runs_twice);
        },
        nb::arg("uv"), nb::arg("numbers"), nb::arg("lengths"),
        "The same for closed loops, one after the other, that have ``lengths`` (l,) nodes each.\n\n"
        "Returns the nodes (n,) that are kept, segments (s, 2) int32 between these, for each of "
        "these\n(n,) int64 the first with its number, and whether a segment runs twice the same "
        "way.");
}

void bind_domain(nb::module_& m) {
    nb::class_<DomainMesh> domain(m, "DomainMesh", "A triangulated domain of the scaled plane.");
    domain.def_ro("t", &DomainMesh::t);
    bind_array(domain, "node", &DomainMesh::node,
               "(k,) int32: the vertex of each boundary node, NIL where no triangle uses it.");
    bind_array(domain, "same", &DomainMesh::same,
               "(k,) int32: the vertex of the node that each coincides with in space, or its own.");
    bind_array(domain, "on_kinks", &DomainMesh::on_kinks,
               "(j,) int32: vertices where the surface has two normals.");
    bind_array(domain, "points", &DomainMesh::points,
               "(k, 3) where the nodes lie in space, or (0, 3): on the surface.");
    nb::class_<RecoveredDomain>(m, "RecoveredDomain", "What comes of a recovery.")
        .def_ro("outcome", &RecoveredDomain::outcome)
        .def_ro("domain", &RecoveredDomain::domain, "Of meaning where the outcome is FINISHED.");
}

void bind_recovery(nb::module_& m) {
    m.def("recover", &recover_loops, nb::arg("t"), nb::arg("background"), nb::arg("nodes"),
          nb::arg("segments"), nb::arg("inner"), nb::arg("identity"),
          nb::arg("points") = nb::none(),
          "Section 3 in a row: insert loops into the packing t (which is used up), keep their "
          "inside.\n\nnodes (k, 2) in the scaled plane. segments (s, 2) int32: pairs of nodes, "
          "the inside on their left.\ninner (j, 2) int32: segments with the surface on both "
          "sides. identity (k,) int64: the first node\nthat is the same point in space. points "
          "(k, 3): of the nodes in space, left out where they lie\non the surface.");
}

InsideRegions found_inside(const Pairs& sides, const Pairs& loop_segments, const Bytes& is_hole,
                           std::int32_t infinite) {
    for (const SegmentSides& s : rows<SegmentSides>(sides))
        if (s.left < 0 || s.right < 0) throw nb::value_error("sides has a negative region");
    if (infinite < 0) throw nb::value_error("infinite is negative");
    require_column(loop_segments, 0, sides.shape(0), "loop_segments");
    require_column(loop_segments, 1, is_hole.shape(0), "loop_segments");
    const nb::gil_scoped_release released;
    return inside_regions(rows<SegmentSides>(sides), rows<LoopSegment>(loop_segments),
                          rows<std::uint8_t>(is_hole), infinite);
}

Patches labelled(const Numbers& adj, const Bytes& fixed, const Bytes& region) {
    require_rows(adj.shape(0), 3 * region.shape(0), "adj");
    require_rows(fixed.shape(0), 3 * region.shape(0), "fixed");
    for (const HalfEdge e : rows<HalfEdge>(adj))
        if (e >= static_cast<std::int64_t>(adj.shape(0)))
            throw nb::value_error("adj has an index that is out of range");
    const nb::gil_scoped_release released;
    return label_patches(rows<HalfEdge>(adj), rows<std::uint8_t>(fixed), rows<Region>(region));
}

void bind_inside(nb::module_& m) {
    m.def(
        "inside_regions",
        [](const Pairs& sides, const Pairs& loop_segments, const Bytes& is_hole,
           std::int32_t infinite) {
            const InsideRegions found = found_inside(sides, loop_segments, is_hole, infinite);
            return std::tuple(found.status, found.region, view(found.inside));
        },
        nb::arg("sides"), nb::arg("loop_segments"), nb::arg("is_hole"), nb::arg("infinite"),
        "Which regions of the plane lie in more outer loops than holes.\n\nsides (s, 2) int32: "
        "the regions left and right of each segment. loop_segments (m, 2) int32: segment\nand "
        "loop. is_hole (loops,) uint8. infinite: number of the unbounded region. Returns the "
        "status, the\nregion that contradicts, and (regions,) uint8.");
    m.def(
        "label_patches",
        [](const Numbers& adj, const Bytes& fixed, const Bytes& region) {
            const Patches patches = labelled(adj, fixed, region);
            return std::pair(view(patches.label), patches.count);
        },
        nb::arg("adj"), nb::arg("fixed"), nb::arg("region"),
        "Number the patches between segments: (triangles,) int32, NIL for dead slots; and how many."
        "\n\nadj (3 triangles,), fixed (3 triangles,), region (triangles,): of a triangulation.");
}

Insertion inserted(Triangulation& t, const Background& background, const Points2& nodes,
                   const Pairs& segments, const Pairs& with_row) {
    require_finite(nodes, "nodes");
    require_pairs(segments, nodes.shape(0), "segments");
    require_pairs(with_row, nodes.shape(0), "with_row");
    Triangulation packing = taken(t);
    const nb::gil_scoped_release released;
    return insert_boundary(std::move(packing), background, rows<Point2>(nodes),
                           rows<Segment>(segments), rows<Segment>(with_row));
}

void require_finished(const Insertion& made) {
    if (made.outcome.status != Recovery::finished)
        throw nb::value_error("the boundary was not inserted");
}

void bind_row(nb::module_& m) {
    m.def(
        "apexes",
        [](const Background& background, const Points2& nodes, const Pairs& segments) {
            require_pairs(segments, nodes.shape(0), "segments");
            return view(apexes(background, rows<Point2>(nodes), rows<Segment>(segments)));
        },
        nb::arg("background"), nb::arg("nodes"), nb::arg("segments"),
        "Apexes (n, 2) of isosceles triangles with unit legs on the left of segments (s, 2).");
    m.def(
        "insert_row",
        [](Triangulation& t, const Background& background, const Points2& apex) {
            require_finite(apex, "apex");
            require_plane(t);
            prepare_insertion(t);
            return insert_row(t, rows<Point2>(apex), sizes(background, rows<Point2>(apex)));
        },
        nb::arg("t"), nb::arg("background"), nb::arg("apex"),
        "Insert apexes (n, 2) into a packing and clear it around them; the first new vertex.");
}

/// The steps one by one: for tests, which look at the triangulation after each of them.
void bind_steps(nb::module_& m) {
    nb::class_<Insertion> made(m, "Insertion", "A packing with a boundary in it, step by step.");
    bind_array(made, "vertex", &Insertion::vertex, "(k,) of the nodes");
    bind_array(made, "edge", &Insertion::edge, "(s,) half-edges of the segments");
    made.def_ro("outcome", &Insertion::outcome)
        .def_ro("t", &Insertion::t)
        .def_ro("first_node", &Insertion::first_node, "Vertices from this one on are nodes.")
        .def(
            "grow_inside",
            [](Insertion& made) {
                require_finished(made);
                return grow_inside(made.t, made.edge);
            },
            "Step 5: INSIDE is what is connected to the left side of a segment.")
        .def(
            "clear_boundary",
            [](Insertion& made) {
                require_finished(made);
                const Cleared cleared =
                    clear_boundary(made.t, made.segments, made.edge, made.first_node);
                made.outcome = cleared.outcome;
                return cleared.removed;
            },
            "Step 4: remove what crowds the segments; how many vertices.")
        .def(
            "swap_bad",
            [](Insertion& made) {
                require_finished(made);
                return swap_bad(made.t);
            },
            "Step 4: swap edges of bad triangles; how many.");
    m.def(
        "insert_boundary", &inserted, nb::arg("t"), nb::arg("background"), nb::arg("nodes"),
        nb::arg("segments"), nb::arg("with_row"),
        "Steps 2 and 3: insert nodes (k, 2) and segments (s, 2) into the packing t, which is used "
        "up,\nwith a row of vertices to the left of the segments with_row (r, 2).");
}

}  // namespace

void bind_insertion(nb::module_& m) {
    m.doc() = "Section 3 of the paper: boundary nodes and segments by tracing neighbours.";
    m.attr("APART") = APART;
    m.attr("AROUND") = AROUND;
    m.attr("LOWEST") = LOWEST;
    m.attr("CROWDED") = CROWDED;
    bind_outcomes(m);
    bind_nodes(m);
    bind_domain(m);
    bind_recovery(m);
    bind_inside(m);
    bind_row(m);
    bind_steps(m);
}

}  // namespace surfmesh::binding
