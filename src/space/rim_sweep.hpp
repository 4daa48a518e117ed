// Is the rim of a patch simple in the plane, with the patch on its left everywhere?
//
//          .--<--.        The sweep goes from left to right, and from below to above where places
//         /   .   \       are above each other. Its line crosses the edges in their order: the rim
//        v   ( )   ^      is simple if none of them meet but at common vertices, and winds round a
//         \   '   /       place once or not at all if those that the sweep goes along with (patch
//          '-->--'        above) and against (patch below) take turns on it, from below.
//
// In: directed edges that go into each vertex as often as out. Judged by exact predicates, once at
// each vertex: edges are compared where they become neighbours on the line.
// Source: Shamos & Hoey, "Geometric intersection problems", FOCS 1976.
#pragma once

#include <span>

#include "values/array.hpp"
#include "values/conventions.hpp"
#include "values/point.hpp"

namespace surfmesh {

struct RimEdge {
    Vertex start, end;
    Point2 from, to;
};

/// False too where two vertices are at one place.
bool is_simple_rim(std::span<const RimEdge> edges);

}  // namespace surfmesh
