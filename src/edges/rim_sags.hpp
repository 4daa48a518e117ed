// How far an edge lies from the chords between its nodes.
//
//           .--- curve ---.           sag: the largest distance from the chord, at a quarter, the
//     node o-- chord of it --o node   middle and three quarters of the parameters between
#pragma once

#include <cstdint>
#include <span>

#include "edges/curve_pieces.hpp"
#include "values/array.hpp"

namespace surfmesh {

struct RimSags {
    Array<double> sag, length;  // of the segments; length: of the chord
};

/// Of the segments of an edge between nodes; fraction (2 or more): of its range, rising.
void rim_sags(const CurvePieces& curves, std::int64_t edge, std::span<const double> fraction,
              RimSags& found);

}  // namespace surfmesh
