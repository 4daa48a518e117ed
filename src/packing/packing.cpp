#include "packing/packing.hpp"

#include <algorithm>
#include <cmath>

#include "packing/circle_fitting.hpp"
#include "packing/disc_packing.hpp"
#include "packing/front_moves.hpp"

namespace surfmesh {
namespace {

constexpr double OVERLAP = 0.65;      // a circle nearer than this refuses the candidate
constexpr double TANGENT_FROM = 0.8;  // metric radius at which a circle tangent to three is taken
constexpr double TANGENT_TO = 1.25;
constexpr double TANGENT_OVERLAP = 0.9;  // of that radius: the same for a circle tangent to three
constexpr Vertex MOST_CIRCLES = 350'000'000;     // six half-edges each are numbered in 32 bits
constexpr std::int64_t BETWEEN_LOOKS = 1 << 14;  // steps of the front between calls of the watch

/// Corners of the equilateral triangle of side 1 about (0, 0).
///
/// As sine and cosine give them, last places and all: no library decides where circles start.
constexpr Point2 START[] = {{0x1.4611bfd437b1ap-55, -0x1.279a74590331dp-1},
                            {0x1.0000000000001p-1, 0x1.279a74590331bp-2},
                            {-0x1.fffffffffffffp-2, 0x1.279a745903320p-2}};

/// The first triangle of three circles, its ghosts around it, and its sides as the front.
PackingStatus start(Packing& p, const Circle (&circles)[3]) {
    Triangulation& t = p.t;
    for (const Circle& circle : circles) {
        t.add_vertex(circle.centre, circle.size);
        p.front.links.push_back({});
        p.radius.push_back(1.0);
    }
    if (!(orient(t.xy, 0, 1, 2) > 0.0)) return PackingStatus::bad_start;
    for (Triangle k = 0; k < 4; ++k) t.add_triangle();
    for (Vertex k = 0; k < 3; ++k) {
        t.tri[k] = k;
        const HalfEdge ghost = 3 * (k + 1);  // ghost (b, a, NIL) of the edge a -> b, a = k
        t.tri[ghost] = (k + 1) % 3;
        t.tri[ghost + 1] = k;
        t.tri[ghost + 2] = NIL;
        t.adj[k] = ghost;
        t.adj[ghost] = k;
        const HalfEdge before = 3 * ((k + 2) % 3 + 1);  // ghost of the edge that ends at a
        t.adj[ghost + 1] = before + 2;                  // a -> NIL meets NIL -> a
        t.adj[before + 2] = ghost + 1;
        p.front.link(k, (k + 1) % 3, k);
    }
    t.region[0] = DONE;
    for (Triangle k = 1; k < 4; ++k) t.region[k] = TODO;
    for (Vertex k = 0; k < 3; ++k) queue(p, {k, (k + 1) % 3});
    return PackingStatus::finished;
}

/// Three circles of the background's sizes, touching each other about the origin (2.3.1).
PackingStatus start_at(Packing& p, const CircleSizes& sizes) {
    const Point2 origin = p.limits.origin;
    const SizeTensor h = sizes.at(origin);
    const Point2 turn = p.limits.edge ? unit_step(h, *p.limits.edge) : Point2{1.0, 0.0};
    Circle circles[3];
    for (int k = 0; k < 3; ++k) {
        const Point2 s = START[k];
        const Point2 c{turn.x * s.x - turn.y * s.y, turn.y * s.x + turn.x * s.y};
        const Point2 place{origin.x + h.xx * c.x + h.xy * c.y, origin.y + h.xy * c.x + h.yy * c.y};
        circles[k] = {place, sizes.along(place, apply(h, turn))};
    }
    return start(p, circles);
}

/// Three circles of the drawn radii, touching each other about the origin (2.3.1).
PackingStatus start_discs(Packing& p) {
    const double ra = p.drawn[0], rb = p.drawn[1], rc = p.drawn[2];
    const double p0 = ra + rc, q0 = rb + rc, d = ra + rb;
    const double cx = 0.5 * (d + (p0 - q0) * (p0 + q0) / d);
    const double cy = std::sqrt(std::max(p0 * p0 - cx * cx, 0.0));
    const Point2 corners[] = {{0.0, 0.0}, {d, 0.0}, {cx, cy}};
    Circle circles[3];
    for (int k = 0; k < 3; ++k) {
        const Point2 place{p.limits.origin.x + corners[k].x - (d + cx) / 3.0,
                           p.limits.origin.y + corners[k].y - cy / 3.0};
        circles[k] = {place, {2.0 * p.drawn[k], 0.0, 2.0 * p.drawn[k]}};
    }
    return start(p, circles);
}

/// Shall the front go on at its edge (2.4)?
///
/// It shall when the segment meets the box (separating axes), and its middle lies within the
/// largest distance from the origin.
bool is_within(const Packing& p, FrontEdge edge) {
    const PackingLimits& limits = p.limits;
    const Point2 low = limits.low, high = limits.high;
    const Point2 a = p.t.xy[edge.a], b = p.t.xy[edge.b];
    const Point2 d = 0.5 * (a + b) - limits.origin;
    if (d.x * d.x + d.y * d.y > limits.distance * limits.distance) return false;
    if (std::max(a.x, b.x) < low.x || std::min(a.x, b.x) > high.x || std::max(a.y, b.y) < low.y ||
        std::min(a.y, b.y) > high.y)
        return false;
    const Point2 n{b.y - a.y, a.x - b.x}, centre = 0.5 * (low + high);
    const double middle = n.x * (centre.x - a.x) + n.y * (centre.y - a.y);
    const double reach =
        0.5 * (std::abs(n.x) * (high.x - low.x) + std::abs(n.y) * (high.y - low.y));
    return std::abs(middle) <= reach;
}

/// Is the outer triangle of a -> b a corner of the front so narrow that no circle fits in?
bool is_narrow_corner(const Packing& p, FrontEdge edge) {
    const Triangulation& t = p.t;
    const Vertex apex = outer_apex(p, edge.a);
    if (apex == NIL) return false;
    if (apex == p.front.next(edge.b)) return edge_length(t.xy, t.size, edge.a, apex) < p.narrow;
    if (apex == p.front.prev(edge.a)) return edge_length(t.xy, t.size, apex, edge.b) < p.narrow;
    return false;
}

/// Place the circle that touches those of a and b, moved to where it touches all near ones.
Trial place_fitted(Packing& p, const CircleSizes& sizes, FrontEdge edge,
                   const FittedCircle& fitted) {
    const Trial opened = open_for(p, edge, fitted.circle);
    if (!opened.possible) return opened;
    const auto [nearest, step] = relax_against_neighbours(p.t, edge, fitted.circle, OVERLAP);
    if (nearest != NIL) return {false, nearest};
    Circle circle = fitted.circle;
    const Point2 relaxed = circle.centre + step;
    if ((step.x != 0.0 || step.y != 0.0) && is_rim_visible(p.t, relaxed))
        circle = {relaxed, sizes.along(relaxed, p.t.xy[edge.b] - p.t.xy[edge.a])};
    place(p, edge, circle, fitted.closeness);
    return {true, NIL};
}

/// Pushing out: the support grows from (a, b) to the circle in the way (2.3.3).
bool place_tangent(Packing& p, const CircleSizes& sizes, FrontEdge edge, Vertex other,
                   Point2 start) {
    const auto [circle, r] = fit_to_three(p.t, sizes, edge, other, start, p.counts.steps);
    if (!(TANGENT_FROM < r && r < TANGENT_TO)) return false;
    if (!(orient(p.t.xy[edge.a], p.t.xy[edge.b], circle.centre) < 0.0)) return false;
    if (!open_for(p, edge, circle).possible) return false;
    if (relax_against_neighbours(p.t, edge, circle, TANGENT_OVERLAP * r).nearest != NIL)
        return false;
    place(p, edge, circle, 2.0 * r - 1.0);
    ++p.counts.tangents;
    return true;
}

/// One step of the front at an edge (2.3). Returns false when the edge has to wait.
///
/// ``forced``: all edges wait; do what is valid although it is not good.
bool advance(Packing& p, const CircleSizes& sizes, FrontEdge edge, bool forced) {
    if (is_narrow_corner(p, edge)) return close_corner(p, edge);
    const FittedCircle fitted = fit_to_two(p.t, sizes, edge, p.counts.steps);
    ++p.counts.fits;
    const auto [placed, other] = place_fitted(p, sizes, edge, fitted);
    if (placed) return true;
    if (other != NIL && other != edge.a && other != edge.b &&
        place_tangent(p, sizes, edge, other, fitted.circle.centre))
        return true;
    if (close_corner(p, edge)) return true;
    if (!forced) return false;
    if (outer_apex(p, edge.a) != NIL) return close_first_corner(p, edge.b);
    // on the hull nothing is in the way but circles that are too near: overlap them
    const FittedCircle again = fit_to_two(p.t, sizes, edge, p.counts.steps);
    if (!open_for(p, edge, again.circle).possible) return false;
    place(p, edge, again.circle, again.closeness);
    return true;
}

/// After a whole round of waiting edges: queue them anew. False when nothing has moved although
/// all that is valid was allowed.
bool queue_waiting(Packing& p) {
    if (p.is_forcing && p.moves == 0) return false;
    p.is_forcing = p.moves == 0;
    p.counts.forced += p.is_forcing;
    p.moves = 0;
    for (const FrontEdge edge : p.waiting)
        if (p.front.has(edge)) queue(p, edge);
    p.waiting.clear();
    return true;
}

/// The edge goes back to the queue after a move elsewhere, or waits without one.
void note(Packing& p, FrontEdge edge, bool moved) {
    if (!moved) {
        p.waiting.push_back(edge);
        return;
    }
    ++p.moves;
    p.is_forcing = false;
    if (p.front.has(edge)) queue(p, edge);
}

/// Advance the front, edge by edge, until there is no more to do (2.4).
///
/// ``step(edge, forced)`` makes one move, ``is_ready()`` says whether there may be another.
template <class IsReady, class Step>
PackingEnd run(Packing& p, const Watch& watch, IsReady is_ready, Step step) {
    const Point2 origin = p.limits.origin;
    for (std::int64_t looked = 1;; ++looked) {
        if (p.t.vertices() >= p.limits.wanted) return {PackingStatus::finished, origin};
        if (p.t.vertices() >= MOST_CIRCLES) return {PackingStatus::too_many, origin};
        if (looked % BETWEEN_LOOKS == 0 && watch && !watch(p.t.vertices()))
            return {PackingStatus::stopped, origin};
        if (p.heap.empty()) {
            if (p.waiting.empty()) return {PackingStatus::finished, origin};
            const FrontEdge first = p.waiting[0];
            if (queue_waiting(p)) continue;
            return {PackingStatus::stuck, 0.5 * (p.t.xy[first.a] + p.t.xy[first.b])};
        }
        const FrontEdge edge = p.heap.pop().edge;
        if (!p.front.has(edge) || !is_within(p, edge)) continue;
        if (!is_ready()) return {PackingStatus::stopped, origin};
        note(p, edge, step(edge, p.is_forcing));
    }
}

}  // namespace

Packing empty_packing(const PackingLimits& limits, std::size_t expected) {
    Packing p;
    p.limits = limits;
    const std::size_t room = expected + expected / 10 + 1000;
    p.t.reserve(room);
    p.front.links.reserve(room);
    p.radius.reserve(room);
    return p;
}

PackingEnd advance_front(Packing& p, const CircleSizes& sizes, const Watch& watch) {
    return run(
        p, watch, [] { return true; },
        [&](FrontEdge edge, bool forced) { return advance(p, sizes, edge, forced); });
}

Packing pack(const CircleSizes& sizes, const PackingLimits& limits, std::size_t expected,
             const Watch& watch) {
    Packing p = empty_packing(limits, expected);
    p.end = {start_at(p, sizes), limits.origin};
    if (p.end.status != PackingStatus::finished) return p;
    p.end = advance_front(p, sizes, watch);
    return p;
}

Packing pack_discs(const Draw& draw, const PackingLimits& limits, std::size_t expected,
                   const Watch& watch) {
    Packing p = empty_packing(limits, expected);
    const auto draw_some = [&] {
        const std::size_t drawn = p.drawn.size();
        return draw(std::max(drawn / 2, expected + expected / 10 + 1000 + LOOK_AHEAD), p.drawn);
    };
    const auto is_ready = [&] {
        const auto needed = static_cast<std::size_t>(p.t.vertices() + LOOK_AHEAD);
        return p.drawn.size() >= needed || (draw_some() && p.drawn.size() >= needed);
    };
    p.end = {PackingStatus::stopped, limits.origin};
    if (!draw_some() || p.drawn.size() < 3) return p;
    p.end.status = start_discs(p);
    if (p.end.status != PackingStatus::finished) return p;
    p.end = run(p, watch, is_ready,
                [&](FrontEdge edge, bool forced) { return advance_disc(p, edge, forced); });
    return p;
}

}  // namespace surfmesh
