#include "optimisation/even_deviations.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "optimisation/star_quadric.hpp"
#include "triangulation/parts.hpp"

namespace surfmesh {
namespace {

// p, and the weights of distances and of unit edges against shapes. More weight of distances saves
// no triangles and costs shape.
constexpr int POWER = 12;
constexpr double DISTANCE_WEIGHT = 5.0, EDGE_WEIGHT = 0.6;

constexpr double NEAR = 0.3;      // of what is allowed: less counts for nothing
constexpr double FARTHEST = 1.5;  // and more than this no more
constexpr double LONGEST_EVEN_STEP =
    0.1;                                // in unit lengths: the power lets none be foreseen farther
constexpr double SMALLEST_STEP = 1e-4;  // shorter ones are not made
constexpr double STILL_EVEN = 0.01;     // a vertex that moves less leaves its neighbours alone
constexpr double WORST_SHAPE = 0.7;     // a move may lower the worst alpha, but not below this
constexpr double INVERSE_TWO_ROOT_3 = 0.28867513459481287;
constexpr std::size_t MOST_EVEN_SPOKES = 16;

/// An edge from the vertex that moves.
struct Spoke {
    Vertex end;
    Point2 way;                // in the unit tangent plane
    double rises, difference;  // sum of what both ends see of it, and by how much they differ
};

/// x^POWER-2.
double high_power(double x) {
    const double square = x * x, fourth = square * square;
    static_assert(POWER == 12);
    return fourth * fourth * square;
}

/// Gradient and Hessian of the energy of a star, and its largest 1 / alpha.
class StarEnergy {
  public:
    explicit StarEnergy(double allowed) : over_(1.0 / allowed) {}

    /// The triangle with its corners at ways p and q from the vertex.
    void add_shape(Point2 p, Point2 q) {
        const double i = 1.0 / (p.x * q.y - p.y * q.x);
        const double total = 2.0 * (dot(p, p) + dot(q, q) - dot(p, q));
        const double f = INVERSE_TWO_ROOT_3 * total * i;  // 1 / alpha
        worst_ = std::max(worst_, f);
        // of f^2 / 2, as smoothing has it, and of its square
        const double tx = -2.0 * (p.x + q.x), ty = -2.0 * (p.y + q.y);
        const double rx = (p.y - q.y) * i, ry = (q.x - p.x) * i;
        const double c = INVERSE_TWO_ROOT_3 * i * f, both = 2.0 * total, square = f * f;
        const Point2 g{c * (tx - total * rx), c * (ty - total * ry)};
        add_gradient(square * g);
        const double k = square * c;
        hessian_.xx += k * (4.0 + rx * (both * rx - 2.0 * tx)) + 2.0 * g.x * g.x;
        hessian_.xy += k * (both * rx * ry - (tx * ry + ty * rx)) + 2.0 * g.x * g.y;
        hessian_.yy += k * (4.0 + ry * (both * ry - 2.0 * ty)) + 2.0 * g.y * g.y;
    }
    /// The edge p, whose ends want a mean ``length``.
    void add_edge(Point2 p, double length) {
        const double d = norm(p), stiff = 2.0 * EDGE_WEIGHT / (length * length);
        const Point2 u = (1.0 / d) * p;
        const double pull = stiff * (d - length), across = std::max(pull / d, 0.0);
        const double along = stiff - across;
        add_gradient(-pull * u);
        hessian_.xx += across + along * u.x * u.x;
        hessian_.xy += along * u.x * u.y;
        hessian_.yy += across + along * u.y * u.y;
    }
    /// A distance on one side or the other, not sure by as much, and how it changes.
    void add_distance(double distance, double unsure, Point2 gradient) {
        const double x = std::min((std::abs(distance) + unsure) * over_, FARTHEST);
        if (!(x > NEAR)) return;
        const double low = DISTANCE_WEIGHT * high_power(x) * over_;
        add_gradient(std::copysign(low * x, distance) * gradient);
        // the distance itself is a quadric: along its gradient it curves by half the square over it
        const double curved = low * over_ * (POWER - 0.5);
        hessian_.xx += curved * gradient.x * gradient.x;
        hessian_.xy += curved * gradient.x * gradient.y;
        hessian_.yy += curved * gradient.y * gradient.y;
    }
    /// No step where the Hessian is not positive definite.
    [[nodiscard]] Point2 step() const {
        if (!(determinant(hessian_) > 0.0)) return {0.0, 0.0};
        const Point2 found = solve(hessian_, -1.0 * gradient_);
        const double length = norm(found);
        return length > LONGEST_EVEN_STEP ? LONGEST_EVEN_STEP / length * found : found;
    }
    [[nodiscard]] double worst_shape() const { return 1.0 / worst_; }

  private:
    void add_gradient(Point2 g) { gradient_ = gradient_ + g; }

    double over_, worst_ = 1.0;
    Point2 gradient_{0.0, 0.0};
    SizeTensor hessian_{0.0, 0.0, 0.0};
};

/// A pass over vertices, and what it works on.
struct EveningPass {
    Triangulation& t;
    SurfaceFrames& s;
    const Stars& stars;
    VertexMarks& marks;
    double allowed;

