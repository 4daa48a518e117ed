#include "packing/disc_fitting.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh {
namespace {

constexpr double REACH = 2.0;  // of its radius: how far behind the front a circle looks for others
constexpr double LEAST_HEIGHT = 0.3;  // of its radius: how far one between two distant ones stands

/// The deepest overlap found so far, f / (r1 + r2), and the circle.
struct Deepest {
    double worst;
    Vertex circle = NIL;

    void look_at(const Triangulation& t, Vertex v, Disc disc) {
        const Point2 d = t.xy[v] - disc.centre;
        const double reach = disc.r + 0.5 * t.size[v].xx;
        const double squared = d.x * d.x + d.y * d.y;
        if (!(squared < worst * worst * reach * reach)) return;
        worst = std::sqrt(squared) / reach;
        circle = v;
    }
};

/// Does a disc reach the edge e?
bool reaches(const Triangulation& t, HalfEdge e, Disc disc) {
    const Point2 a = t.xy[t.tri[e]], d = t.xy[t.tri[next_half_edge(e)]] - a;
    Point2 p = disc.centre - a;
    const double along = (p.x * d.x + p.y * d.y) / (d.x * d.x + d.y * d.y);
    const double s = std::min(std::max(along, 0.0), 1.0);
    p = p - s * d;
    return p.x * p.x + p.y * p.y < disc.r * disc.r;
}

}  // namespace

double gap_between(const Triangulation& t, Vertex a, Vertex b) {
    return norm(t.xy[b] - t.xy[a]) - 0.5 * (t.size[a].xx + t.size[b].xx);
}

Disc touch_two(const Triangulation& t, FrontEdge edge, double r) {
    const Disc a = disc_of(t, edge.a), b = disc_of(t, edge.b);
    const Point2 step = b.centre - a.centre;
    const double d = norm(step);
    r = std::max(r, 0.55 * (d - a.r - b.r));
    const double p = a.r + r, q = b.r + r;
    const double along = 0.5 * (d + (p - q) * (p + q) / d);
    const double height =
        std::sqrt(std::max(p * p - along * along, LEAST_HEIGHT * LEAST_HEIGHT * r * r));
    return {{a.centre.x + (along * step.x + height * step.y) / d,
             a.centre.y + (along * step.y - height * step.x) / d},
            r};
}

// Subtracting |P - A| = r + ra from its two like leaves P linear in r, then a quadratic equation
// for r.
Disc touch_three(const Triangulation& t, FrontEdge edge, Vertex third) {
    const auto [origin, ra] = disc_of(t, edge.a);
    const double rb = 0.5 * t.size[edge.b].xx, rc = 0.5 * t.size[third].xx;
    const Point2 b = t.xy[edge.b] - origin, c = t.xy[third] - origin;
    const double det = 2.0 * (b.x * c.y - b.y * c.x);
    const Disc none{origin, 0.0};
    if (std::abs(det) < 1e-9 * (b.x * b.x + b.y * b.y + c.x * c.x + c.y * c.y)) return none;
    // 2 b.P = |b|^2 - (rb - ra)(rb + ra + 2 r), P from A
    const double eb = b.x * b.x + b.y * b.y - (rb - ra) * (rb + ra);
    const double ec = c.x * c.x + c.y * c.y - (rc - ra) * (rc + ra);
    const double fb = -2.0 * (rb - ra), fc = -2.0 * (rc - ra);
    const double x0 = (eb * c.y - ec * b.y) / det, x1 = (fb * c.y - fc * b.y) / det;
    const double y0 = (b.x * ec - c.x * eb) / det, y1 = (b.x * fc - c.x * fb) / det;
    // |P|^2 = (r + ra)^2
    const double k2 = x1 * x1 + y1 * y1 - 1.0;
    const double k1 = x0 * x1 + y0 * y1 - ra;
    const double k0 = x0 * x0 + y0 * y0 - ra * ra;
    const double square = k1 * k1 - k2 * k0;
    if (square < 0.0) return none;
    const double root = std::sqrt(square);
    const double first = -k1 + root != 0.0 ? k0 / (-k1 + root) : 0.0;
    const double second = -k1 - root != 0.0 ? k0 / (-k1 - root) : 0.0;
    const double smaller = std::min(first, second);
    const double r = smaller > 0.0 ? smaller : std::max(first, second);
    if (!(r > 0.0)) return none;
    return {{origin.x + x0 + x1 * r, origin.y + y0 + y1 * r}, r};
}

Vertex overlapped_of(const Triangulation& t, Vertex u, Vertex v, Vertex w, Disc disc,
                     double tolerance) {
    Deepest deepest{1.0 - tolerance};
    deepest.look_at(t, u, disc);
    deepest.look_at(t, v, disc);
    if (w != NIL) deepest.look_at(t, w, disc);
    return deepest.circle;
}

Vertex overlapped_around(Packing& p, FrontEdge edge, Disc disc, double tolerance) {
    Triangulation& t = p.t;
    const auto is_support = [edge](Vertex v) { return v == edge.a || v == edge.b; };
    Deepest deepest{1.0 - tolerance};
    Array<HalfEdge>& stack = p.behind;
    stack.clear();
    for (const HalfEdge e : t.rim) {
        const Vertex v = t.tri[e];
        if (v == NIL) continue;
        if (!is_support(v)) deepest.look_at(t, v, disc);
        if (t.region[t.adj[e] / 3] == DONE) stack.push_back(t.adj[e]);
    }
    while (!stack.empty()) {
        const HalfEdge e = stack.pop_back();
        const Vertex v = t.tri[prev_half_edge(e)];
        if (v == NIL || t.mark[e / 3] == -t.search) continue;
        t.mark[e / 3] = -t.search;
        if (!is_support(v)) deepest.look_at(t, v, disc);
        for (const HalfEdge f : {next_half_edge(e), prev_half_edge(e)})
            if (t.region[t.adj[f] / 3] == DONE && reaches(t, f, {disc.centre, REACH * disc.r}))
                stack.push_back(t.adj[f]);
    }
    return deepest.circle;
}

}  // namespace surfmesh
