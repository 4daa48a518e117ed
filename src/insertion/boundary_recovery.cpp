#include "insertion/boundary_recovery.hpp"

#include <algorithm>
#include <utility>

#include "insertion/boundary_clearing.hpp"
#include "insertion/boundary_insertion.hpp"
#include "insertion/inside.hpp"
#include "triangulation/compaction.hpp"

namespace surfmesh {
namespace {

constexpr Segment reversed(Segment ab) { return {ab.end, ab.start}; }

/// Step 4, and the end of step 5: a domain of what is INSIDE.
RecoveredDomain finish(Insertion&& made) {
    const Cleared cleared = clear_boundary(made.t, made.segments, made.edge, made.first_node);
    RecoveredDomain found{cleared.outcome, {}};
    if (cleared.outcome.status != Recovery::finished) return found;
    swap_bad(made.t);
    DomainTriangulation cut = cut_inside(made.t);
    found.domain.t = std::move(cut.t);
    found.domain.node.reserve(made.vertex.size());
    for (const Vertex v : made.vertex) found.domain.node.push_back(cut.vertex_number[v]);
    return found;
}

/// The vertices of the nodes that segments use, in the order of the nodes.
Array<Vertex> vertices_of(std::span<const Segment> segments, const Array<Vertex>& node) {
    Array<std::uint8_t> used(node.size(), 0);
    for (const auto [a, b] : segments) used[a] = used[b] = 1;
    Array<Vertex> vertices;
    for (std::size_t k = 0; k < node.size(); ++k)
        if (used[k]) vertices.push_back(node[k]);
    return vertices;
}

/// The patches on both sides of the first piece of each segment.
Array<SegmentSides> sides_of_segments(const Insertion& made, const Patches& patches,
                                      std::span<const std::int32_t> segment) {
    std::int32_t last = -1;
    for (const std::int32_t number : segment) last = std::max(last, number);
    Array<SegmentSides> sides(static_cast<std::size_t>(last + 1), {NIL, NIL});
    for (std::size_t k = 0; k < segment.size(); ++k) {
        const HalfEdge e = made.edge[k];
        SegmentSides& side = sides[segment[k]];
        if (side.left == NIL) side = {patches.label[e / 3], patches.label[made.t.adj[e] / 3]};
    }
    return sides;
}

/// Keep of each segment, and of each segment reversed, those with an inside on their left.
void keep_inner_sides(Insertion& made) {
    const Triangulation& t = made.t;
    const std::size_t count = made.segments.size();
    Array<Segment> segments;
    Array<HalfEdge> edge;
    for (std::size_t k = 0; k < 2 * count; ++k) {
        const bool is_first = k < count;
        const HalfEdge e = is_first ? made.edge[k] : t.adj[made.edge[k - count]];
        if (t.region[e / 3] != INSIDE) continue;
        segments.push_back(is_first ? made.segments[k] : reversed(made.segments[k - count]));
        edge.push_back(e);
    }
    made.segments.swap(segments);
    made.edge.swap(edge);
}

/// A half-edge of the hull's infinite vertex.
HalfEdge ghost(const Triangulation& t) {
    return static_cast<HalfEdge>(std::find(t.tri.begin(), t.tri.end(), NIL) - t.tri.begin());
}

}  // namespace

RecoveredDomain recover(Triangulation&& packing, const Background& background,
                        const LoopBoundary& boundary) {
    Array<Segment> all(boundary.segments);
    for (const Segment ab : boundary.inner) all.push_back(ab);
    Array<Segment> with_row(all);
    for (const Segment ab : boundary.inner) with_row.push_back(reversed(ab));
    Insertion made = insert_boundary(std::move(packing), background, boundary.nodes, all, with_row);
    if (made.outcome.status != Recovery::finished) return {made.outcome, {}};
    for (std::size_t k = boundary.segments.size(); k < all.size(); ++k) {
        made.segments.push_back(reversed(made.segments[k]));
        made.edge.push_back(made.t.adj[made.edge[k]]);
    }
    const Recovery grown = grow_inside(made.t, made.edge);
    if (grown != Recovery::finished) return {{grown, NIL, NIL}, {}};
    RecoveredDomain found = finish(std::move(made));
    DomainMesh& domain = found.domain;
    if (found.outcome.status != Recovery::finished) return found;
    domain.same.reserve(boundary.identity.size());
    for (const std::int64_t first : boundary.identity) domain.same.push_back(domain.node[first]);
    domain.on_kinks = vertices_of(boundary.inner, domain.node);
    domain.points = Array<Point3>(boundary.points);
    return found;
}

RecoveredDomain recover_regions(Triangulation&& packing, const Background& background,
                                const PlanarBoundary& boundary) {
    Array<Segment> with_row(boundary.pieces);
    for (const Segment ab : boundary.pieces) with_row.push_back(reversed(ab));
    Insertion made =
        insert_boundary(std::move(packing), background, boundary.nodes, boundary.pieces, with_row);
    if (made.outcome.status != Recovery::finished) return {made.outcome, {}};
    Triangulation& t = made.t;
    const Patches patches = label_patches(t.adj, t.fixed, t.region);
    const InsideRegions found =
        inside_regions(sides_of_segments(made, patches, boundary.segment), boundary.loop_segments,
                       boundary.is_hole, patches.label[ghost(t) / 3]);
    if (found.status != Recovery::finished) return {{found.status, found.region, NIL}, {}};
    if (std::find(found.inside.begin(), found.inside.end(), 1) == found.inside.end())
        return {{Recovery::nothing_inside, NIL, NIL}, {}};
    for (Triangle k = 0; k < t.triangles(); ++k)
        if (patches.label[k] != NIL)
            t.region[k] = found.inside[patches.label[k]] ? INSIDE : OUTSIDE;
    keep_inner_sides(made);
    RecoveredDomain result = finish(std::move(made));
    result.domain.same = result.domain.node;
    return result;
}

}  // namespace surfmesh
