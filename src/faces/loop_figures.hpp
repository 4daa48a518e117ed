// By what the loops of a face are known again: alike faces have alike loops.
#pragma once

#include "faces/face_boundary.hpp"

namespace surfmesh {

struct LoopFigures {
    double segments;
    double length;  // of the polygon in space
    double sizes;   // sum of those that are finite, the ends of coedges twice
    double sized;   // how many these are
};

/// Of the loops of a boundary, in their order.
[[nodiscard]] Array<LoopFigures> loop_figures(const FaceBoundary& boundary);

}  // namespace surfmesh
