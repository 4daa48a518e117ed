#include "optimisation/star_insertion.hpp"

#include "optimisation/best_way.hpp"
#include "optimisation/marked_triangles.hpp"
#include "optimisation/splits.hpp"
#include "optimisation/worst_stars.hpp"
#include "triangulation/local_operations.hpp"

namespace surfmesh {
namespace {

constexpr WayLimits INSERTION_LIMITS{0.16, 0.02, 0.5};
constexpr double INSERTION_GAIN = 0.04;  // least gain of the smallest alpha for a vertex more
constexpr double WAY_GAIN = 2e-3;        // least gain of alpha for a step of it
constexpr double SHORTEST_SPOKE = 0.25;  // metric length of edges to it
constexpr std::size_t MOST_SPOKES = 8;
constexpr int ROUNDS = 2;  // of growing its star and moving it

/// Put a value behind number k.
void put_after(Array<StarEdge>& rim, std::size_t k, StarEdge value) {
    rim.push_back(value);
    std::rotate(rim.begin() + k + 1, rim.end() - 1, rim.end());
}

/// The star that a new vertex would have.
class NewStar {
  public:
    NewStar(Triangulation& t, SurfaceFrames& s, VertexMarks& marks) : t_(t), s_(s), marks_(marks) {}

    /// Put a vertex on e if all triangles that this changes become better.
    bool insert(HalfEdge e) {
        if (t_.xy.size() >= s_.limits.most_vertices) return false;
        const Vertex a = t_.tri[e], b = t_.tri[t_.adj[e]];
        v_ = t_.add_vertex(0.5 * (t_.xy[a] + t_.xy[b]), t_.size[a]);
        set_between(t_, s_, marks_, v_, a, b);
        open(e);
        for (int round = 0; round < ROUNDS; ++round) {
            grow();
            move();
        }
        if (!is_worth_it()) {
            take_back();
            return false;
        }
        fill_star(t_, polygon_, v_);
        for (const StarEdge& edge : polygon_.rim) marks_.touch(edge.start);
        return true;
    }

  private:
    /// Take the two triangles beside e.
    void open(HalfEdge e) {
        polygon_.rim.clear();
        polygon_.triangles.clear();
        for (const HalfEdge side : {e, t_.adj[e]}) {
            polygon_.triangles.push_back(side / 3);
            polygon_.rim.push_back(rim_edge(next_half_edge(side)));
            polygon_.rim.push_back(rim_edge(prev_half_edge(side)));
        }
    }

    [[nodiscard]] StarEdge rim_edge(HalfEdge inner) const {
        return {t_.tri[inner], t_.adj[inner], t_.fixed[inner]};
    }

    /// Take triangles beyond the rim while that raises the smaller alpha of the pair, as swaps do.
    void grow() {
        for (std::size_t k = 0; k < polygon_.rim.size() && polygon_.rim.size() < MOST_SPOKES;) {
            const StarEdge edge = polygon_.rim[k];
            if (edge.outer < 0 || edge.fixed != 0 || !takes(k)) {
                ++k;
                continue;
            }
            polygon_.triangles.push_back(edge.outer / 3);
            polygon_.rim[k] = rim_edge(next_half_edge(edge.outer));
            put_after(polygon_.rim, k, rim_edge(prev_half_edge(edge.outer)));
        }
    }

    [[nodiscard]] bool takes(std::size_t k) const {
        const HalfEdge outer = polygon_.rim[k].outer;
        const Vertex a = polygon_.rim[k].start, b = end_of(k), c = t_.tri[prev_half_edge(outer)];
        if (std::find(polygon_.triangles.begin(), polygon_.triangles.end(), outer / 3) !=
            polygon_.triangles.end())
            return false;
        if (orient(t_.xy, v_, a, c) <= 0.0 || orient(t_.xy, v_, c, b) <= 0.0) return false;
        const double old = std::min(triangle_shape(s_, v_, a, b), triangle_shape(s_, b, a, c));
        return std::min(triangle_shape(s_, v_, a, c), triangle_shape(s_, v_, c, b)) > old;
    }

    [[nodiscard]] Vertex end_of(std::size_t k) const {
        return polygon_.rim[(k + 1) % polygon_.rim.size()].start;
    }

    /// The smallest alpha of the star; -1 where a triangle is not positive in the plane.
    [[nodiscard]] double smallest_shape() const {
        double smallest = 1.0;
        for (std::size_t k = 0; k < polygon_.rim.size(); ++k) {
            const Vertex a = polygon_.rim[k].start, b = end_of(k);
            if (orient(t_.xy, v_, a, b) <= 0.0) return -1.0;
            smallest = std::min(smallest, triangle_shape(s_, v_, a, b));
        }
        return smallest;
    }

    void move() {
        const Position from(t_, s_, v_);
        const auto energy_at = [&](Point2 trial, double /*least*/) {
            from.place(t_, s_, trial);
            return -smallest_shape();
        };
        const Point2 way = find_best_way(INSERTION_LIMITS, -smallest_shape(), -1.0, energy_at,
                                         [](double energy) { return energy - WAY_GAIN; });
        from.place(t_, s_, way);
    }

    [[nodiscard]] bool is_worth_it() const {
        double before = 1.0;
        for (const Triangle k : polygon_.triangles)
            before = std::min(
                before, triangle_shape(s_, t_.tri[3 * k], t_.tri[3 * k + 1], t_.tri[3 * k + 2]));
        if (!(before > FOLDED) || !(smallest_shape() > before + INSERTION_GAIN)) return false;
        for (const StarEdge& edge : polygon_.rim) {
            const double length = norm(s_.point[edge.start] - s_.point[v_]);
            if (length < s_.limits.least_size || edge_length(s_, v_, edge.start) < SHORTEST_SPOKE)
                return false;
        }
        return true;
    }

    void take_back() {
        const std::size_t count = t_.xy.size() - 1;
        t_.xy.resize(count);
        t_.size.resize(count);
        s_.resize(count);
        marks_.resize(count);
    }

    Triangulation& t_;
    SurfaceFrames& s_;
    VertexMarks& marks_;
    Vertex v_ = NIL;
    StarPolygon polygon_;
};

}  // namespace

Vertex insert_at_worst(Triangulation& t, SurfaceFrames& s, VertexMarks& marks,
                       const Array<double>& shape, double least) {
    const Vertex first = t.vertices();
    NewStar star(t, s, marks);
    for (const Triangle k : triangles_below(t, shape, least)) {
        const Vertex a = t.tri[3 * k], b = t.tri[3 * k + 1], c = t.tri[3 * k + 2];
        if (is_collapsed(s, a, b, c) || triangle_shape(s, a, b, c) >= least) continue;
        for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e)
            if (t.adj[e] >= 0 && t.fixed[e] == 0 && star.insert(e)) break;
    }
    return first;
}

}  // namespace surfmesh
