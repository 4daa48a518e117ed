#include "optimisation/worst_stars.hpp"

#include <numeric>

#include "optimisation/marked_triangles.hpp"
#include "optimisation/regular_degrees.hpp"
#include "triangulation/local_operations.hpp"

namespace surfmesh {
namespace {

constexpr double FILLING_GAIN = 0.02;     // least gain of the smallest alpha for a vertex to go
constexpr double LEAST_IRREGULAR = 0.65;  // triangles below are bad not by degrees alone
constexpr double LEAST_UNSMOOTHED = 0.4;  // worst alpha where degrees are bettered by a removal
constexpr int BORDER_WEIGHT = 2;          // of degrees on the border against those inside
constexpr int LEAST_BETTERMENT = -3;      // of the sum of squares of what they miss
constexpr double REFUSED = -1.0;          // alpha of a triangle that must not be

/// The star of one vertex, and how it would be filled.
class StarRemoval {
  public:
    StarRemoval(Triangulation& t, const SurfaceFrames& s, Stars& stars, VertexMarks& marks,
                const FillingLimits& limits)
        : t_(t), s_(s), stars_(stars), marks_(marks), limits_(limits) {}

    /// Remove v if the triangles in its place are better. Not beside one that has gone before.
    bool remove_if_better(Vertex v) {
        if (!take(v)) return false;
        const double before = smallest_shape();
        if (!(before > FOLDED)) return false;
        const Ears ears = ears_allowed();
        if (!(ears.worst > before + FILLING_GAIN)) return false;
        fill(v, ears);
        return true;
    }

    /// Remove v if it touches a straight border, and degrees around are nearer to regular without.
    bool remove_if_irregular(Vertex v) {
        if (!take(v) || !is_at_straight_border()) return false;
        if (!(smallest_shape() > LEAST_IRREGULAR)) return false;
        const Ears ears = ears_allowed();
        if (!(ears.worst > LEAST_UNSMOOTHED) || !betters_degrees(ears)) return false;
        fill(v, ears);
        return true;
    }

    /// Remove v if a triangle of its star is below ``least``.
    bool remove_if_bad(Vertex v, double least) {
        if (!take(v) || !(smallest_shape() < least)) return false;
        const Ears ears = best_ears(t_, polygon_, [&](Vertex p, Vertex q, Vertex r) {
            return joins_boundaries(p, q, r) ? REFUSED : triangle_shape(s_, p, q, r);
        });
        if (!(ears.worst > REFUSED)) return false;
        fill(v, ears);
        return true;
    }

  private:
    [[nodiscard]] bool take(Vertex v) {
        const HalfEdge start = stars_.start[v];
        return start != NIL && stars_.frozen[v] == 0 && take_star(t_, start, polygon_);
    }

    void fill(Vertex v, const Ears& ears) {
        fill_polygon(t_, polygon_, ears);
        for (const StarEdge& edge : polygon_.rim) {
            marks_.touch(edge.start);
            stars_.start[edge.start] = NIL;
        }
        stars_.start[v] = NIL;
    }

    [[nodiscard]] Ears ears_allowed() const {
        return best_ears(t_, polygon_,
                         [&](Vertex p, Vertex q, Vertex r) { return shape_if_allowed(p, q, r); });
    }

    /// Is an edge of the rim on the border, which turns at none of the vertices around? Their stars
    /// are as they were.
    [[nodiscard]] bool is_at_straight_border() const {
        bool touches = false;
        for (const StarEdge& edge : polygon_.rim) {
            const HalfEdge start = stars_.start[edge.start];
            touches = touches || edge.outer < 0;
            if (start == NIL) return false;
            if (stars_.frozen[edge.start] != 0 && !is_on_straight_border(t_, s_, start))
                return false;
        }
        return touches;
    }

    /// Do degrees miss those of regular vertices by a smaller sum of squares with the ears?
    [[nodiscard]] bool betters_degrees(const Ears& ears) const {
        Array<std::size_t> left(polygon_.rim.size());
        std::iota(left.begin(), left.end(), std::size_t{0});
        Array<int> gained;  // triangles of each vertex of the rim, those of the star off
        gained.resize(left.size(), -2);
        for (const std::size_t i : ears.first) {
            const std::size_t n = left.size();
            for (const std::size_t k : {i, i + 1, i + 2}) ++gained[left[k % n]];
            if (n > 3) erase(left, (i + 1) % n);
        }
        int change = 0;
        for (std::size_t k = 0; k < gained.size(); ++k) {
            const Vertex v = polygon_.rim[k].start;
            const int before = excess(stars_, v), after = before + gained[k];
            change +=
                (stars_.frozen[v] != 0 ? BORDER_WEIGHT : 1) * (after * after - before * before);
        }
        return change <= LEAST_BETTERMENT;
    }

