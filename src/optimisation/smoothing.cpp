#include "optimisation/smoothing.hpp"

namespace surfmesh {
namespace {

constexpr double LEAST_SHAPE = 0.6;   // a move may lower the worst alpha, but not below this
constexpr double LONGEST_STEP = 0.3;  // of the wanted edge length
constexpr double STILL =
    0.02;  // a vertex that moves less (unit lengths) leaves its neighbours alone
constexpr double SMALLEST_MOVE = 1e-4;  // in unit lengths: shorter steps are not made
constexpr double HALF_INVERSE_ROOT_3 = 0.28867513459481287;

/// Gradient and Hessian of the energy of a star.
struct Energy {
    double gx = 0.0, gy = 0.0, a11 = 0.0, a12 = 0.0, a22 = 0.0;

    /// (1 / alpha)^2 / 2 of a triangle with edges p and q from the vertex. Returns alpha.
    double add_triangle(Point2 p, Point2 q, double area) {
        const double total =
            2.0 * (p.x * p.x + p.y * p.y + q.x * q.x + q.y * q.y - p.x * q.x - p.y * q.y);
        const double i = 1.0 / area;
        const double f = HALF_INVERSE_ROOT_3 * total * i;  // 1 / alpha = total / (2 sqrt 3 area)
        const Point2 t = {-2.0 * (p.x + q.x), -2.0 * (p.y + q.y)};  // gradient of total
        const Point2 r = {p.y - q.y, q.x - p.x};                    // gradient of area
        const double c = HALF_INVERSE_ROOT_3 * i * f;
        gx += c * (t.x - total * r.x * i);
        gy += c * (t.y - total * r.y * i);
        a11 += c * (4.0 - 2.0 * t.x * r.x * i + 2.0 * total * r.x * r.x * i * i);
        a12 += c * (-(t.x * r.y + t.y * r.x) * i + 2.0 * total * r.x * r.y * i * i);
        a22 += c * (4.0 - 2.0 * t.y * r.y * i + 2.0 * total * r.y * r.y * i * i);
        return 1.0 / f;
    }

    /// stiffness (l - 1)^2 of the edge p from the vertex, d long, in units of ``scale``.
    void add_edge(Point2 p, double d, double scale, double stiffness) {
        const double l = d / scale;
        const Point2 n = {p.x / d, p.y / d};
        const double k = 2.0 * stiffness / (scale * scale);
        const double across = std::max(k * (l - 1.0) / l, 0.0);
        gx -= k * scale * (l - 1.0) * n.x;
        gy -= k * scale * (l - 1.0) * n.y;
        a11 += k * n.x * n.x + across * n.y * n.y;
        a12 += (k - across) * n.x * n.y;
        a22 += k * n.y * n.y + across * n.x * n.x;
    }

    /// The step to the minimum of the quadric, none where the Hessian is not positive definite.
    [[nodiscard]] Point2 step() const {
        const double det = a11 * a22 - a12 * a12;
        if (!(det > 0.0)) return {0.0, 0.0};
        const Point2 found = {-(a22 * gx - a12 * gy) / det, -(a11 * gy - a12 * gx) / det};
        const double length = norm(found);
        return length > LONGEST_STEP ? LONGEST_STEP / length * found : found;
    }
};

/// The mean size of p and v, in units of that of v, along the edge from v to p, d long there.
double mean_size(const SurfaceFrames& s, Vertex v, Vertex p, double d) {
    if (!s.is_anisotropic) return 0.5 * (1.0 + s.size[p] / s.size[v]);
    return 0.5 * (1.0 + d / std::max(norm(chord(s, p, v)), 1e-3 * d));
}

/// Smallest alpha around v, or -1 when a triangle is not positively oriented.
double worst_in_star(const Triangulation& t, const SurfaceFrames& s, Vertex v, HalfEdge start) {
    double worst = 1.0;
    HalfEdge e = start;
    do {
        const Vertex p = t.tri[next_half_edge(e)], q = t.tri[prev_half_edge(e)];
        if (orient(t.xy, v, p, q) <= 0.0) return -1.0;
        if (!coincide(s, p, q)) worst = std::min(worst, triangle_shape(s, v, p, q));
        e = rotate_ccw(t, e);
    } while (e != start);
    return worst;
}

/// Move v by ``step`` in its unit tangent plane, unless a triangle turns over or a bad star worse.
bool move(Triangulation& t, SurfaceFrames& s, Vertex v, HalfEdge start, const NewtonStep& by) {
    const Point2 xy = t.xy[v];
    const Point3 point = s.point[v];
    const SizeTensor h = t.size[v];
    t.xy[v] = {xy.x + h.xx * by.step.x + h.xy * by.step.y,
               xy.y + h.xy * by.step.x + h.yy * by.step.y};
    s.point[v] = point + lift(s, v, by.step);
    const double worst = worst_in_star(t, s, v, start);
    if (!(worst < by.worst && worst < LEAST_SHAPE)) return true;
    t.xy[v] = xy;
    s.point[v] = point;
    return false;
}

}  // namespace

NewtonStep newton_step(const Triangulation& t, const SurfaceFrames& s, Vertex v, HalfEdge start,
                       double stiffness) {
    Energy energy;
    double worst = 1.0;
    HalfEdge e = start;
    Point2 to_p = chord(s, v, t.tri[next_half_edge(e)]);
    do {
        const Vertex p = t.tri[next_half_edge(e)], q = t.tri[prev_half_edge(e)];
        const Point2 to_q = chord(s, v, q);
        e = rotate_ccw(t, e);
        if (coincide(s, p, q)) continue;  // will collapse: neither shape nor a second edge
        const double area = to_p.x * to_q.y - to_p.y * to_q.x;  // twice the area
        if (area <= 0.0) return {{0.0, 0.0}, -1.0};
        worst = std::min(worst, energy.add_triangle(to_p, to_q, area));
        const double d = norm(to_p);
        energy.add_edge(to_p, d, mean_size(s, v, p, d), stiffness);
        to_p = to_q;
    } while (e != start);
    return {energy.step(), worst};
}

void smooth(Triangulation& t, SurfaceFrames& s, const Background& background, const Stars& stars,
            VertexMarks& marks, double stiffness, Array<Vertex>& moved) {
    moved.clear();
    for (Vertex v = 0; v < t.vertices(); ++v) {
        const HalfEdge start = stars.start[v];
        if (marks.active[v] == 0 || stars.frozen[v] != 0 || start == NIL) continue;
        marks.active[v] = 0;
        const NewtonStep by = newton_step(t, s, v, start, stiffness);
        const double squared = dot(by.step, by.step);
        if (squared < SMALLEST_MOVE * SMALLEST_MOVE || !move(t, s, v, start, by)) continue;
        s.size[v] = s.scale[v] * background.scalar_size_at(t.xy[v].x, t.xy[v].y);
        moved.push_back(v);
        marks.dirty[v] = 1;
        if (squared > STILL * STILL) {
            marks.active[v] = 1;
            for_each_in_star(t, start,
                             [&](HalfEdge e) { marks.active[t.tri[next_half_edge(e)]] = 1; });
        }
    }
}

}  // namespace surfmesh
