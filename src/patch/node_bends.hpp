// How the surface bends at the nodes of a size field, for circles whose sizes follow directions.
//
// In: the field of a surface, and what is asked for. Out: of each node the second fundamental form
// over eight chords, and by how much it is the chord that has decided its size: what other rules,
// rims or gradation have lowered below what the chord allows does not grow by the direction.
#pragma once

#include <span>

#include "packing/circle_sizes.hpp"
#include "patch/limits.hpp"
#include "surfaces/chart.hpp"
#include "surfaces/surface_reader.hpp"

namespace surfmesh {

/// Of the nodes of the background; asked.chord is there. on_lattice: sizes are those of a lattice.
/// What the surface says of its failure the reader knows.
[[nodiscard]] Array<NodeBend> node_bends(SurfaceReader& surface, const Chart& chart,
                                         const Background& background, const AskedAccuracy& asked,
                                         bool on_lattice);

}  // namespace surfmesh