    [[nodiscard]] double smallest_shape() const {
        double smallest = 1.0;
        for (const Triangle k : polygon_.triangles) smallest = std::min(smallest, shape_of(k));
        return smallest;
    }

    [[nodiscard]] double shape_of(Triangle k) const {
        return triangle_shape(s_, t_.tri[3 * k], t_.tri[3 * k + 1], t_.tri[3 * k + 2]);
    }

    /// No edge may join two vertices of the boundary, go the short way round, or be too long.
    [[nodiscard]] bool is_allowed(Vertex p, Vertex q) const {
        if (stars_.frozen[p] != 0 && stars_.frozen[q] != 0) return false;
        return follows(t_, s_, p, q) && follows(t_, s_, q, p) &&
               !is_longer(s_, p, q, limits_.longest);
    }

    [[nodiscard]] double shape_if_allowed(Vertex p, Vertex q, Vertex r) const {
        if (!(triangle_deviation(s_, p, q, r) <= limits_.farthest)) return REFUSED;
        if (!is_on_rim(p, q) && !is_allowed(p, q)) return REFUSED;
        if (!is_on_rim(q, r) && !is_allowed(q, r)) return REFUSED;
        if (!is_on_rim(r, p) && !is_allowed(r, p)) return REFUSED;
        return triangle_shape(s_, p, q, r);
    }

    /// Would an edge within the polygon join two vertices of the boundary?
    [[nodiscard]] bool joins_boundaries(Vertex p, Vertex q, Vertex r) const {
        const auto joins = [&](Vertex a, Vertex b) {
            return stars_.frozen[a] != 0 && stars_.frozen[b] != 0 && !is_on_rim(a, b) &&
                   !is_on_rim(b, a);
        };
        return joins(p, q) || joins(q, r) || joins(r, p);
    }

    [[nodiscard]] bool is_on_rim(Vertex p, Vertex q) const {
        const std::size_t n = polygon_.rim.size();
        for (std::size_t k = 0; k < n; ++k)
            if (polygon_.rim[k].start == p) return polygon_.rim[(k + 1) % n].start == q;
        return false;
    }

    Triangulation& t_;
    const SurfaceFrames& s_;
    Stars& stars_;
    VertexMarks& marks_;
    const FillingLimits& limits_;
    StarPolygon polygon_;
};

/// Call ``remove`` with the corners of triangles below ``least`` until one of each is gone; how many.
template <class Remove>
int remove_corners(const Triangulation& t, const SurfaceFrames& s, const Array<double>& shape,
                   double least, Remove remove) {
    int removed = 0;
    for (const Triangle k : triangles_below(t, shape, least)) {
        if (t.region[k] == DEAD) continue;
        if (is_collapsed(s, t.tri[3 * k], t.tri[3 * k + 1], t.tri[3 * k + 2])) continue;
        for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e)
            if (remove(t.tri[e])) {
                ++removed;
                break;
            }
    }
    return removed;
}

}  // namespace

int remove_worst(Triangulation& t, const SurfaceFrames& s, Stars& stars, VertexMarks& marks,
                 const Array<double>& shape, double least, const FillingLimits& limits) {
    StarRemoval removal(t, s, stars, marks, limits);
    return remove_corners(t, s, shape, least,
                          [&](Vertex v) { return removal.remove_if_better(v); });
}

int remove_at_border(Triangulation& t, const SurfaceFrames& s, Stars& stars, VertexMarks& marks,
                     const Array<double>& shape, double bad, const FillingLimits& limits) {
    StarRemoval removal(t, s, stars, marks, limits);
    return remove_corners(t, s, shape, bad,
                          [&](Vertex v) { return removal.remove_if_irregular(v); });
}

int remove_bad_stars(Triangulation& t, const SurfaceFrames& s, Stars& stars, VertexMarks& marks,
                     Vertex first, double least) {
    const FillingLimits none{};
    StarRemoval removal(t, s, stars, marks, none);
    int removed = 0;
    for (Vertex v = first; v < t.vertices(); ++v) removed += removal.remove_if_bad(v, least);
    return removed;
}

}  // namespace surfmesh
