// Rows of what stands in one row, part after part, and numbers of the nodes of edges.
#pragma once

#include <cstdint>
#include <span>

#include "edges/edge_gradation.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// The rows first[k] to first[k + 1] of each k in ``which``, one after the other.
[[nodiscard]] Array<std::int64_t> rows_of_parts(std::span<const std::int64_t> first,
                                                std::span<const std::int64_t> which);

/// Numbers in the mesh of the nodes of edges: ends have those of their vertices, nodes with a
/// number in ``known`` keep it, the others count on from ``following``.
///
/// first: of the edges and behind the last, two nodes each at least. known: -1 for none; empty:
/// none has any.
[[nodiscard]] Array<std::int64_t> node_numbers(std::span<const std::int64_t> first,
                                               std::span<const SegmentEnds> ends,
                                               std::span<const std::int64_t> known,
                                               std::int64_t following);

}  // namespace surfmesh
