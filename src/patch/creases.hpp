// Angles between neighbouring triangles that the surface makes by itself.
//
// A surface bends by itself at a crease where two of its sides meet, or at an apex: there
// the angle is as large at any size.
//
//           c                  half-edge e runs from a to b in a-b-c, half-edge f from b to a
//          / \                 in b-a-d: corners beside the edge are (a, b, c), (b, a, d)
//         / e \                .
//        a --- b
//         \ f /
//          \ /
//           d
#pragma once

#include <array>
#include <span>

#include "patch/deviation.hpp"
#include "surfaces/surface_reader.hpp"

namespace surfmesh {

/// The corners beside an edge in (u, v), those of each triangle with the ends of the edge first.
struct CornersBesideEdge {
    ParameterTriangle first, second;
};

/// Which edges lie on a crease, at an apex, or as good as at one.
///
/// As good as at an apex: curved so much that ``angle`` (degrees) would ask for less than the
/// finest size by angle, a fraction of ``diagonal`` (model units). Both triangles begin at the
/// same end where ``alike`` is set, as somewhere on a Moebius strip.
Array<std::uint8_t> on_crease(SurfaceReader& surface, std::span<const CornersBesideEdge> edges,
                              std::span<const std::uint8_t> alike, double angle, double diagonal);

}  // namespace surfmesh
