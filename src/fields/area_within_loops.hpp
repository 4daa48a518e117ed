// The metric area that a background gives to what lies within loops: how many triangles fit there.
//
// In: loops of the scaled plane, in any direction, one within another by even-odd, that do not
// cross. Out: the integral of 1 / det H over what they enclose of the background's box. The loops
// are cut in halves with the box, down to the leaves, so that each corner is looked at once a level:
//
//     .-------.-------.      a half without loops is empty, one whose loops are its own border is
//     |  .----|----.  |      integrated as a whole
//     '--|----'----|--'
#pragma once

#include "fields/background.hpp"
#include "values/plane_loops.hpp"

namespace surfmesh {

/// What is linear between the nodes of a leaf: A, as meshes have it, or the size, which is as exact
/// in larger leaves where it grows by the distance and H is a multiple of the identity. Of sizes,
/// what meshes have more triangles of where these change is counted too.
enum class Between { roots, sizes };

/// Corners are finite, or the result is no number.
[[nodiscard]] double metric_area_within(const Background& background, const PlaneLoops& loops,
                                        Between between = Between::roots);

}  // namespace surfmesh
