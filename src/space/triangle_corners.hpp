// A triangle of a mesh as the numbers of its vertices.
#pragma once

#include "values/conventions.hpp"

namespace surfmesh {

struct TriangleCorners {
    Vertex a, b, c;
};

}  // namespace surfmesh
