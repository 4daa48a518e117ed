// The order of the optimiser's passes; what each does is in the room optimisation.
//
// swap -> smooth -> degrees -> smooth -> swap -> collapse, split -> once more
// -> the worst triangles -> shapes -> dihedral angles -> distance from the surface
#pragma once

#include "patch/findings.hpp"
#include "patch/patch_state.hpp"

namespace surfmesh {

/// What the optimiser has left.
struct Unmended {
    Array<Triangle> far;     // farther than ``chord`` from the surface
    Array<Triangle> folded;  // turned far from the surface's normals
    Dihedrals dihedrals;     // edges with more than ``angle`` between their triangles
};

/// Optimise a patch in place; what is good already is left alone.
///
/// first: the sizes come from no earlier round, and one with finer sizes may follow. Where the
/// patch has stopped (``status``) it is left half-way, and nothing is found.
Unmended optimise(PatchState& state, bool first);

/// Only choose better diagonals for what the packing and the boundary left over.
void choose_diagonals(PatchState& state);

}  // namespace surfmesh
