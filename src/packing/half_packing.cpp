#include "packing/half_packing.hpp"

#include <algorithm>
#include <utility>

#include "packing/front_moves.hpp"
#include "values/first_touch.hpp"

namespace surfmesh {
namespace {

constexpr Region BEHIND = 2;  // of the fan: a barrier on all sides

/// The ghosts beside ``behind``, and where the hull goes on from the ends of the line.
///
///     c0 ->  behind -> cm     the hull there; before it x -> c0, after it cm -> y
struct LineEnds {
    Triangle ghosts[2];   // in their order
    HalfEdge into, from;  // NIL -> c0 in the ghost of x -> c0, cm -> NIL in that of cm -> y
    Vertex x, y;
    bool clear;  // are both edges at ``behind`` still on the hull?
};

LineEnds ends_of(const Triangulation& t, Vertex line) {
    const HalfEdge first = t.adj[2];              // behind -> c0
    const HalfEdge last = t.adj[3 * (line - 2)];  // cm -> behind
    LineEnds ends{};
    ends.clear = t.tri[prev_half_edge(first)] == NIL && t.tri[prev_half_edge(last)] == NIL;
    if (!ends.clear) return ends;
    ends.ghosts[0] = std::min(first, last) / 3;
    ends.ghosts[1] = std::max(first, last) / 3;
    ends.into = t.adj[next_half_edge(first)];
    ends.from = t.adj[prev_half_edge(last)];
    ends.x = t.tri[prev_half_edge(ends.into)];
    ends.y = t.tri[prev_half_edge(ends.from)];
    return ends;
}

/// Numbers of a half in the whole.
struct Renumbering {
    Vertex line;              // circles on it, the first of both halves
    bool reversed;            // is the line counted from its other end?
    Vertex first_other;       // number of the first circle that is not on it
    Triangle first_triangle;  // and of the first triangle that is kept
    Triangle ghosts[2];       // that go, with the fan

    [[nodiscard]] Vertex vertex(Vertex v) const {
        if (v == NIL) return NIL;
        if (v >= line) return v - (line + 1) + first_other;
        return reversed ? line - 1 - v : v;
    }
    [[nodiscard]] bool is_kept(Triangle k) const {
        return k >= line - 1 && k != ghosts[0] && k != ghosts[1];
    }
    [[nodiscard]] Triangle triangle(Triangle k) const {
        return k - (line - 1) - (k > ghosts[0]) - (k > ghosts[1]) + first_triangle;
    }
    [[nodiscard]] HalfEdge half_edge(HalfEdge e) const { return 3 * triangle(e / 3) + e % 3; }
};

/// What is made of both halves.
struct Whole {
    Triangulation t;
    Array<double> radius;

    /// To be filled, with room for the nodes of a boundary.
    Whole(Vertex vertices, Triangle triangles) {
        const auto count = static_cast<std::size_t>(vertices), room = count + count / 4 + 1000;
        const auto faces = static_cast<std::size_t>(triangles);
        t.xy = unfilled_with_room<Point2>(count, room);
        t.size = unfilled_with_room<SizeTensor>(count, room);
        t.tri = unfilled_with_room<Vertex>(3 * faces, 6 * room);
        t.adj = unfilled_with_room<HalfEdge>(3 * faces, 6 * room);
        t.region = unfilled_with_room<Region>(faces, 2 * room);
        t.mark = unfilled_with_room<std::int32_t>(faces, 2 * room);
        radius = unfilled_with_room<double>(count, room);
    }
};

/// Copy what is kept. The circles on the line are those of the half that is not reversed.
void copy(const Packing& from, const Renumbering& number, Whole& to) {
    const Triangulation& t = from.t;
    const auto first_vertex = static_cast<std::size_t>(number.reversed ? number.line + 1 : 0);
    for_each_block(t.xy.size(), TOUCHED_TOGETHER, [&](std::size_t first, std::size_t last) {
        for (std::size_t v = std::max(first, first_vertex); v < last; ++v) {
            if (static_cast<Vertex>(v) == number.line) continue;  // behind
            const Vertex n = number.vertex(static_cast<Vertex>(v));
            to.t.xy[n] = t.xy[v];
            to.t.size[n] = t.size[v];
            to.radius[n] = from.radius[v];
        }
    });
    for_each_block(t.region.size(), TOUCHED_TOGETHER, [&](std::size_t first, std::size_t last) {
        for (auto k = static_cast<Triangle>(first); k < static_cast<Triangle>(last); ++k) {
            if (!number.is_kept(k)) continue;
            const Triangle n = number.triangle(k);
            for (HalfEdge e = 3 * k, f = 3 * n; e < 3 * k + 3; ++e, ++f) {
                to.t.tri[f] = number.vertex(t.tri[e]);
                to.t.adj[f] = number.is_kept(t.adj[e] / 3) ? number.half_edge(t.adj[e]) : NIL;
            }
            to.t.region[n] = t.region[k];
            to.t.mark[n] = 0;
        }
    });
}

/// Twins across the line, and at its ends: what was joined to the fan.
struct OpenEdges {
    Array<HalfEdge> along;  // c(k) -> c(k+1) in the triangle on its left
    HalfEdge into, from;

