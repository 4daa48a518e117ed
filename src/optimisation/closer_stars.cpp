#include "optimisation/closer_stars.hpp"

#include <cmath>
#include <vector>

#include "optimisation/best_way.hpp"
#include "optimisation/star_quadric.hpp"
#include "triangulation/parts.hpp"

namespace surfmesh {
namespace {

// Stretched meshes have more triangles that move: the last steps cost a fourth and save nothing.
constexpr WayLimits APPROACH_LIMITS{0.08, 0.01, 0.3}, STRETCHED_LIMITS{0.08, 0.02, 0.3};
constexpr double LEAST_STEP_GAIN = 0.02;  // least part of the excess that a step takes away

double square_above(double ratio) { return ratio > 1.0 ? (ratio - 1.0) * (ratio - 1.0) : 0.0; }

/// What the shape of a triangle exceeds its bound by, squared.
double shape_excess(const SurfaceFrames& s, Vertex a, Vertex b, Vertex c, StarBounds bounds) {
    if (coincide(s, b, c) || !is_shape_below(s, a, b, c, bounds.least)) return 0.0;
    const double shape = triangle_shape(s, a, b, c);
    return shape > 0.0 ? square_above(bounds.least / shape) : INFINITY;
}

/// The squares of what the triangles around v exceed their bounds by: 0 where all keep them,
/// infinite where one is not positive in the plane or is turned over. From ``enough`` on the rest
/// is not looked at.
double excess(const Triangulation& t, const SurfaceFrames& s, Vertex v, HalfEdge start,
              StarBounds bounds, double enough = INFINITY) {
    double sum = 0.0;
    HalfEdge e = start;
    do {
        const Vertex p = t.tri[next_half_edge(e)], q = t.tri[prev_half_edge(e)];
        if (orient(t.xy, v, p, q) <= 0.0) return INFINITY;
        sum += square_above(triangle_deviation(s, v, p, q) / bounds.farthest);
        if (sum >= enough) return sum;
        sum += shape_excess(s, v, p, q, bounds);
        e = rotate_ccw(t, e);
    } while (e != start);
    return sum;
}

/// The quadric through the neighbours of v.
Quadric quadric_at(const Triangulation& t, const SurfaceFrames& s, Vertex v, HalfEdge start) {
    QuadricFit fit;
    for_each_in_star(t, start, [&](HalfEdge e) {
        const Vertex p = t.tri[next_half_edge(e)];
        fit.add(chord(s, v, p), 2.0 * rise(s, v, p));
    });
    return fit.quadric();
}

/// Where a vertex is, and the way it came from where it was.
class StarPosition {
  public:
    StarPosition(const Triangulation& t, const SurfaceFrames& s, Vertex v, HalfEdge start)
        : v_(v),
          xy_(t.xy[v]),
          point_(s.point[v]),
          normal_(s.normal[v]),
          form_(quadric_at(t, s, v, start)) {}

    void place(Triangulation& t, SurfaceFrames& s, Point2 way) const {
        const SizeTensor h = t.size[v_];
        t.xy[v_] = {xy_.x + h.xx * way.x + h.xy * way.y, xy_.y + h.xy * way.x + h.yy * way.y};
        const Point2 slope = form_.slope(way);
        const double height = 0.5 * (slope.x * way.x + slope.y * way.y);
        s.point[v_] = point_ + lift(s, v_, way) + height * normal_;
        const TangentMap& b = s.tangent_map[v_];
        const Point3 n = normal_ - slope.x * b.x - slope.y * b.y;
        const double length = norm(n);
        s.normal[v_] = length > 0.0 ? 1.0 / length * n : normal_;
    }
    void put_back(Triangulation& t, SurfaceFrames& s) const {
        t.xy[v_] = xy_;
        s.point[v_] = point_;
        s.normal[v_] = normal_;
    }

  private:
    Vertex v_;
    Point2 xy_;
    Point3 point_, normal_;
    Quadric form_;
};

/// Move v until its star keeps its bounds, or to where it is best; the length of its way.
double move_to_best(Triangulation& t, SurfaceFrames& s, Vertex v, HalfEdge start,
                    StarBounds bounds) {
    const double now = excess(t, s, v, start, bounds);
    if (!(now > 0.0) || now == INFINITY || is_zero(s.normal[v])) return 0.0;
    const StarPosition from(t, s, v, start);
    const WayLimits& limits = s.is_anisotropic ? STRETCHED_LIMITS : APPROACH_LIMITS;
    const auto energy_at = [&](Point2 trial, double least) {
        from.place(t, s, trial);
        return excess(t, s, v, start, bounds, least);
    };
    const Point2 way = find_best_way(limits, now, 0.0, energy_at, [](double energy) {
        return (1.0 - LEAST_STEP_GAIN) * energy;
    });
    if (way.x == 0.0 && way.y == 0.0)
        from.put_back(t, s);
    else
        from.place(t, s, way);
    return norm(way);
}

/// The free corners of ``triangles``, in their order: those whose stars lie in each part, and at
/// last those whose stars lie in several.
std::vector<Array<Vertex>> free_corners(const Triangulation& t, const Stars& stars,
                                        std::span<const Triangle> triangles) {
    const std::size_t parts = count_parts(t);
    const Vertex each = t.parts.empty() ? t.vertices() : t.parts[0].end_vertex;
    std::vector<Array<Vertex>> found(parts + 1);
    for (const Triangle k : triangles) {
        if (t.region[k] == DEAD) continue;
        for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e) {
            const Vertex v = t.tri[e];
            if (stars.frozen[v] != 0 || stars.start[v] == NIL) continue;
            found[stars.is_shared(v) ? parts : static_cast<std::size_t>(v / each)].push_back(v);
        }
    }
    return found;
}

}  // namespace

double excess_of(const SurfaceFrames& s, Vertex a, Vertex b, Vertex c, StarBounds bounds) {
    return square_above(triangle_deviation(s, a, b, c) / bounds.farthest) +
           shape_excess(s, a, b, c, bounds);
}

void bring_nearer(Triangulation& t, SurfaceFrames& s, const Stars& stars, VertexMarks& marks,
                  std::span<const Triangle> triangles, StarBounds bounds, Array<Vertex>& moved) {
    const std::vector<Array<Vertex>> free = free_corners(t, stars, triangles);
    const auto visit = [&](Vertex v, Array<Vertex>& own) {
        record_move(s, marks, v, move_to_best(t, s, v, stars.start[v], bounds), own);
    };
    moved = collect_by_blocks<Vertex>(free.size() - 1, 1,
                                      [&](std::size_t n, std::size_t, Array<Vertex>& own) {
                                          for (const Vertex v : free[n]) visit(v, own);
                                      });
    for (const Vertex v : free.back()) visit(v, moved);
}

}  // namespace surfmesh