    void visit(Vertex v, Array<Vertex>& moved) const {
        const HalfEdge start = stars.start[v];
        if (marks.active[v] == 0 || stars.frozen[v] != 0 || start == NIL) return;
        marks.active[v] = 0;
        std::array<Spoke, MOST_EVEN_SPOKES + 1> spokes;
        const std::size_t count = find_spokes(v, start, spokes);
        if (count == 0) return;
        QuadricFit fit;
        for (std::size_t k = 0; k < count; ++k) fit.add(spokes[k].way, spokes[k].rises);
        const Quadric form = fit.quadric();
        StarEnergy energy(allowed);
        for (std::size_t k = 0; k < count; ++k) {
            const Spoke &p = spokes[k], &q = spokes[k + 1];
            if (!(p.way.x * q.way.y - p.way.y * q.way.x > 0.0)) return;
            energy.add_shape(p.way, q.way);
            energy.add_edge(p.way, 0.5 * (1.0 + s.size[p.end] / s.size[v]));
            add_distances(energy, form, p, q);
        }
        const Point2 step = energy.step();
        const double length = norm(step);
        if (!(length > SMALLEST_STEP)) return;
        if (!move(v, start, form, step, std::min(energy.worst_shape(), WORST_SHAPE))) return;
        s.drift[v] += length;
        moved.push_back(v);
        marks.dirty[v] = 1;
        if (length < STILL_EVEN) return;
        marks.active[v] = 1;
        for (std::size_t k = 0; k < count; ++k) marks.active[spokes[k].end] = 1;
    }

  private:
    /// The edges from v, the first once more at the end; none where v has no tangent plane, coincides
    /// with others or has more edges than are looked at.
    std::size_t find_spokes(Vertex v, HalfEdge start,
                            std::array<Spoke, MOST_EVEN_SPOKES + 1>& to) const {
        if (is_zero(s.normal[v])) return 0;
        std::size_t count = 0;
        HalfEdge e = start;
        do {
            const Vertex p = t.tri[next_half_edge(e)];
            if (count == MOST_EVEN_SPOKES || coincide(s, v, p)) return 0;
            const double here = rise(s, v, p), there = rise(s, p, v);
            to[count++] = {p, chord(s, v, p), here + there, std::abs(here - there)};
            e = rotate_ccw(t, e);
        } while (e != start);
        to[count] = to[0];
        return count;
    }

    /// Of the edge p and of the centre of the triangle p, q: see ``triangle_deviation``.
    void add_distances(StarEnergy& energy, Quadric form, const Spoke& p, const Spoke& q) const {
        const Point2 at_p = form.slope(p.way), at_q = form.slope(q.way);
        energy.add_distance(p.rises / 8.0, p.difference / 4.0, -0.25 * at_p);
        const double pq = rise(s, p.end, q.end), qp = rise(s, q.end, p.end);
        const double unsure = p.difference + q.difference + std::abs(pq - qp);
        energy.add_distance((p.rises + q.rises + pq + qp) / 18.0, unsure / 9.0,
                            (-1.0 / 9.0) * (at_p + at_q));
    }

    /// Move v by a step along the surface, unless a triangle turns over or is worse than ``least``.
    bool move(Vertex v, HalfEdge start, Quadric form, Point2 step, double least) const {
        const Point2 xy = t.xy[v];
        const Point3 point = s.point[v];
        t.xy[v] = xy + apply(t.size[v], step);
        s.point[v] = point + lift(s, v, step) + 0.5 * dot(form.slope(step), step) * s.normal[v];
        HalfEdge e = start;
        do {
            const Vertex p = t.tri[next_half_edge(e)], q = t.tri[prev_half_edge(e)];
            if (orient(t.xy, v, p, q) <= 0.0 ||
                (!coincide(s, p, q) && is_shape_below(s, v, p, q, least))) {
                t.xy[v] = xy;
                s.point[v] = point;
                return false;
            }
            e = rotate_ccw(t, e);
        } while (e != start);
        return true;
    }
};

}  // namespace

void even_deviations(Triangulation& t, SurfaceFrames& s, const Stars& stars, VertexMarks& marks,
                     double allowed, Array<Vertex>& moved) {
    const EveningPass pass{t, s, stars, marks, allowed};
    moved = collect_by_blocks<Vertex>(
        count_parts(t), 1, [&](std::size_t n, std::size_t, Array<Vertex>& own) {
            const Part part = part_of(t, n);
            for (Vertex v = next_marked(marks.active, part.first_vertex, part.end_vertex);
                 v < part.end_vertex; v = next_marked(marks.active, v + 1, part.end_vertex))
                if (!stars.is_shared(v)) pass.visit(v, own);
        });
    if (t.parts.empty()) return;
    const Vertex end = t.vertices();
    for (Vertex v = next_marked(stars.shared, 0, end); v < end;
         v = next_marked(stars.shared, v + 1, end))
        pass.visit(v, moved);
}

}  // namespace surfmesh