    OpenEdges(const Triangulation& t, const LineEnds& ends, const Renumbering& number)
        : into(number.half_edge(ends.into)), from(number.half_edge(ends.from)) {
        for (Triangle k = 0; k < number.line - 1; ++k)
            along.push_back(number.half_edge(t.adj[3 * k + 1]));
    }
};

void join(Triangulation& t, HalfEdge e, HalfEdge f) {
    t.adj[e] = f;
    t.adj[f] = e;
}

void add_counts(PackingCounts& sum, const PackingCounts& other) {
    sum.steps += other.steps;
    sum.fits += other.fits;
    sum.tangents += other.tangents;
    sum.closed += other.closed;
    sum.forced += other.forced;
    sum.overlapping += other.overlapping;
}

}  // namespace

PackingStatus start_along(Packing& p, std::span<const Circle> line, const Circle& behind) {
    Triangulation& t = p.t;
    const auto count = static_cast<Vertex>(line.size());
    for (const Circle& circle : line) t.add_vertex(circle.centre, circle.size);
    t.add_vertex(behind.centre, behind.size);
    p.front.links.resize(t.xy.size());
    p.radius.resize(t.xy.size(), 1.0);
    for (Triangle k = 0; k < count - 1; ++k) {
        if (!(orient(t.xy, count, k + 1, k) > 0.0)) return PackingStatus::bad_start;
        const HalfEdge e = 3 * t.add_triangle();  // (behind, c(k+1), c(k))
        t.tri[e] = count;
        t.tri[e + 1] = k + 1;
        t.tri[e + 2] = k;
        t.region[k] = BEHIND;
        if (k > 0) join(t, e + 2, e - 3);
    }
    // the loop behind -> c(m) -> ... -> c(0) -> behind, and the ghost (b, a, NIL) of each a -> b
    const Triangle ghosts = t.triangles();
    for (Vertex n = 0; n <= count; ++n) {
        const Vertex a = n == 0 ? count : count - n, b = n == count ? count : count - n - 1;
        const HalfEdge done = n == 0 ? 3 * (count - 2) : n == count ? 2 : 3 * b + 1;
        const HalfEdge ghost = 3 * t.add_triangle();
        t.tri[ghost] = b;
        t.tri[ghost + 1] = a;
        t.tri[ghost + 2] = NIL;
        join(t, ghost, done);
        p.front.link(a, b, done);
    }
    for (Vertex n = 0; n <= count; ++n)  // a -> NIL meets NIL -> a
        join(t, 3 * (ghosts + n) + 1, 3 * (ghosts + (n + count) % (count + 1)) + 2);
    for (Vertex k = 0; k + 1 < count; ++k) queue(p, {k + 1, k});
    return PackingStatus::finished;
}

bool join_halves(Packing& p, const Packing& other, Vertex line) {
    const LineEnds ends = ends_of(p.t, line), others = ends_of(other.t, line);
    if (!ends.clear || !others.clear) return false;
    if (!(orient(p.t.xy[ends.x], p.t.xy[0], other.t.xy[others.y]) > 0.0) ||
        !(orient(other.t.xy[others.x], other.t.xy[0], p.t.xy[ends.y]) > 0.0))
        return false;
    const Vertex own_vertices = p.t.vertices() - 1;
    const Triangle fan = line - 1, own_triangles = p.t.triangles() - fan - 2;
    const Renumbering number{line, false, line, 0, {ends.ghosts[0], ends.ghosts[1]}};
    const Renumbering its{
        line, true, own_vertices, own_triangles, {others.ghosts[0], others.ghosts[1]}};
    const OpenEdges open(p.t, ends, number), across(other.t, others, its);
    Whole whole(own_vertices + other.t.vertices() - line - 1,
                own_triangles + other.t.triangles() - fan - 2);
    copy(p, number, whole);
    copy(other, its, whole);
    for (Triangle k = 0; k < fan; ++k) join(whole.t, open.along[k], across.along[fan - 1 - k]);
    join(whole.t, open.into, across.from);
    join(whole.t, open.from, across.into);
    p.t = std::move(whole.t);
    p.radius = std::move(whole.radius);
    p.front = {};
    add_counts(p.counts, other.counts);
    if (p.end.status == PackingStatus::finished) p.end = other.end;
    return true;
}

}  // namespace surfmesh
