#include "packing/circle_fitting.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh {
namespace {

constexpr double CLOSENESS = 0.98;  // beta1 beta2 above which a fit is accepted (2.3.2)
constexpr int FIT_STEPS = 8;
constexpr double NEIGHBOURS_WITHIN = 1.4;  // circles nearer than this are neighbours of a new one
constexpr double TOUCHED_WITHIN = 0.08;    // a neighbour at 1 -+ this is touched well enough

/// The metric distance of a point from a vertex.
struct Distance {
    double length;
    Point2 step;      // to the point, in the metric
    SizeTensor mean;  // of the two sizes

    [[nodiscard]] Point2 gradient() const {
        return solve(mean, {step.x / length, step.y / length});
    }
};

Distance distance_from(const Triangulation& t, Vertex v, Point2 p, SizeTensor h) {
    const SizeTensor mean = 0.5 * (h + t.size[v]);
    const Point2 step = solve(mean, p - t.xy[v]);
    return {norm(step), step, mean};
}

/// Step from the middle of an edge d to the apex on its right, both sides unit.
Point2 apex_of(SizeTensor h, Point2 d) {
    const Point2 u = solve(h, d);
    const double base = norm(u);
    const double height = std::sqrt(std::max(1.0 - 0.25 * base * base, 0.25)) / base;
    return apply(h, {u.y * height, -u.x * height});
}

}  // namespace

FittedCircle fit_to_two(const Triangulation& t, const CircleSizes& sizes, FrontEdge edge,
                        std::int64_t& steps) {
    const Point2 a = t.xy[edge.a], b = t.xy[edge.b];
    Point2 p = 0.5 * (a + b) + apex_of(0.5 * (t.size[edge.a] + t.size[edge.b]), b - a);
    FittedCircle best{{p, t.size[edge.a]}, -1.0};
    for (int step = 0; step < FIT_STEPS; ++step) {
        const SizeTensor h = sizes.along(p, b - a);
        ++steps;
        const Distance to_a = distance_from(t, edge.a, p, h), to_b = distance_from(t, edge.b, p, h);
        const double la = to_a.length, lb = to_b.length;
        const double close = std::min(la, 1.0 / la) * std::min(lb, 1.0 / lb);
        if (close > best.closeness) best = {{p, h}, close};
        if (close > CLOSENESS) break;
        const Point2 ga = to_a.gradient(), gb = to_b.gradient();
        const double det = ga.x * gb.y - ga.y * gb.x;
        if (std::abs(det) < 1e-3 * (std::abs(ga.x * gb.y) + std::abs(ga.y * gb.x))) break;
        const double ra = 1.0 - la, rb = 1.0 - lb;
        p.x += (gb.y * ra - ga.y * rb) / det;
        p.y += (ga.x * rb - gb.x * ra) / det;
        // stay on the right of a -> b: outside the front
        if ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) >= 0.0) break;
    }
    return best;
}

TangentCircle fit_to_three(const Triangulation& t, const CircleSizes& sizes, FrontEdge edge,
                           Vertex c, Point2 start, std::int64_t& steps) {
    const Point2 way = t.xy[edge.b] - t.xy[edge.a];
    Point2 p = start;
    SizeTensor h = sizes.along(p, way);
    for (int step = 0; step < FIT_STEPS; ++step) {
        const Distance to_a = distance_from(t, edge.a, p, h), to_b = distance_from(t, edge.b, p, h),
                       to_c = distance_from(t, c, p, h);
        const double la = to_a.length, lb = to_b.length, lc = to_c.length;
        if (la < 1e-12 || lb < 1e-12 || lc < 1e-12) return {{p, h}, 0.0};
        const double r = (la + lb + lc) / 3.0;
        const double off = std::max(std::max(std::abs(la - r), std::abs(lb - r)), std::abs(lc - r));
        if (off < 0.01 * r) return {{p, h}, r};
        // (ga - gb) d = lb - la, (ga - gc) d = lc - la
        const Point2 ga = to_a.gradient();
        const Point2 m0 = ga - to_b.gradient(), m1 = ga - to_c.gradient();
        const double det = m0.x * m1.y - m0.y * m1.x;
        if (std::abs(det) < 1e-6 * (std::abs(m0.x * m1.y) + std::abs(m0.y * m1.x)))
            return {{p, h}, 0.0};
        p.x += (m1.y * (lb - la) - m0.y * (lc - la)) / det;
        p.y += (m0.x * (lc - la) - m1.x * (lb - la)) / det;
        h = sizes.along(p, way);
        ++steps;
    }
    return {{p, h}, 0.0};
}

Relaxation relax_against_neighbours(const Triangulation& t, FrontEdge edge, const Circle& circle,
                                    double reach) {
    Vertex nearest = NIL;
    double shortest = reach;
    bool crowded = false;
    SizeTensor n{0.0, 0.0, 0.0};  // normal equations n step = g
    Point2 g{0.0, 0.0};
    for (const HalfEdge e : t.rim) {
        const Vertex v = t.tri[e];
        if (v == NIL) continue;
        const SizeTensor m = 0.5 * (circle.size + t.size[v]);
        const double det = determinant(m);
        const Point2 u = solve(m, circle.centre - t.xy[v]);
        const double l = norm(u);
        if (l >= NEIGHBOURS_WITHIN) continue;
        if (v != edge.a && v != edge.b) {
            if (l < shortest) {
                shortest = l;
                nearest = v;
            }
            if (std::abs(l - 1.0) > TOUCHED_WITHIN) crowded = true;
        }
        const double i = 1.0 / (l * det);
        const double gx = (m.yy * u.x - m.xy * u.y) * i, gy = (m.xx * u.y - m.xy * u.x) * i;
        n = n + SizeTensor{gx * gx, gx * gy, gy * gy};
        g = g + Point2{gx * (1.0 - l), gy * (1.0 - l)};
    }
    const double det = determinant(n);
    if (!crowded || !(det > 1e-12 * n.xx * n.yy)) return {nearest, {0.0, 0.0}};
    return {nearest, {(n.yy * g.x - n.xy * g.y) / det, (n.xx * g.y - n.xy * g.x) / det}};
}

}  // namespace surfmesh
