#include "insertion/boundary_clearing.hpp"

#include <algorithm>
#include <cmath>

#include "triangulation/local_operations.hpp"
#include "values/threads.hpp"

namespace surfmesh {
namespace {

// Triangles below this alpha, left by the packing or the boundary, are offered a swap; how often
// all are gone through at most; by how much a swap has to raise the smaller alpha.
constexpr double BAD_SHAPE = 0.7;
constexpr int SWEEPS = 8;
constexpr double BETTER_BY = 1e-3;
constexpr std::size_t BLOCK = 1 << 15;  // triangles measured together

/// Metric distance of vertex v from the segment of half-edge e.
double distance_to_edge(const Triangulation& t, HalfEdge e, Vertex v) {
    const Vertex a = t.tri[e], b = t.tri[next_half_edge(e)];
    const SizeTensor p = t.size[a], q = t.size[b], r = t.size[v];
    const SizeTensor h = 0.25 * (p + q + 2.0 * r);
    const Point2 along = solve(h, t.xy[b] - t.xy[a]);
    const Point2 way = solve(h, t.xy[v] - t.xy[a]);
    const double s = std::min(std::max(dot(along, way) / dot(along, along), 0.0), 1.0);
    return norm(way - s * along);
}

/// One segment while what crowds it is removed.
class SegmentClearing {
  public:
    SegmentClearing(Triangulation& t, Segment ab, HalfEdge e, Vertex first_node)
        : t_(t), ab_(ab), e_(e), first_node_(first_node) {}

    [[nodiscard]] HalfEdge edge() const { return e_; }  // NIL where it was lost
    [[nodiscard]] std::int64_t removed() const { return removed_; }

    /// The apex over the segment; removing it brings up another.
    void clear_apexes() {
        while (e_ != NIL) {
            const HalfEdge apex = prev_half_edge(e_);
            if (!crowds(t_.tri[apex]) || !remove(apex)) return;
        }
    }

    /// Neighbours of the segment's start, counter-clockwise up to the next segment.
    void clear_start() {
        HalfEdge f = e_;
        while (e_ != NIL) {
            f = rotate_ccw(t_, f);
            if (t_.fixed[f] != 0) return;
            if (crowds(t_.tri[next_half_edge(f)]) && remove(t_.adj[f])) f = e_;
        }
    }

  private:
    [[nodiscard]] bool crowds(Vertex v) const {
        return 0 <= v && v < first_node_ && distance_to_edge(t_, e_, v) < CROWDED;
    }

    /// Remove the vertex at the start of f, if it can go.
    bool remove(HalfEdge f) {
        const HalfEdge live = remove_vertex(t_, f);
        if (live == NIL) return false;
        ++removed_;
        e_ = find_edge(t_, e_, live, ab_);
        return true;
    }

    Triangulation& t_;
    Segment ab_;
    HalfEdge e_;
    Vertex first_node_;
    std::int64_t removed_ = 0;
};

/// Alpha of the triangles inside, 1 of the others; and where bad ones may be, so that few are gone
/// through in search of them.
class TriangleShapes {
  public:
    explicit TriangleShapes(const Triangulation& t)
        : shape_(Array<double>::unfilled(t.region.size())), may_be_bad_(shape_.size() / GROUP + 1) {
        for_each_block(shape_.size(), BLOCK, [&](std::size_t first, std::size_t last) {
            for (auto k = static_cast<Triangle>(first); k < static_cast<Triangle>(last); ++k)
                set(k, t.region[k] == INSIDE ? triangle_shape(t.xy, t.size, t.tri[3 * k],
                                                              t.tri[3 * k + 1], t.tri[3 * k + 2])
                                             : 1.0);
        });
    }
    [[nodiscard]] double operator[](Triangle k) const { return shape_[k]; }
    [[nodiscard]] bool is_bad(Triangle k) const { return shape_[k] < BAD_SHAPE; }
    void set(Triangle k, double shape) {
        shape_[k] = shape;
        if (shape < BAD_SHAPE) may_be_bad_[k / GROUP] = 1;
    }
    /// The first bad triangle from k on, or how many there are.
    [[nodiscard]] Triangle next_bad(Triangle k) const {
        const auto end = static_cast<Triangle>(shape_.size());
        while (k < end && !is_bad(k)) k = may_be_bad_[k / GROUP] ? k + 1 : (k / GROUP + 1) * GROUP;
        return std::min(k, end);
    }

  private:
    static constexpr Triangle GROUP = 64;
    static_assert(BLOCK % GROUP == 0);  // a group is set by one thread
    Array<double> shape_;
    Array<std::uint8_t> may_be_bad_;  // of each group of triangles
};

/// Swap the edge of e, and note the new shapes, if that betters the worse of its two triangles.
bool swap_if_better(Triangulation& t, HalfEdge e, TriangleShapes& shape) {
    const HalfEdge f = t.adj[e];
    const Vertex a = t.tri[e], b = t.tri[f];
    const Vertex c = t.tri[prev_half_edge(e)], d = t.tri[prev_half_edge(f)];
    if (a < 0 || b < 0 || c < 0 || d < 0) return false;
    const double old = std::min(shape[e / 3], shape[f / 3]);
    const double first = triangle_shape(t.xy, t.size, a, d, c);
    const double second = triangle_shape(t.xy, t.size, b, c, d);
    if (!(std::min(first, second) > old + BETTER_BY) || !is_convex(t, e)) return false;
    swap_edge(t, e);
    shape.set(e / 3, first);
    shape.set(f / 3, second);
    return true;
}

}  // namespace

Cleared clear_boundary(Triangulation& t, std::span<const Segment> segments, Array<HalfEdge>& edge,
                       Vertex first_node) {
    Cleared cleared;
    for (std::size_t k = 0; k < segments.size(); ++k) {
        const HalfEdge near = k > 0 ? edge[k - 1] : edge.back();
        SegmentClearing segment(t, segments[k], find_edge(t, edge[k], near, segments[k]),
                                first_node);
        segment.clear_apexes();
        segment.clear_start();
        cleared.removed += segment.removed();
        edge[k] = segment.edge();
        if (edge[k] == NIL) {
            cleared.outcome = {Recovery::lost, static_cast<std::int32_t>(k), near};
            break;
        }
    }
    return cleared;
}

std::int64_t swap_bad(Triangulation& t) {
    TriangleShapes shapes(t);
    std::int64_t total = 0;
    for (int sweep = 0; sweep < SWEEPS; ++sweep) {
        std::int64_t swaps = 0;
        for (Triangle k = shapes.next_bad(0); k < t.triangles(); k = shapes.next_bad(k + 1))
            for (HalfEdge e = 3 * k; shapes.is_bad(k) && e < 3 * k + 3; ++e)
                if (t.fixed[e] == 0 && swap_if_better(t, e, shapes)) ++swaps;
        total += swaps;
        if (swaps == 0) break;
    }
    return total;
}

}  // namespace surfmesh
