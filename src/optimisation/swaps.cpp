#include "optimisation/swaps.hpp"

#include <atomic>

#include "optimisation/marked_triangles.hpp"
#include "optimisation/regular_degrees.hpp"
#include "triangulation/local_operations.hpp"
#include "triangulation/parts.hpp"
#include "values/first_touch.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t SWAPS_TOGETHER = 1 << 14;  // triangles measured together
constexpr std::size_t ROOM_FOR_SHAPES = 4;       // this part more, for what splits add
constexpr double SWAP_GAIN = 1e-3;  // smallest betterment of the worse alpha for a swap
constexpr double NEARER = 0.8;      // of the excess of a pair, which a swap leaves at most

/// The corners of the two triangles at an edge that is not on the border: a-b-c and b-a-d.
struct Quadrilateral {
    Vertex a, b, c, d;
};

Quadrilateral corners_around(const Triangulation& t, HalfEdge e) {
    const HalfEdge f = t.adj[e];
    return {t.tri[e], t.tri[f], t.tri[prev_half_edge(e)], t.tri[prev_half_edge(f)]};
}

/// Is the swap of e valid in the plane, and the new edge short in the plane as in space?
bool may_swap(const Triangulation& t, const SurfaceFrames& s, HalfEdge e) {
    if (!is_convex(t, e)) return false;
    const Quadrilateral q = corners_around(t, e);
    return follows(t, s, q.c, q.d) && follows(t, s, q.d, q.c);
}

void touch(VertexMarks& marks, const Quadrilateral& q) {
    marks.touch(q.a);
    marks.touch(q.b);
    marks.touch(q.c);
    marks.touch(q.d);
}

bool is_dirty(const Triangulation& t, const VertexMarks& marks, Triangle k) {
    return marks.dirty[t.tri[3 * k]] || marks.dirty[t.tri[3 * k + 1]] ||
           marks.dirty[t.tri[3 * k + 2]];
}

/// Swap e, a to b, whose stars are known; false where one of the four new ones is not.
bool swap_with_stars(Triangulation& t, HalfEdge e, const Quadrilateral& q, Stars& stars) {
    const HalfEdge f = t.adj[e];
    swap_edge(t, e);
    stars.degree[q.a] -= 1;
    stars.degree[q.b] -= 1;
    stars.degree[q.c] += 1;
    stars.degree[q.d] += 1;
    bool known = true;
    for (const HalfEdge own : {e, next_half_edge(e), prev_half_edge(e), f})  // from a, d, c, b
        known = renew_star(t, own, stars) && known;
    return known;
}

/// One look at the edges of triangles below ``good``, and what it is done with.
struct ShapeSwaps {
    Triangulation& t;
    const SurfaceFrames& s;
    Array<double>& shape;
    Stars* stars;  // null where they are stale
    VertexMarks& marks;
    double good;
    std::atomic<bool>& known;  // are the stars, still?

    /// Swap e, which may be, if that raises the smaller alpha of its two triangles.
    bool swap_if_better(HalfEdge e) const {
        const HalfEdge f = t.adj[e];
        const Quadrilateral q = corners_around(t, e);
        const double old = std::min(shape[e / 3], shape[f / 3]);
        const double first = triangle_shape(s, q.a, q.d, q.c);
        const double second = triangle_shape(s, q.b, q.c, q.d);
        if (!(std::min(first, second) > old + SWAP_GAIN) || !may_swap(t, s, e)) return false;
        if (stars == nullptr)
            swap_edge(t, e);
        else if (!swap_with_stars(t, e, q, *stars))
            known = false;
        shape[e / 3] = first;
        shape[f / 3] = second;
        touch(marks, q);
        return true;
    }

