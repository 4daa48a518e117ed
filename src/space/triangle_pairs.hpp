// Do two triangles in space meet where they should not? Judged exactly.
//
// Corners at the same place are one vertex, whatever their numbers. Triangles that share
//
// - no vertex meet when they have any point in common;
// - one vertex     when they have another point in common;
// - two vertices   when they lie in one plane on the same side of their edge: a fold;
// - three          always.
//
// Most pairs of neighbours are told apart by a plane between them, found and judged in floating
// point with a margin for rounding. Only the others are looked at exactly. A triangle without
// area meets nothing: it is a fault of its own, and its neighbours hold its edges.
#pragma once

#include <array>
#include <cstdint>

#include "values/point.hpp"

namespace surfmesh {

using Triangle3 = std::array<Point3, 3>;

/// A triangle with a number for each corner, by its place: corners at one place have one number,
/// and others seldom the same, so that most pairs of corners are told apart at once.
struct KeyedTriangle {
    Triangle3 corners;
    std::array<std::uint32_t, 3> keys;
};

std::uint32_t corner_key(Point3 p);
KeyedTriangle keyed(const Triangle3& corners);

/// Do two triangles with finite corners meet where they should not?
bool triangles_meet(const KeyedTriangle& s, const KeyedTriangle& t);

}  // namespace surfmesh
