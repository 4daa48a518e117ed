// What the packing works on: the triangulation, its front, and the edges where the front goes on.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "packing/edge_heap.hpp"
#include "packing/front.hpp"
#include "triangulation/triangulation.hpp"

namespace surfmesh {

/// A circle that is to be placed: an ellipse, its size tensor being H; 2 r Id for radius r.
struct Circle {
    Point2 centre;
    SizeTensor size;
};

/// Where the packing starts, and what ends it.
struct PackingLimits {
    Point2 origin;
    Point2 low, high;                 // corners of the box that the front has to leave
    double distance;                  // from the origin, infinite where there is no limit
    std::int64_t wanted;              // number of circles
    std::optional<Point2> edge = {};  // direction of an edge of the first triangle
};

/// A direction d of the plane as a unit vector H^-1 d / |H^-1 d|; d is not zero.
inline Point2 unit_step(SizeTensor h, Point2 d) {
    const Point2 step = solve(h, d);
    return (1.0 / norm(step)) * step;
}

/// What was done, in numbers.
struct PackingCounts {
    std::int64_t steps = 0;        // iterations of the fits to two and to three circles
    std::int64_t fits = 0;         // circles fitted to two others
    std::int64_t tangents = 0;     // circles placed that touch three others
    std::int64_t closed = 0;       // corners of the front that were filled
    std::int64_t forced = 0;       // rounds in which all edges waited
    std::int64_t overlapping = 0;  // circles of drawn radius placed although they overlap others
    std::int64_t halves = 0;       // 2 where a box was packed in halves
};

enum class PackingStatus : std::uint8_t {
    finished,   // the front has left the box, or the wanted number of circles is reached
    bad_start,  // no three circles about the origin
    stuck,      // no edge can be advanced, not even badly: cannot happen in exact arithmetic
    too_many,   // more circles than half-edges can be numbered for
    stopped,    // whoever watches, or draws the radii, wanted no more
};

/// How the packing ended, and where: the origin or the middle of an edge of the front.
struct PackingEnd {
    PackingStatus status;
    Point2 place;
};

/// Asked now and then, with the number of circles so far, whether the packing shall go on.
using Watch = std::function<bool(Vertex circles)>;

struct Packing {
    Triangulation t;
    Front front;
    EdgeHeap heap;             // edges of the front, nearest to the origin first
    Array<FrontEdge> waiting;  // edges of the front that wait for their neighbours
    Array<double> radius;      // of the circles: got over wanted radius
    Array<double> drawn;       // the radius each circle is to have; none where a field says it
    PackingLimits limits;
    double narrow = 1.40;  // a corner a, b, c is filled straight away when l(a, c) is below
    PackingCounts counts;
    PackingEnd end{PackingStatus::finished, {0.0, 0.0}};
    std::int64_t moves = 0;   // of the front since the waiting edges were last queued
    bool is_forcing = false;  // all edges wait: what is not good must do
    Array<HalfEdge> behind;   // scratch: edges to look through, behind the front
};

}  // namespace surfmesh
