#include "insertion/boundary_insertion.hpp"

#include <utility>

#include "insertion/boundary_row.hpp"
#include "insertion/node_insertion.hpp"

namespace surfmesh {
namespace {

/// Step 2: all nodes. On ``finished`` the half-edge leaves the last one.
BoundaryOutcome insert_nodes(Insertion& made, const Background& background,
                             std::span<const Point2> nodes) {
    Triangulation& t = made.t;
    made.first_node = t.vertices();
    made.vertex.reserve(nodes.size());
    HalfEdge near = first_live(t);
    for (const Point2 place : nodes) {
        const SizeTensor h = background.size_at(place.x, place.y);
        const NodeInserted node = insert_node(t, near, place, h, made.first_node);
        near = node.half_edge;
        const auto number = static_cast<std::int32_t>(made.vertex.size());
        if (node.vertex == NIL) return {Recovery::node_taken, number, near};
        made.vertex.push_back(node.vertex);
    }
    return {Recovery::finished, NIL, near};
}

}  // namespace

void prepare_insertion(Triangulation& t) {
    t.region.fill(INSIDE);
    t.fixed.resize(t.tri.size(), 0);
    t.fixed.fill(0);
}

Insertion insert_boundary(Triangulation&& packing, const Background& background,
                          std::span<const Point2> nodes, std::span<const Segment> segments,
                          std::span<const Segment> with_row) {
    Insertion made;
    made.t = std::move(packing);
    prepare_insertion(made.t);
    const Array<Point2> row = apexes(background, nodes, with_row);
    made.t.reserve(made.t.xy.size() + row.size() + nodes.size());
    insert_row(made.t, row, sizes(background, row));
    made.outcome = insert_nodes(made, background, nodes);
    if (made.outcome.status != Recovery::finished) return made;
    made.segments.reserve(segments.size());
    for (const auto [a, b] : segments) made.segments.push_back({made.vertex[a], made.vertex[b]});
    made.outcome = recover_segments(made.t, made.outcome.half_edge, made.segments, made.first_node);
    if (made.outcome.status != Recovery::finished) return made;
    made.edge.resize(segments.size(), NIL);
    made.outcome = find_segments(made.t, made.segments, made.edge);
    return made;
}

}  // namespace surfmesh
