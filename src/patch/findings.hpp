// Where the triangles of a patch are not right: too far from the surface, folded, bent.
#pragma once

#include "optimisation/dihedral.hpp"
#include "patch/patch_state.hpp"
#include "sizing/curvature_sizes.hpp"

namespace surfmesh {

inline constexpr double ANGLE_MARGIN = 0.97;       // of ``angle``: what is aimed at
inline constexpr double ANGLE_SLACK = 1.0 + 1e-9;  // at last no more than asked for; and rounding

/// Edges at which triangles meet at more than an angle, though the surface has no crease.
struct Dihedrals {
    struct Pair {
        Triangle first, second;
    };
    Array<Pair> triangles;  // on both sides
    Array<double> angles;   // radians between the normals
};

/// Largest distance from the surface at samples of each of the triangles.
Array<double> deviations(PatchState& state, std::span<const Triangle> triangles, double chord);

/// Triangles turned against the surface's normals at a corner or at the centroid.
Array<Triangle> find_folds(PatchState& state);

/// Edges with an angle over ``margin`` times the one asked for; seams too, if wanted.
Dihedrals find_dihedrals(PatchState& state, double margin, bool seams = false);

/// Radians.
inline double angle_limit(double degrees, double margin) { return margin * radians(degrees); }

}  // namespace surfmesh
