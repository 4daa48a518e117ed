#include "optimisation/smoothing.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <vector>

#include "triangulation/parts.hpp"

namespace surfmesh {
namespace {

constexpr double LEAST_SHAPE = 0.6;   // a move may lower the worst alpha, but not below this
constexpr double LONGEST_STEP = 0.3;  // of the wanted edge length
// Newton steps are taken longer, so that passes settle sooner; not where sizes depend on the
// direction.
constexpr double OVER_RELAXATION = 1.2;
constexpr double SMALLEST_MOVE = 1e-4;  // in unit lengths: shorter steps are not made
constexpr double GOOD_IN_PLANE = 0.72;  // alpha in the tangent plane: space is not asked
constexpr double HALF_INVERSE_ROOT_3 = 0.28867513459481287;

/// Edges of a star that are looked at together, so that a compiler can compute several at a time.
constexpr std::size_t CHUNK = 8;
using Numbers = std::array<double, CHUNK>;

/// A part of the star of v: edges p from v, each with the next one q on its left.
struct StarPart {
    std::size_t count = 0;
    Numbers px, py, qx, qy;
    Numbers seen;  // from the far end of p: its size; the square of its length where p is stretched

    void add(Point2 p, Point2 q, double from_far_end) {
        px[count] = p.x;
        py[count] = p.y;
        qx[count] = q.x;
        qy[count] = q.y;
        seen[count++] = from_far_end;
    }
    /// Fill the rest with the first edge, to be computed for nothing.
    void fill() {
        for (std::size_t k = count; k < CHUNK; ++k) {
            px[k] = px[0];
            py[k] = py[0];
            qx[k] = qx[0];
            qy[k] = qy[0];
            seen[k] = seen[0];
        }
    }
};

/// Twice the areas of the triangles p, q.
void areas(const StarPart& part, Numbers& area) {
    for (std::size_t k = 0; k < CHUNK; ++k)
        area[k] = part.px[k] * part.qy[k] - part.py[k] * part.qx[k];
}

/// Mean sizes of the ends of the edges p, in the direction of each, in units of that of v.
void mean_sizes(const StarPart& part, const SurfaceFrames& s, Vertex v, Numbers& scale) {
    if (!s.is_anisotropic) {
        const double size = s.size[v];
        for (std::size_t k = 0; k < CHUNK; ++k) scale[k] = 0.5 * (1.0 + part.seen[k] / size);
        return;
    }
    for (std::size_t k = 0; k < CHUNK; ++k) {
        const double px = part.px[k], py = part.py[k], d = std::sqrt(px * px + py * py);
        scale[k] = 0.5 * (1.0 + d / std::max(std::sqrt(part.seen[k]), 1e-3 * d));
    }
}

/// What single triangles and edges add to the gradient and the Hessian.
struct EnergyTerms {
    Numbers gx, gy, a11, a12, a22;
};

/// Terms of (1 / alpha)^2 / 2 of the triangles p, q, and of stiffness (l - 1)^2 of the edges p.
///
/// One division gives the reciprocals of the area, of the length d of p and of the mean size:
/// each is that of their product times the two others.
void energy_terms(const StarPart& part, const Numbers& area, const Numbers& scale, double stiffness,
                  EnergyTerms& e, Numbers& inverse_alpha) {
    for (std::size_t k = 0; k < CHUNK; ++k) {
        const double px = part.px[k], py = part.py[k], qx = part.qx[k], qy = part.qy[k];
        const double square = px * px + py * py, d = std::sqrt(square);
        const double d_scale = d * scale[k];
        const double all = 1.0 / (area[k] * d_scale);
        const double i = all * d_scale;
        const double total = 2.0 * (square + qx * qx + qy * qy - px * qx - py * qy);
        const double f = HALF_INVERSE_ROOT_3 * total * i;  // 1 / alpha = total / (2 sqrt 3 area)
        const double tx = -2.0 * (px + qx), ty = -2.0 * (py + qy);  // gradient of total
        const double rx = (py - qy) * i, ry = (qx - px) * i;        // of area, over area
        const double c = HALF_INVERSE_ROOT_3 * i * f, both = 2.0 * total;
        inverse_alpha[k] = f;

        const double over_d = all * area[k] * scale[k], over_scale = all * area[k] * d;
        const double nx = px * over_d, ny = py * over_d;
        const double stiff = 2.0 * stiffness * over_scale * over_scale;
        const double pull = stiff * (d - scale[k]);
        const double bend = pull * over_d;
        const double across = 0.5 * (bend + std::abs(bend));  // its maximum with 0, exactly
        const double along = stiff - across;
        e.gx[k] = c * (tx - total * rx) - pull * nx;
        e.gy[k] = c * (ty - total * ry) - pull * ny;
        e.a11[k] = c * (4.0 + rx * (both * rx - 2.0 * tx)) + (across + along * nx * nx);
        e.a12[k] = c * (both * rx * ry - (tx * ry + ty * rx)) + along * nx * ny;
        e.a22[k] = c * (4.0 + ry * (both * ry - 2.0 * ty)) + (across + along * ny * ny);
    }
}

/// Gradient and Hessian of the energy of a star, and the largest 1 / alpha in it.
struct Energy {
    double gx = 0.0, gy = 0.0, a11 = 0.0, a12 = 0.0, a22 = 0.0, inverse_alpha = 0.0;

