#include "optimisation/smoothing.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace surfmesh {
namespace {

constexpr double LEAST_SHAPE = 0.6;   // a move may lower the worst alpha, but not below this
constexpr double LONGEST_STEP = 0.3;  // of the wanted edge length
constexpr double STILL =
    0.02;  // a vertex that moves less (unit lengths) leaves its neighbours alone
constexpr double SMALLEST_MOVE = 1e-4;  // in unit lengths: shorter steps are not made
constexpr double HALF_INVERSE_ROOT_3 = 0.28867513459481287;

/// Edges of a star that are looked at together, so that a compiler can compute several at a time.
constexpr std::size_t CHUNK = 8;
using Numbers = std::array<double, CHUNK>;

/// A part of the star of v: edges p from v, each with the next one q on its left.
struct StarPart {
    std::size_t count = 0;
    Numbers px, py, qx, qy;
    Numbers scale;  // mean size of the ends of p, in units of that of v

    void add(Point2 p, Point2 q, double mean_size) {
        px[count] = p.x;
        py[count] = p.y;
        qx[count] = q.x;
        qy[count] = q.y;
        scale[count++] = mean_size;
    }
};

/// What single triangles or edges add to the gradient and the Hessian.
struct EnergyTerms {
    Numbers gx, gy, a11, a12, a22;
};

/// Terms of (1 / alpha)^2 / 2 of the triangles p, q, and 1 / alpha.
void triangle_terms(const StarPart& part, EnergyTerms& e, Numbers& inverse_alpha, Numbers& area) {
    for (std::size_t k = 0; k < CHUNK; ++k) {
        const double px = part.px[k], py = part.py[k], qx = part.qx[k], qy = part.qy[k];
        area[k] = px * qy - py * qx;  // twice the area
        const double total = 2.0 * (px * px + py * py + qx * qx + qy * qy - px * qx - py * qy);
        const double i = 1.0 / area[k];
        const double f = HALF_INVERSE_ROOT_3 * total * i;  // 1 / alpha = total / (2 sqrt 3 area)
        const double tx = -2.0 * (px + qx), ty = -2.0 * (py + qy);  // gradient of total
        const double rx = py - qy, ry = qx - px;                    // gradient of area
        const double c = HALF_INVERSE_ROOT_3 * i * f;
        inverse_alpha[k] = f;
        e.gx[k] = c * (tx - total * rx * i);
        e.gy[k] = c * (ty - total * ry * i);
        e.a11[k] = c * (4.0 - 2.0 * tx * rx * i + 2.0 * total * rx * rx * i * i);
        e.a12[k] = c * (-(tx * ry + ty * rx) * i + 2.0 * total * rx * ry * i * i);
        e.a22[k] = c * (4.0 - 2.0 * ty * ry * i + 2.0 * total * ry * ry * i * i);
    }
}

/// Terms of stiffness (l - 1)^2 of the edges p; the gradient is to be taken off.
void edge_terms(const StarPart& part, double stiffness, EnergyTerms& e) {
    for (std::size_t k = 0; k < CHUNK; ++k) {
        const double px = part.px[k], py = part.py[k], scale = part.scale[k];
        const double d = std::sqrt(px * px + py * py);
        const double l = d / scale;
        const double nx = px / d, ny = py / d;
        const double stiff = 2.0 * stiffness / (scale * scale);
        const double bend = stiff * (l - 1.0) / l;
        const double across = 0.5 * (bend + std::abs(bend));  // its maximum with 0, exactly
        e.gx[k] = stiff * scale * (l - 1.0) * nx;
        e.gy[k] = stiff * scale * (l - 1.0) * ny;
        e.a11[k] = stiff * nx * nx + across * ny * ny;
        e.a12[k] = (stiff - across) * nx * ny;
        e.a22[k] = stiff * ny * ny + across * nx * nx;
    }
}

/// Gradient and Hessian of the energy of a star, and the largest 1 / alpha in it.
struct Energy {
    double gx = 0.0, gy = 0.0, a11 = 0.0, a12 = 0.0, a22 = 0.0, inverse_alpha = 0.0;

