// Where a vertex is best placed, by a search that asks for an energy alone.
//
// In: the energy of the star for a way of the vertex in its unit tangent plane, which places it
// there; by how much a step has to lower it; how far to go. Out: the way to the least energy found.
// Steps go eight ways with a radius that is halved where none is better (pattern search: Hooke and
// Jeeves 1961). Whoever asks puts the vertex where the way ends, and records the move.
#pragma once

#include "optimisation/surface_frames.hpp"
#include "optimisation/vertex_marks.hpp"

namespace surfmesh {

/// In unit lengths.
struct WayLimits {
    double first_radius, last_radius;
    double longest;  // of the whole way
};

inline constexpr double DIAGONAL = 0.70710678118654752;
inline constexpr Point2 EIGHT_WAYS[] = {
    {1.0, 0.0},  {DIAGONAL, DIAGONAL},   {0.0, 1.0},  {-DIAGONAL, DIAGONAL},
    {-1.0, 0.0}, {-DIAGONAL, -DIAGONAL}, {0.0, -1.0}, {DIAGONAL, -DIAGONAL}};

/// The best way from where the energy is ``energy``; good enough is what is not above ``enough``.
/// bar(energy): what a step has to come below. energy_at(way, least): what is not below ``least``
/// need not be known any closer.
template <class EnergyAt, class Bar>
Point2 find_best_way(const WayLimits& limits, double energy, double enough,
                     const EnergyAt& energy_at, const Bar& bar) {
    Point2 way = {0.0, 0.0};
    for (double radius = limits.first_radius; radius >= limits.last_radius && energy > enough;) {
        Point2 best_way = way;
        double best = bar(energy);
        for (const Point2 direction : EIGHT_WAYS) {
            const Point2 trial = way + radius * direction;
            if (norm(trial) > limits.longest) continue;
            const double found = energy_at(trial, best);
            if (!(found < best)) continue;
            best = found;
            best_way = trial;
        }
        if (best < bar(energy))
            energy = best;
        else
            radius *= 0.5;
        way = best_way;
    }
    return way;
}

/// Where a vertex is, and the way it came from where it was.
class Position {
  public:
    Position(const Triangulation& t, const SurfaceFrames& s, Vertex v)
        : v_(v), xy_(t.xy[v]), point_(s.point[v]) {}

    void place(Triangulation& t, SurfaceFrames& s, Point2 way) const {
        const SizeTensor h = t.size[v_];
        t.xy[v_] = {xy_.x + h.xx * way.x + h.xy * way.y, xy_.y + h.xy * way.x + h.yy * way.y};
        s.point[v_] = point_ + lift(s, v_, way);
    }

  private:
    Vertex v_;
    Point2 xy_;
    Point3 point_;
};

/// v has moved by ``length``, unit lengths: it rests until something else moves.
inline void record_move(SurfaceFrames& s, VertexMarks& marks, Vertex v, double length,
                        Array<Vertex>& moved) {
    if (length == 0.0) return;
    s.drift[v] += length;
    marks.active[v] = 0;
    marks.dirty[v] = 1;
    moved.push_back(v);
}

}  // namespace surfmesh
