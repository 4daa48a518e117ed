#include "optimisation/worst_shapes.hpp"

#include "optimisation/best_way.hpp"
#include "optimisation/marked_triangles.hpp"

namespace surfmesh {
namespace {

constexpr WayLimits RAISING_LIMITS{0.16, 0.02, 0.5};
constexpr double GAIN = 2e-3;  // least gain of alpha for a step

/// The smallest alpha in the star of v; -1 where a triangle is not positive in the plane.
double smallest_shape(const Triangulation& t, const SurfaceFrames& s, Vertex v, HalfEdge start) {
    double smallest = 1.0;
    HalfEdge e = start;
    do {
        const Vertex p = t.tri[next_half_edge(e)], q = t.tri[prev_half_edge(e)];
        if (orient(t.xy, v, p, q) <= 0.0) return -1.0;
        if (!coincide(s, p, q)) smallest = std::min(smallest, triangle_shape(s, v, p, q));
        e = rotate_ccw(t, e);
    } while (e != start);
    return smallest;
}

/// Move v until no triangle of its star is below ``least``, or to where it is best; the length of
/// its way, unit lengths.
double move_to_best(Triangulation& t, SurfaceFrames& s, Vertex v, HalfEdge start, double least) {
    const Position from(t, s, v);
    const auto energy_at = [&](Point2 trial, double /*least*/) {
        from.place(t, s, trial);
        return -smallest_shape(t, s, v, start);
    };
    const Point2 way = find_best_way(RAISING_LIMITS, -smallest_shape(t, s, v, start), -least,
                                     energy_at, [](double energy) { return energy - GAIN; });
    from.place(t, s, way);
    return norm(way);
}

}  // namespace

void raise_worst(Triangulation& t, SurfaceFrames& s, const Stars& stars, VertexMarks& marks,
                 double least, Array<Vertex>& moved) {
    moved.clear();
    const auto raise = [&](Triangle k) {
        for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e) {
            const Vertex a = t.tri[3 * k], b = t.tri[3 * k + 1], c = t.tri[3 * k + 2], v = t.tri[e];
            if (is_collapsed(s, a, b, c) || !is_shape_below(s, a, b, c, least)) break;
            if (stars.frozen[v] != 0 || stars.start[v] == NIL) continue;
            const double length = move_to_best(t, s, v, stars.start[v], least);
            record_move(s, marks, v, length, moved);
        }
    };
    if (t.parts.empty()) {
        for (Triangle k = 0; k < t.triangles(); ++k)
            if (t.region[k] != DEAD) raise(k);
    } else {
        for (const Triangle k : triangles_below(t, s, least)) raise(k);
    }
}

}  // namespace surfmesh