    /// Swap edges of triangle k with others within the part; returns the swaps made.
    int swap_within(const Part& part, Triangle k, Array<Triangle>& left) const {
        int swaps = 0;
        bool waits = false;
        for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e) {
            if (t.adj[e] < 0 || t.fixed[e] != 0) continue;
            if (is_within(t, part, t.adj[e] / 3))
                swaps += swap_if_better(e);
            else
                waits = true;
        }
        if (waits) left.push_back(k);
        return swaps;
    }

    int sweep() const {
        std::atomic<int> swaps = 0;
        const Array<Triangle> left = for_each_part(t, [&](const Part& part, Array<Triangle>& own) {
            int made = 0;
            for (Triangle k = part.first_triangle; k < part.end_triangle; ++k) {
                if (shape[k] > good || t.region[k] == DEAD) continue;
                if (!is_within(t, part, k))
                    own.push_back(k);
                else if (is_dirty(t, marks, k))
                    made += swap_within(part, k, own);
            }
            swaps += made;
        });
        Array<Triangle> none;
        for (const Triangle k : left)
            if (shape[k] <= good && t.region[k] != DEAD && is_dirty(t, marks, k))
                swaps += swap_within(whole_of(t), k, none);
        return swaps;
    }
};

/// Swaps that bring degrees nearer to six, and what they work on.
struct DegreeSwaps {
    Triangulation& t;
    const SurfaceFrames& s;
    Stars& stars;
    VertexMarks& marks;
    double least;
    std::atomic<bool>& known;  // are the stars, still?

    [[nodiscard]] bool is_wanted(HalfEdge e, const Quadrilateral& q) const {
        const Array<std::int32_t>& degree = stars.degree;
        const int inner = degree[q.a] + degree[q.b];
        if (inner < 13 || inner - degree[q.c] - degree[q.d] < 3) return false;
        if (stars.frozen[q.a] || stars.frozen[q.b] || stars.frozen[q.c] || stars.frozen[q.d])
            return false;
        return is_good_enough(e, q);
    }

    [[nodiscard]] bool is_good_enough(HalfEdge e, const Quadrilateral& q) const {
        return triangle_shape(s, q.a, q.d, q.c) > least &&
               triangle_shape(s, q.b, q.c, q.d) > least && may_swap(t, s, e);
    }

    /// The same where some of the four are frozen, all those on a straight border. The new edge
    /// joins no two of these: a triangle with three corners on boundaries is flat where they are,
    /// and lies in a face beyond that is tangent there.
    [[nodiscard]] bool is_wanted_at_border(HalfEdge e, const Quadrilateral& q) const {
        if (stars.frozen[q.c] != 0 && stars.frozen[q.d] != 0) return false;
        const int inner = excess(stars, q.a) + excess(stars, q.b);
        if (inner < 1 || inner - excess(stars, q.c) - excess(stars, q.d) < 3) return false;
        for (const Vertex v : {q.a, q.b, q.c, q.d})
            if (stars.frozen[v] != 0 && !is_on_straight_border(t, s, stars.start[v])) return false;
        return is_good_enough(e, q);
    }

    void swap(HalfEdge e, const Quadrilateral& q) const {
        if (!swap_with_stars(t, e, q, stars)) known = false;
        touch(marks, q);
    }

    /// Swap edges of triangle k with others within the part; returns the swaps made.
    int swap_within(const Part& part, Triangle k, Array<Triangle>& left) const {
        int swaps = 0;
        bool waits = false;
        for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e) {
            if (t.adj[e] <= e || t.fixed[e] != 0) continue;
            if (!is_within(t, part, t.adj[e] / 3)) {
                waits = true;
                continue;
            }
            const Quadrilateral q = corners_around(t, e);
            if (!is_wanted(e, q)) continue;
            swap(e, q);
            ++swaps;
        }
        if (waits) left.push_back(k);
        return swaps;
    }
};

