// How far the pieces of a curve lie from their chords.
//
//           .--- curve ---.           sag: the largest distance from the chord, at a quarter, the
//     node o-- chord of it --o node   middle and three quarters of the piece's parameters
#pragma once

#include <span>

#include "surfaces/curve.hpp"
#include "values/array.hpp"

namespace surfmesh {

struct RimSags {
    Array<double> sag, length;  // of the pieces; length: of the chord
};

/// Of the pieces between parameters t that follow each other.
void rim_sags(const Curve& curve, std::span<const double> t, RimSags& found);

}  // namespace surfmesh
