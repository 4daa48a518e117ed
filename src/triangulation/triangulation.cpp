#include "triangulation/triangulation.hpp"

namespace surfmesh {
namespace {

constexpr int WALK_LIMIT = 100'000;

/// Is p inside the circumcircle of the triangle, seen in the metric of h?
///
/// The circumcircle of a ghost is the open half plane beyond its hull edge.
bool in_circle(const Triangulation& t, Triangle triangle, Point2 p, SizeTensor h) {
    const HalfEdge e = 3 * triangle;
    const Vertex a = t.tri[e], b = t.tri[e + 1], c = t.tri[e + 2];
    if (a < 0) return side(t, b, c, p) > 0.0;
    if (b < 0) return side(t, c, a, p) > 0.0;
    if (c < 0) return side(t, a, b, p) > 0.0;
    const Point2 pa = solve(h, t.xy[a] - p);
    const Point2 pb = solve(h, t.xy[b] - p);
    const Point2 pc = solve(h, t.xy[c] - p);
    const double det = (pa.x * pa.x + pa.y * pa.y) * (pb.x * pc.y - pc.x * pb.y) -
                       (pb.x * pb.x + pb.y * pb.y) * (pa.x * pc.y - pc.x * pa.y) +
                       (pc.x * pc.x + pc.y * pc.y) * (pa.x * pb.y - pb.x * pa.y);
    return det > 0.0;
}

/// Does triangle n belong to the cavity of p, which is open as far as its edge a-b?
bool joins(const Triangulation& t, HalfEdge twin, Vertex a, Vertex b, bool on_edge, Point2 p,
           SizeTensor h, bool wide) {
    if (on_edge) return true;
    if (!wide || !in_circle(t, twin / 3, p, h)) return false;
    const Vertex z = t.tri[prev_half_edge(twin)];
    return side(t, a, z, p) > 0.0 && side(t, z, b, p) > 0.0;
}

/// The triangles of the cavity, from ``cavity[0]`` on, and the half-edges that end it.
void collect_cavity(Triangulation& t, Point2 p, SizeTensor h, bool wide) {
    const Region region = t.region[t.cavity[0]];
    for (std::size_t k = 0; k < t.cavity.size(); ++k) {
        const HalfEdge base = 3 * t.cavity[k];
        for (HalfEdge e = base; e < base + 3; ++e) {
            const HalfEdge twin = t.adj[e];
            const Triangle n = twin / 3;
            if (t.mark[n] == t.search) continue;
            const Vertex a = t.tri[e], b = t.tri[e == base + 2 ? base : e + 1];
            const double from = side(t, a, b, p);
            const bool is_barrier = t.region[n] != region || (t.has_segments() && t.fixed[e] != 0);
            if (!is_barrier && joins(t, twin, a, b, from == 0.0, p, h, wide)) {
                t.mark[n] = t.search;
                t.cavity.push_back(n);
            } else {
                t.candidates.push_back({e, n, from});
            }
        }
    }
}

}  // namespace

Vertex Triangulation::add_vertex(Point2 place, SizeTensor tensor) {
    xy.push_back(place);
    size.push_back(tensor);
    return vertices() - 1;
}

Triangle Triangulation::add_triangle() {
    const std::size_t half_edges = tri.size() + 3;
    tri.resize(half_edges, NIL);
    adj.resize(half_edges, NIL);
    if (has_segments()) fixed.resize(half_edges, 0);
    region.push_back(0);
    mark.push_back(0);
    return triangles() - 1;
}

void Triangulation::reserve(std::size_t count) {
    xy.reserve(count);
    size.reserve(count);
    const std::size_t most = 2 * count;  // with ghosts there are exactly 2 n - 2 (Euler)
    tri.reserve(3 * most);
    adj.reserve(3 * most);
    region.reserve(most);
    mark.reserve(most);
}

// The order in which the two other edges are tried varies, so that the walk cannot go round in
// circles for ever.
Location locate(const Triangulation& t, HalfEdge start, Point2 p, bool stop) {
    HalfEdge e = start;
    if (side(t, t.tri[e], t.tri[next_half_edge(e)], p) < 0.0) {
        if (stop && is_barrier(t, e)) return {e / 3, e};
        e = t.adj[e];
    }
    std::uint32_t dice = 12345;
    for (int step = 0; step < WALK_LIMIT; ++step) {  // the point is on the left of e
        dice = (dice * 1103515245u + 12345u) & 0x7FFFFFFFu;
        HalfEdge first = next_half_edge(e), second = prev_half_edge(e);
        if (!(dice & 0x10000u)) std::swap(first, second);
        HalfEdge onward = NIL;
        if (side(t, t.tri[first], t.tri[next_half_edge(first)], p) < 0.0)
            onward = first;
        else if (side(t, t.tri[second], t.tri[next_half_edge(second)], p) < 0.0)
            onward = second;
        if (onward == NIL) return {e / 3, NIL};
        if (stop && is_barrier(t, onward)) return {e / 3, onward};
        e = t.adj[onward];
    }
    return {e / 3, e};
}

bool open_cavity(Triangulation& t, Triangle start, Point2 p, SizeTensor h, bool wide) {
    ++t.search;
    t.cavity.clear();
    t.cavity.push_back(start);
    t.mark[start] = t.search;
    t.candidates.clear();
    collect_cavity(t, p, h, wide);
    t.rim.clear();
    for (const RimCandidate& candidate : t.candidates) {
        if (t.mark[candidate.beyond] == t.search) continue;  // joined from elsewhere
        if (candidate.side <= 0.0) return false;
        t.rim.push_back(candidate.e);
    }
    return t.rim.size() == t.cavity.size() + 2;
}

bool is_rim_visible(const Triangulation& t, Point2 p) {
    Vertex first = NIL, last = NIL;  // the hull would run first -> new vertex -> last
    for (const HalfEdge e : t.rim) {
        const Vertex a = t.tri[e], b = t.tri[next_half_edge(e)];
        if (a >= 0 && b >= 0) {
            if (side(t, a, b, p) <= 0.0) return false;
            continue;
        }
        if (b < 0)
            first = a;
        else
            last = b;
        const HalfEdge ghost = t.adj[e];  // the next ghost along the hull
        const HalfEdge f = t.tri[ghost] < 0 ? next_half_edge(ghost) : prev_half_edge(ghost);
        if (side(t, t.tri[f], t.tri[next_half_edge(f)], p) > 0.0) return false;
    }
    return first == NIL || side(t, last, first, p) > 0.0;
}

void fill_cavity(Triangulation& t, Vertex p) {
    const auto rims = static_cast<Triangle>(t.rim.size());
    const Region region = t.region[t.cavity[0]];
    while (t.cavity.size() < t.rim.size()) t.cavity.push_back(t.add_triangle());
    t.link_.resize(t.xy.size() + 1, NIL);
    const auto link = [&t](Vertex v) -> std::int32_t& { return t.link_[v + 1]; };
    for (Triangle k = 0; k < rims; ++k) {  // read the rim before its triangles are overwritten
        const HalfEdge e = t.rim[k];
        t.rim[k] = t.adj[e];
        link(t.tri[e]) = k;
    }
    for (Triangle k = 0; k < rims; ++k) {  // an outer twin's own end points are still readable
        const HalfEdge outer = t.rim[k];
        const HalfEdge e = 3 * t.cavity[k];
        t.tri[e] = t.tri[next_half_edge(outer)];
        t.tri[e + 1] = t.tri[outer];
        t.tri[e + 2] = p;
        t.adj[e] = outer;
        t.adj[outer] = e;
        if (t.has_segments()) {
            t.fixed[e] = t.fixed[outer];
            t.fixed[e + 1] = 0;
            t.fixed[e + 2] = 0;
        }
        t.region[e / 3] = region;
        t.mark[e / 3] = 0;
    }
    for (Triangle k = 0; k < rims; ++k) {  // (x, y, p): y -> p meets the triangle that starts at y
        const HalfEdge e = 3 * t.cavity[k];
        const HalfEdge after = 3 * t.cavity[link(t.tri[e + 1])];
        t.adj[e + 1] = after + 2;
        t.adj[after + 2] = e + 1;
    }
}

}  // namespace surfmesh
