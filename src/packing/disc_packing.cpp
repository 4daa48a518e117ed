#include "packing/disc_packing.hpp"

#include <algorithm>

#include "packing/disc_fitting.hpp"
#include "packing/front_moves.hpp"

namespace surfmesh {
namespace {

constexpr double TOLERATED = 0.02;  // overlap that is let pass, of the sum of the two radii
constexpr int PUSHES = 9;           // most circles of the polygon that is left over (2.3.3)
constexpr double GROWN = 5.0;  // a circle may grow by this to touch three, if the smallest of four
constexpr double NEARLY = 1.25;  // got over drawn radius, or the reverse, of one that touches three
constexpr int SHRINKS = 24;      // last resort: smaller circles
constexpr double SHRINK = 0.8;

enum class Outcome {
    placed,
    moved,    // the polygon was handed over, its circle is not placed yet
    refused,  // a circle is in the way; the support a when it is none, but the place is of no use
};

struct DiscTrial {
    Outcome outcome;
    Vertex in_the_way = NIL;

    [[nodiscard]] bool has_moved() const { return outcome != Outcome::refused; }
};

Circle circle_of(Disc disc) { return {disc.centre, {2.0 * disc.r, 0.0, 2.0 * disc.r}}; }

Vertex place_disc(Packing& p, FrontEdge edge, Disc disc) {
    return place(p, edge, circle_of(disc), disc.r / p.drawn[p.t.vertices()]);
}

/// Where the gap between a and b is too wide for the next radius, a later one goes first.
void draw_one_that_spans(Packing& p, FrontEdge edge) {
    const double least = 0.55 * gap_between(p.t, edge.a, edge.b);
    const Vertex n = p.t.vertices();
    for (Vertex k = n; k < n + LOOK_AHEAD; ++k) {
        if (!(p.drawn[k] >= least)) continue;
        std::swap(p.drawn[n], p.drawn[k]);
        return;
    }
}

/// Hand over the polygon between the front from a to b and the edge a-b, if there is one.
void close_up(Packing& p, Vertex a, Vertex b) {
    const int steps = steps_between(p.front, a, b, POCKET);
    if (steps > 1) close_pocket(p, a, steps);
}

/// Place a disc supported by a and b if nothing is in the way; e: an outer half-edge between them.
DiscTrial try_disc(Packing& p, HalfEdge e, FrontEdge support, Disc disc) {
    const auto [a, b] = support;
    Triangulation& t = p.t;
    const Vertex beside = overlapped_of(t, p.front.prev(a), p.front.next(b),
                                        t.tri[prev_half_edge(e)], disc, TOLERATED);
    if (beside != NIL && beside != a && beside != b)
        return {Outcome::refused,
                beside};  // most often a neighbour on the front: nothing is opened
    const Location found = locate(t, e, disc.centre, true);
    if (found.barrier != NIL) {
        const Vertex v = t.tri[found.barrier];
        const bool is_support = v == a || v == b;
        return {Outcome::refused, is_support ? t.tri[next_half_edge(found.barrier)] : v};
    }
    if (!open_cavity(t, found.triangle, disc.centre, circle_of(disc).size, true))
        return {Outcome::refused, a};
    const Vertex other = overlapped_around(p, support, disc, TOLERATED);
    if (other != NIL) return {Outcome::refused, other};
    Vertex base = a;  // an edge of the front between a and b that the new circle sees
    while (t.mark[outer_edge(p, base) / 3] != t.search) {
        base = p.front.next(base);
        if (base != b) continue;
        const int steps = steps_between(p.front, a, b, POCKET);
        if (steps > 1 && close_pocket(p, a, steps)) return {Outcome::moved};
        return {Outcome::refused, a};
    }
    const Vertex v = place_disc(p, {base, p.front.next(base)}, disc);
    close_up(p, a, v);
    close_up(p, v, b);
    return {Outcome::placed};
}

/// Try the circle that touches a, b and the one across, if that is a little larger (2.2).
bool grow_to_three(Packing& p, HalfEdge e, FrontEdge edge, double wanted) {
    const Triangulation& t = p.t;
    const Vertex apex = t.tri[prev_half_edge(e)];
    if (apex == NIL) return false;
    const Disc disc = touch_three(t, edge, apex);
    const double smallest =
        0.5 * std::min(std::min(t.size[edge.a].xx, t.size[edge.b].xx), t.size[apex].xx);
    if (!(wanted < disc.r && disc.r < std::min(GROWN * wanted, smallest))) return false;
    const DiscTrial trial = try_disc(p, e, edge, disc);
    p.counts.tangents += trial.outcome == Outcome::placed;
    return trial.has_moved();
}

/// Try the circle that touches the support and the one in the way, if its radius is near enough.
bool try_tangent(Packing& p, HalfEdge e, FrontEdge support, Vertex other, double wanted) {
    const Disc disc = touch_three(p.t, support, other);
    if (!(wanted < NEARLY * disc.r && disc.r < NEARLY * wanted)) return false;
    const DiscTrial trial = try_disc(p, e, support, disc);
    p.counts.tangents += trial.outcome == Outcome::placed;
    return trial.has_moved();
}

/// Fit the circle to a and b; push the support out until nothing overlaps (2.3.3).
bool push_out(Packing& p, HalfEdge e, FrontEdge edge, double wanted) {
    bool moved = false;
    FrontEdge support = edge;  // (m - q, m + p)
    for (int push = 0; push < PUSHES; ++push) {
        ++p.counts.fits;
        const auto [outcome, other] = try_disc(p, e, support, touch_two(p.t, support, wanted));
        if (outcome == Outcome::placed) return true;
        if (outcome == Outcome::moved) {
            moved = true;
            e = outer_edge(p, support.a);
            continue;
        }
        if (other == support.a || other == support.b) break;
        if (try_tangent(p, e, support, other, wanted)) return true;
        if (steps_between(p.front, support.b, other, POCKET) > 0)
            support.b = other;
        else if (steps_between(p.front, other, support.a, POCKET) > 0)
            support.a = other;
        else
            break;
    }
    if (moved && p.front.has(support)) queue(p, support);
    return moved;
}

/// Place a smaller circle, or at last one of the drawn radius whatever it overlaps.
bool place_smaller(Packing& p, HalfEdge e, FrontEdge edge, double wanted) {
    double smaller = wanted;
    for (int shrink = 0; shrink < SHRINKS; ++shrink) {
        if (try_disc(p, e, edge, touch_two(p.t, edge, smaller)).has_moved()) return true;
        smaller *= SHRINK;
    }
    const Disc disc = touch_two(p.t, edge, wanted);
    if (!open_for(p, edge, circle_of(disc)).possible) return false;
    ++p.counts.overlapping;
    place_disc(p, edge, disc);
    return true;
}

}  // namespace

bool advance_disc(Packing& p, FrontEdge edge, bool forced) {
    const auto [a, b] = edge;
    draw_one_that_spans(p, edge);
    const double wanted = p.drawn[p.t.vertices()];
    const HalfEdge e = outer_edge(p, a);
    if (grow_to_three(p, e, edge, wanted) || push_out(p, e, edge, wanted)) return true;
    if (!p.front.has(edge)) return false;  // a part of a polygon was handed over, a-b with it
    const Vertex apex = p.t.tri[prev_half_edge(e)];
    if ((apex == p.front.next(b) && gap_between(p.t, a, apex) < 2.0 * wanted) ||
        (apex == p.front.prev(a) && gap_between(p.t, apex, b) < 2.0 * wanted))
        return close_corner(p, edge);
    if (!forced) return false;
    if (close_corner(p, edge)) return true;
    return apex != NIL ? close_first_corner(p, b) : place_smaller(p, e, edge, wanted);
}

}  // namespace surfmesh
