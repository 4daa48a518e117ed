#include "insertion/segment_recovery.hpp"

#include "insertion/node_insertion.hpp"
#include "triangulation/local_operations.hpp"

namespace surfmesh {
namespace {

/// Turn around a, from half-edge ``start``, for the way to b.
///
/// Gives (finished, e) when e is a -> b; (crossing, e) when the segment leaves the star of a
/// through e, from its right end to its left one; (segment_on_node, e) when e points along it.
///
///            q
///      e2  / |          e = a -> p,  e1 = p -> q,  e2 = q -> a
///        /   | e1
///      a --- | ---> b   p on the right of ab, q on its left: the segment leaves through e1
///        \   |
///      e   \ p
SegmentOutcome first_cut(const Triangulation& t, HalfEdge start, Segment ab) {
    const auto [a, b] = ab;
    const Point2 way = t.xy[b] - t.xy[a];
    HalfEdge e = start;
    do {
        const Vertex p = t.tri[next_half_edge(e)], q = t.tri[prev_half_edge(e)];
        if (p == b) return {Recovery::finished, e};
        if (p >= 0) {
            const double s = orient(t.xy, a, b, p);
            if (s == 0.0 && dot(t.xy[p] - t.xy[a], way) > 0.0)
                return {Recovery::segment_on_node, e};
            if (s < 0.0 && q >= 0 && q != b && orient(t.xy, a, b, q) > 0.0)
                return {Recovery::crossing, next_half_edge(e)};
        }
        e = rotate_ccw(t, e);
    } while (e != start);
    return {Recovery::not_recovered, NIL};
}

/// The edges that a -> b cuts, from ``cut`` on, by tracing neighbours, into ``queue``.
///
/// Each runs from its right end to its left end. On ``finished`` there is no half-edge; otherwise
/// it starts at the vertex met, or is the fixed edge crossed.
SegmentOutcome trace(const Triangulation& t, HalfEdge cut, Segment ab, Array<HalfEdge>& queue) {
    HalfEdge e = cut;
    while (true) {
        if (t.fixed[e] != 0) return {Recovery::crossing, e};
        queue.push_back(e);
        const HalfEdge f = t.adj[e];  // left end -> right end
        const Vertex v = t.tri[prev_half_edge(f)];
        if (v == ab.end) return {Recovery::finished, NIL};
        const double s = orient(t.xy, ab.start, ab.end, v);
        if (s == 0.0) return {Recovery::segment_on_node, prev_half_edge(f)};
        e = s < 0.0 ? prev_half_edge(f) : next_half_edge(f);
    }
}

/// A queue of at most as many half-edges as it starts with: each that comes has taken one out.
class SwapQueue {
  public:
    explicit SwapQueue(const Array<HalfEdge>& edges) : ring_(edges), count_(edges.size()) {}

    [[nodiscard]] bool empty() const { return count_ == 0; }
    HalfEdge pop() {
        const HalfEdge e = ring_[head_];
        head_ = (head_ + 1) % ring_.size();
        --count_;
        return e;
    }
    void push(HalfEdge e) { ring_[(head_ + count_++) % ring_.size()] = e; }
    /// The edges of slots e1 and f1 have moved to f and e.
    void follow_swap(HalfEdge e, HalfEdge e1, HalfEdge f, HalfEdge f1) {
        for (std::size_t k = 0; k < count_; ++k) {
            HalfEdge& g = ring_[(head_ + k) % ring_.size()];
            if (g == e1)
                g = f;
            else if (g == f1)
                g = e;
        }
    }

  private:
    Array<HalfEdge> ring_;
    std::size_t head_ = 0, count_;
};

/// Swap the edges that a-b cuts until it is an edge itself (Sloan 1993).
///
/// Returns the half-edge a -> b, or NIL.
HalfEdge swap_out(Triangulation& t, Segment ab, const Array<HalfEdge>& cut) {
    const auto [a, b] = ab;
    SwapQueue queue(cut);
    HalfEdge found = NIL;
    const auto count = static_cast<std::int64_t>(cut.size());
    for (std::int64_t guard = 64 * count * (count + 16); !queue.empty() && guard > 0; --guard) {
        const HalfEdge e = queue.pop();
        if (!is_convex(t, e)) {
            queue.push(e);
            continue;
        }
        const HalfEdge f = t.adj[e];
        const HalfEdge e1 = next_half_edge(e), f1 = next_half_edge(f);
        swap_edge(t, e);
        queue.follow_swap(e, e1, f, f1);
        const Vertex p = t.tri[e1], q = t.tri[f1];  // the new edge p -> q
        if (p == a && q == b) {
            found = e1;
        } else if (p == b && q == a) {
            found = f1;
        } else if (p != a && p != b && q != a && q != b) {
            if ((orient(t.xy, a, b, p) < 0.0) != (orient(t.xy, a, b, q) < 0.0)) queue.push(e1);
        }
    }
    return queue.empty() ? found : NIL;
}

}  // namespace

SegmentOutcome recover_segment(Triangulation& t, HalfEdge start, Segment ab, Vertex first_node) {
    Array<HalfEdge> cut;
    HalfEdge e = start;
    while (true) {
        SegmentOutcome next = first_cut(t, e, ab);
        if (next.status == Recovery::finished || next.status == Recovery::not_recovered)
            return next;
        if (next.status == Recovery::segment_on_node) {
            next.half_edge = t.adj[next.half_edge];
        } else {
            cut.clear();
            next = trace(t, next.half_edge, ab, cut);
        }
        if (next.status == Recovery::finished) {
            e = swap_out(t, ab, cut);
            return {e != NIL ? Recovery::finished : Recovery::not_recovered, e};
        }
        if (next.status != Recovery::segment_on_node || t.tri[next.half_edge] >= first_node)
            return next;
        const HalfEdge live = remove_vertex(t, next.half_edge);
        if (live == NIL) return {Recovery::not_recovered, next.half_edge};
        e = find_star(t, live, ab.start);
        if (e == NIL) return {Recovery::not_recovered, live};
    }
}

BoundaryOutcome recover_segments(Triangulation& t, HalfEdge near, std::span<const Segment> segments,
                                 Vertex first_node) {
    for (std::size_t k = 0; k < segments.size(); ++k) {
        const auto number = static_cast<std::int32_t>(k);
        const HalfEdge start = find_star(t, near, segments[k].start);
        if (start == NIL) return {Recovery::not_recovered, number, near};
        const auto [status, e] = recover_segment(t, start, segments[k], first_node);
        if (status != Recovery::finished) return {status, number, e};
        t.fixed[e] = 1;
        t.fixed[t.adj[e]] = 1;
        near = e;
    }
    return {};
}

HalfEdge find_edge(const Triangulation& t, HalfEdge e, HalfEdge near, Segment ab) {
    if (e != NIL && t.region[e / 3] != DEAD && t.tri[e] == ab.start &&
        t.tri[next_half_edge(e)] == ab.end)
        return e;
    const HalfEdge start = find_star(t, near, ab.start);
    if (start == NIL) return NIL;
    const auto [status, found] = first_cut(t, start, ab);
    return status == Recovery::finished ? found : NIL;
}

BoundaryOutcome find_segments(const Triangulation& t, std::span<const Segment> segments,
                              Array<HalfEdge>& edge) {
    HalfEdge near = first_live(t);
    for (std::size_t k = 0; k < segments.size(); ++k) {
        const HalfEdge e = find_edge(t, edge[k], near, segments[k]);
        if (e == NIL) return {Recovery::lost, static_cast<std::int32_t>(k), near};
        edge[k] = near = e;
    }
    return {};
}

}  // namespace surfmesh
