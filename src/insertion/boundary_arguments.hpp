// The boundary of a domain as it comes from numpy: checked, and as the core takes it.
#pragma once

#include <optional>

#include "binding/arrays.hpp"
#include "insertion/boundary_recovery.hpp"

namespace surfmesh::binding {

template <>
struct Row<Segment> : RowOf<std::int32_t, 2> {};

using Pairs = Matrix<std::int32_t, 2>;
using Numbers = Vector<std::int32_t>;
using Bytes = Vector<std::uint8_t>;

void require_finite(const Points2& points, const char* what);
void require_pairs(const Pairs& pairs, std::size_t count, const char* what);
/// Column ``k`` of pairs has indices below ``count``.
void require_column(const Pairs& pairs, std::size_t k, std::size_t count, const char* what);

/// Lengths of loops add up to the number of nodes.
void require_lengths(const Numbers& lengths, std::size_t total);

/// Views of the arrays; raises ``ValueError`` for indices out of range and places not finite.
LoopBoundary loop_boundary(const Points2& nodes, const Pairs& segments, const Pairs& inner,
                           const Vector<std::int64_t>& identity,
                           const std::optional<Points3>& points);
PlanarBoundary planar_boundary(const Points2& nodes, const Pairs& pieces, const Numbers& segment,
                               const Pairs& loop_segments, const Bytes& is_hole);

}  // namespace surfmesh::binding