    /// Add a part of the star, which is emptied; false where a triangle is turned over.
    bool add(StarPart& part, double stiffness) {
        EnergyTerms of_triangle, of_edge;
        Numbers inverse, area;
        for (std::size_t k = part.count; k < CHUNK; ++k) {  // what is computed for nothing
            part.px[k] = part.qy[k] = part.scale[k] = 1.0;
            part.py[k] = part.qx[k] = 0.0;
        }
        triangle_terms(part, of_triangle, inverse, area);
        edge_terms(part, stiffness, of_edge);
        for (std::size_t k = 0; k < part.count; ++k) {
            if (area[k] <= 0.0) return false;
            inverse_alpha = std::max(inverse_alpha, inverse[k]);
            gx = gx + of_triangle.gx[k] - of_edge.gx[k];
            gy = gy + of_triangle.gy[k] - of_edge.gy[k];
            a11 = a11 + of_triangle.a11[k] + of_edge.a11[k];
            a12 = a12 + of_triangle.a12[k] + of_edge.a12[k];
            a22 = a22 + of_triangle.a22[k] + of_edge.a22[k];
        }
        part.count = 0;
        return true;
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

/// The mean size of p and v, in units of that of v, along the edge from v to p.
double mean_size(const SurfaceFrames& s, Vertex v, Vertex p, Point2 edge) {
    if (!s.is_anisotropic) return 0.5 * (1.0 + s.size[p] / s.size[v]);
    const double d = norm(edge);
    return 0.5 * (1.0 + d / std::max(norm(chord(s, p, v)), 1e-3 * d));
}

/// Is a triangle at v not positive, or one of less alpha than ``least``?
bool is_spoilt(const Triangulation& t, const SurfaceFrames& s, Vertex v, HalfEdge start,
               double least) {
    HalfEdge e = start;
    do {
        const Vertex p = t.tri[next_half_edge(e)], q = t.tri[prev_half_edge(e)];
        if (orient(t.xy, v, p, q) <= 0.0) return true;
        if (!coincide(s, p, q) && is_shape_below(s, v, p, q, least)) return true;
        e = rotate_ccw(t, e);
    } while (e != start);
    return false;
}

/// Move v by ``step`` in its unit tangent plane, unless a triangle turns over or a bad star worse.
bool move(Triangulation& t, SurfaceFrames& s, Vertex v, HalfEdge start, const NewtonStep& by) {
    const Point2 xy = t.xy[v];
    const Point3 point = s.point[v];
    const SizeTensor h = t.size[v];
    t.xy[v] = {xy.x + h.xx * by.step.x + h.xy * by.step.y,
               xy.y + h.xy * by.step.x + h.yy * by.step.y};
    s.point[v] = point + lift(s, v, by.step);
    if (!is_spoilt(t, s, v, start, std::min(by.worst, LEAST_SHAPE))) return true;
    t.xy[v] = xy;
    s.point[v] = point;
    return false;
}

}  // namespace

NewtonStep newton_step(const Triangulation& t, const SurfaceFrames& s, Vertex v, HalfEdge start,
                       double stiffness) {
    Energy energy;
    StarPart part;
    HalfEdge e = start;
    Point2 to_p = chord(s, v, t.tri[next_half_edge(e)]);
    do {
        const Vertex p = t.tri[next_half_edge(e)], q = t.tri[prev_half_edge(e)];
        const Point2 to_q = chord(s, v, q);
        e = rotate_ccw(t, e);
        if (coincide(s, p, q)) continue;  // will collapse: neither shape nor a second edge
        part.add(to_p, to_q, mean_size(s, v, p, to_p));
        if (part.count == CHUNK && !energy.add(part, stiffness)) return {{0.0, 0.0}, -1.0};
        to_p = to_q;
    } while (e != start);
    if (part.count > 0 && !energy.add(part, stiffness)) return {{0.0, 0.0}, -1.0};
    return {energy.step(), std::min(1.0, 1.0 / energy.inverse_alpha)};
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
        set_size(t, s, background, v);
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
