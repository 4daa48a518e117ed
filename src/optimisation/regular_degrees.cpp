#include "optimisation/regular_degrees.hpp"

namespace surfmesh {
namespace {

constexpr double STRAIGHT = 0.97;  // cosine of the angle that a border may turn by: 14 degrees

}  // namespace

bool is_on_straight_border(const Triangulation& t, const SurfaceFrames& s, HalfEdge e) {
    HalfEdge first = e, last = prev_half_edge(e);  // the border edges that leave it and end there
    while (t.adj[first] >= 0) {
        first = next_half_edge(t.adj[first]);
        if (first == e) return false;
    }
    while (t.adj[last] >= 0) last = prev_half_edge(t.adj[last]);
    const Vertex v = t.tri[e];
    const Point2 onward = chord(s, v, t.tri[next_half_edge(first)]);
    const Point2 back = chord(s, v, t.tri[last]);
    return dot(onward, back) < -STRAIGHT * norm(onward) * norm(back);
}

}  // namespace surfmesh