/// Measure the triangles with a dirty corner anew.
void measure_dirty(const Triangulation& t, const SurfaceFrames& s, const Stars* stars,
                   const VertexMarks& marks, Array<double>& shape) {
    if (shape.empty())
        shape = filled_by_threads(t.region.size(), 1.0,
                                  t.region.size() + t.region.size() / ROOM_FOR_SHAPES);
    shape.resize(t.region.size(), 1.0);
    const Array<Triangle> dirty = triangles_at(t, stars, marks.dirty);
    for_each_block(dirty.size(), SWAPS_TOGETHER, [&](std::size_t first, std::size_t last) {
        for (const Triangle k : std::span(dirty.data() + first, last - first))
            shape[k] = triangle_shape(s, t.tri[3 * k], t.tri[3 * k + 1], t.tri[3 * k + 2]);
    });
}

}  // namespace

SwapsMade swap_for_shape(Triangulation& t, const SurfaceFrames& s, Array<double>& shape,
                         Stars* stars, VertexMarks& marks, double good, int sweeps) {
    measure_dirty(t, s, stars, marks, shape);
    std::atomic<bool> known = stars != nullptr;
    const ShapeSwaps swaps{t, s, shape, stars, marks, good, known};
    int total = 0;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        const int made = swaps.sweep();
        total += made;
        if (made == 0) break;
    }
    marks.dirty.fill(0);
    return {total, known};
}

SwapsMade swap_for_degree(Triangulation& t, const SurfaceFrames& s, Stars& stars,
                          VertexMarks& marks, double least) {
    std::atomic<bool> known = true;
    const DegreeSwaps swaps{t, s, stars, marks, least, known};
    std::atomic<int> total = 0;
    const Array<Triangle> left = for_each_part(t, [&](const Part& part, Array<Triangle>& own) {
        int made = 0;
        for (Triangle k = part.first_triangle; k < part.end_triangle; ++k) {
            if (t.region[k] == DEAD) continue;
            if (is_within(t, part, k))
                made += swaps.swap_within(part, k, own);
            else
                own.push_back(k);
        }
        total += made;
    });
    Array<Triangle> none;
    for (const Triangle k : left)
        if (t.region[k] != DEAD) total += swaps.swap_within(whole_of(t), k, none);
    return {total, known};
}

SwapsMade swap_at_border(Triangulation& t, const SurfaceFrames& s, Stars& stars, VertexMarks& marks,
                         const Array<double>& shape, double bad, double least) {
    std::atomic<bool> known = true;
    const DegreeSwaps swaps{t, s, stars, marks, least, known};
    int made = 0;
    for (const Triangle k : triangles_below(t, shape, bad)) {
        if (!stars.frozen[t.tri[3 * k]] && !stars.frozen[t.tri[3 * k + 1]] &&
            !stars.frozen[t.tri[3 * k + 2]])
            continue;
        for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e) {
            if (t.adj[e] < 0 || t.fixed[e] != 0) continue;
            const Quadrilateral q = corners_around(t, e);
            if (!swaps.is_wanted_at_border(e, q)) continue;
            swaps.swap(e, q);
            ++made;
            break;
        }
    }
    return {made, known};
}

SwapsMade swap_nearer(Triangulation& t, const SurfaceFrames& s, Stars& stars, VertexMarks& marks,
                      std::span<const Triangle> triangles, StarBounds bounds) {
    bool known = true;
    int made = 0;
    for (const Triangle k : triangles) {
        if (t.region[k] == DEAD) continue;
        for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e) {
            if (t.adj[e] < 0 || t.fixed[e] != 0) continue;
            const Quadrilateral q = corners_around(t, e);
            const double now =
                excess_of(s, q.a, q.b, q.c, bounds) + excess_of(s, q.b, q.a, q.d, bounds);
            const double then =
                excess_of(s, q.a, q.d, q.c, bounds) + excess_of(s, q.b, q.c, q.d, bounds);
            if (!(then < NEARER * now) || !may_swap(t, s, e)) continue;
            if (!swap_with_stars(t, e, q, stars)) known = false;
            touch(marks, q);
            ++made;
        }
    }
    return {made, known};
}

}  // namespace surfmesh
