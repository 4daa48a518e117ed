// Which regions of the plane are inside a planar domain, by the loops that lie between them.
//
// In: the regions on both sides of each segment, and the segments of each loop, an outer one or a
// hole. Out: which regions lie in more outer loops than holes; or the region that contradicts.
// Loops may cross themselves and each other: crossing a segment changes for each of its loops
// whether one is inside it.
#pragma once

#include <cstdint>
#include <span>

#include "insertion/outcome.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// The regions on both sides of a segment; one twice for a line that ends freely.
struct SegmentSides {
    std::int32_t left, right;
};

/// A segment belongs to a loop; where a loop runs along it twice, the pair stands twice.
struct LoopSegment {
    std::int32_t segment, loop;
};

struct InsideRegions {
    Array<std::uint8_t> inside;  // of the regions 0 .. the largest number
    Recovery status = Recovery::finished;
    std::int32_t region = NIL;  // the one that contradicts
};

/// infinite: number of the unbounded region. is_hole: of the loops.
[[nodiscard]] InsideRegions inside_regions(std::span<const SegmentSides> sides,
                                           std::span<const LoopSegment> loop_segments,
                                           std::span<const std::uint8_t> is_hole,
                                           std::int32_t infinite);

}  // namespace surfmesh
