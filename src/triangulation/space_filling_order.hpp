// Numbers along Hilbert's curve: what is near in the plane is near in memory.
//
// In: points. Out: their indices in the order in which the curve meets them, ties by index. The
// curve runs through a square grid of 2^20 by 2^20 cells over the box of the points, by integers
// alone: the same order everywhere.
#pragma once

#include <span>

#include "values/array.hpp"
#include "values/conventions.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// ``some`` of the points, in the order of the curve.
Array<Vertex> along_hilbert_curve(std::span<const Point2> points, std::span<const Vertex> some);

}  // namespace surfmesh