    /// Add a part of the star of v; false where a triangle is turned over.
    bool add(StarPart& part, const SurfaceFrames& s, Vertex v, double stiffness) {
        EnergyTerms terms;
        Numbers inverse, area, scale;
        part.fill();
        areas(part, area);
        if (!(*std::min_element(area.begin(), area.end()) > 0.0)) return false;
        mean_sizes(part, s, v, scale);
        energy_terms(part, area, scale, stiffness, terms, inverse);
        for (std::size_t k = 0; k < part.count; ++k) {
            inverse_alpha = std::max(inverse_alpha, inverse[k]);
            gx += terms.gx[k];
            gy += terms.gy[k];
            a11 += terms.a11[k];
            a12 += terms.a12[k];
            a22 += terms.a22[k];
        }
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

/// What ``mean_sizes`` need of the far end of the edge from v to p.
double seen_from_far_end(const SurfaceFrames& s, Vertex v, Vertex p) {
    if (!s.is_anisotropic) return s.size[p];
    const Point2 back = chord(s, p, v);
    return dot(back, back);
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

/// A vertex that may move, and the star around it: triangles v, p, q in their order.
struct MovingVertex {
    Vertex v;
    HalfEdge start;
    NewtonStep by;
    bool whole = false;  // is all of its star in ``part`` and ``ring``?
    StarPart part;
    std::array<Vertex, CHUNK + 1> ring;  // the first once more at the end
};

/// Find the step of v; what is left of its star in ``part`` is the whole where that is not large.
void find_step(const Triangulation& t, const SurfaceFrames& s, double stiffness, MovingVertex& m) {
    const Vertex v = m.v;
    const Point3 from = s.point[v];
    const TangentMap seen = s.tangent_map[v];
    const auto chord_to = [&](Vertex p) { return apply(seen, s.point[p] - from); };
    Energy energy;
    StarPart& part = m.part;
    part.count = 0;
    m.whole = true;
    m.by = {{0.0, 0.0}, -1.0};
    HalfEdge e = m.start;
    Vertex p = t.tri[next_half_edge(e)];
    Point2 to_p = chord_to(p);
    do {
        if (part.count == CHUNK) {
            m.whole = false;
            if (!energy.add(part, s, v, stiffness)) return;
            part.count = 0;
        }
        const HalfEdge before = prev_half_edge(e);
        const Vertex q = t.tri[before];
        const Point2 to_q = chord_to(q);
        e = t.adj[before];
        if (coincide(s, p, q)) {  // will collapse: neither shape nor a second edge
            m.whole = false;
            p = q;
            continue;
        }
        m.ring[part.count] = p;
        part.add(to_p, to_q, seen_from_far_end(s, v, p));
        p = q;
        to_p = to_q;
    } while (e != m.start);
    if (part.count > 0 && !energy.add(part, s, v, stiffness)) return;
    m.ring[part.count] = p;
    m.by = {energy.step(), std::min(1.0, 1.0 / energy.inverse_alpha)};
}

/// Are all triangles of a whole star surely good after the step, in the tangent plane of v?
bool stays_good(const MovingVertex& m) {
    constexpr double BOUND = GOOD_IN_PLANE * HALF_INVERSE_ROOT_3;
    std::array<double, CHUNK> spare;
    for (std::size_t k = 0; k < CHUNK; ++k) {
        const double px = m.part.px[k] - m.by.step.x, py = m.part.py[k] - m.by.step.y;
        const double qx = m.part.qx[k] - m.by.step.x, qy = m.part.qy[k] - m.by.step.y;
        const double total = 2.0 * (px * px + py * py + qx * qx + qy * qy - px * qx - py * qy);
        spare[k] = px * qy - py * qx - BOUND * total;  // alpha = 2 sqrt 3 area / total
    }
    return *std::min_element(spare.begin(), spare.end()) > 0.0;
}

/// Are all triangles of a whole star positive in the plane, exactly?
bool stays_positive(const Triangulation& t, const MovingVertex& m) {
    for (std::size_t k = 0; k < m.part.count; ++k)
        if (orient(t.xy, m.v, m.ring[k], m.ring[k + 1]) <= 0.0) return false;
    return true;
}

/// Move v by its step in its unit tangent plane, unless a triangle turns over or a bad star worse.
bool move(Triangulation& t, SurfaceFrames& s, const MovingVertex& m) {
    const Vertex v = m.v;
    const Point2 xy = t.xy[v];
    const Point3 point = s.point[v];
    const SizeTensor h = t.size[v];
    const Point2 step = m.by.step;
    t.xy[v] = {xy.x + h.xx * step.x + h.xy * step.y, xy.y + h.xy * step.x + h.yy * step.y};
    s.point[v] = point + lift(s, v, step);
    const bool fine = m.whole && stays_good(m)
                          ? stays_positive(t, m)
                          : !is_spoilt(t, s, v, m.start, std::min(m.by.worst, LEAST_SHAPE));
    if (fine) return true;
    t.xy[v] = xy;
    s.point[v] = point;
    return false;
}

/// A pass over vertices: what it works on, and how far it goes.
struct SmoothingPass {
    Triangulation& t;
    SurfaceFrames& s;
    const Stars& stars;
    VertexMarks& marks;
    double stiffness, longer, still;

    /// Move m.v by a Newton step if it may and should; one that has moved goes to ``moved``.
    void visit(MovingVertex& m, Array<Vertex>& moved) const {
        const Vertex v = m.v;
        m.start = stars.start[v];
        if (marks.active[v] == 0 || stars.frozen[v] != 0 || m.start == NIL) return;
        marks.active[v] = 0;
        find_step(t, s, stiffness, m);
        m.by.step = longer * m.by.step;
        const double squared = dot(m.by.step, m.by.step);
        if (squared < SMALLEST_MOVE * SMALLEST_MOVE || !move(t, s, m)) return;
        s.drift[v] += std::sqrt(squared);
        moved.push_back(v);
        marks.dirty[v] = 1;
        if (squared > still * still) {
            marks.active[v] = 1;
            for_each_in_star(t, m.start, [&](HalfEdge e) {  // by several threads at once
                std::atomic_ref(marks.active[t.tri[next_half_edge(e)]])
                    .store(1, std::memory_order_relaxed);
            });
        }
    }
};

/// Does a vertex before v that is not done yet have a triangle with it? Before ``first`` none is
/// known to be done, from there on all but those of ``waiting``, which are in their order.
bool waits_for_another(const Triangulation& t, Vertex v, HalfEdge start, Vertex first,
                       const Array<Vertex>& waiting) {
    bool waits = false;
    for_each_in_star(t, start, [&](HalfEdge e) {
        const Vertex p = t.tri[next_half_edge(e)];
        waits =
            waits || p < first || (p < v && std::binary_search(waiting.begin(), waiting.end(), p));
    });
    return waits;
}

/// Visit the vertices from ``first`` to ``end`` whose stars lie in several parts, but for those that
/// have to wait for vertices before ``first`` or for each other.
void visit_shared(const SmoothingPass& pass, Vertex first, Vertex end, Array<Vertex>& moved,
                  Array<Vertex>& waiting) {
    const Stars& stars = pass.stars;
    MovingVertex m;
    for (m.v = next_marked(stars.shared, first, end); m.v < end;
         m.v = next_marked(stars.shared, m.v + 1, end)) {
        if (stars.frozen[m.v] != 0 || stars.start[m.v] == NIL) continue;
        if (waits_for_another(pass.t, m.v, stars.start[m.v], first, waiting))
            waiting.push_back(m.v);
        else
            pass.visit(m, moved);
    }
}

/// Visit all those from ``first`` on, one after the other.
void visit_shared_alone(const SmoothingPass& pass, Vertex first, Array<Vertex>& moved) {
    const Vertex end = pass.t.vertices();
    MovingVertex m;
    for (m.v = next_marked(pass.stars.shared, first, end); m.v < end;
         m.v = next_marked(pass.stars.shared, m.v + 1, end))
        pass.visit(m, moved);
}

/// Visit them by several threads as if it were one after the other, by number.
///
/// Each thread has a group of parts. A vertex depends on its neighbours with lower numbers: what has
/// one in a group before its own waits until threads have done the others, and so does what has one
/// that waits. No two threads come upon each other, and little is left for one alone.
///
///     group 0 | group 1       numbers a < d < b < c: b waits for a, and c for b; d does not
///         a --|-- b -- c
///             |     \\ d
void visit_shared_by_threads(const SmoothingPass& pass, Array<Vertex>& moved) {
    const Triangulation& t = pass.t;
    const std::size_t parts = count_parts(t);
    const std::size_t groups = std::min(parts, static_cast<std::size_t>(allowed_threads()));
    const Vertex end = part_of(t, parts - 1).end_vertex;  // what splits have added comes after it
    const auto first_of = [&](std::size_t group) {
        return group == groups ? end : part_of(t, group * parts / groups).first_vertex;
    };
    std::vector<Array<Vertex>> done(groups), waiting(groups);
    for_each_block(groups, 1, [&](std::size_t n, std::size_t) {
        Array<Vertex> own, later;
        visit_shared(pass, first_of(n), first_of(n + 1), own, later);
        done[n].swap(own);
        waiting[n].swap(later);
    });
    Array<Vertex> at_last;
    MovingVertex m;
    for (const Array<Vertex>& some : waiting) {
        for (const Vertex v : some) {
            m.v = v;
            pass.visit(m, at_last);
        }
    }
    visit_shared_alone(pass, end, at_last);
    const auto before = static_cast<std::ptrdiff_t>(moved.size());
    for (const Array<Vertex>& some : done)
        for (const Vertex v : some) moved.push_back(v);
    const auto middle = static_cast<std::ptrdiff_t>(moved.size());
    for (const Vertex v : at_last) moved.push_back(v);
    std::inplace_merge(moved.begin() + before, moved.begin() + middle, moved.end());
}

}  // namespace

NewtonStep newton_step(const Triangulation& t, const SurfaceFrames& s, Vertex v, HalfEdge start,
                       double stiffness) {
    MovingVertex m;
    m.v = v;
    m.start = start;
    find_step(t, s, stiffness, m);
    return m.by;
}

void smooth(Triangulation& t, SurfaceFrames& s, const Stars& stars, VertexMarks& marks,
            double stiffness, double still, Array<Vertex>& moved) {
    const double longer = s.is_anisotropic ? 1.0 : OVER_RELAXATION;
    const SmoothingPass pass{t, s, stars, marks, stiffness, longer, still};
    moved = collect_by_blocks<Vertex>(
        count_parts(t), 1, [&](std::size_t n, std::size_t, Array<Vertex>& own) {
            const Part part = part_of(t, n);
            MovingVertex m;
            m.v = part.first_vertex;
            while ((m.v = next_marked(marks.active, m.v, part.end_vertex)) < part.end_vertex) {
                if (!stars.is_shared(m.v)) pass.visit(m, own);
                ++m.v;
            }
        });
    if (t.parts.empty()) return;
    if (allowed_threads() < 2)
        visit_shared_alone(pass, 0, moved);
    else
        visit_shared_by_threads(pass, moved);
}

}  // namespace surfmesh
