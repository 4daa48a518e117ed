// Points of many surfaces at once, and their derivatives.
//
// In: surfaces, the number of one and (u, v) for each place. Out: r, or r, r_u, r_v, at each
// place; a surface that fails is named.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "surfaces/surface.hpp"
#include "values/array.hpp"

namespace surfmesh {

struct SurfacePoints {
    std::vector<Array<Point3>> values;  // derivative_count(order) of them
    std::int32_t failed = -1;           // number of a surface, then nothing else counts
};

SurfacePoints surface_points(std::span<const Surface* const> surfaces,
                             std::span<const std::int32_t> faces, std::span<const Point2> uv,
                             int order);

}  // namespace surfmesh
