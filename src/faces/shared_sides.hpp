// Triangles at the vertices that faces share: where faces may have made the same side.
//
// In: triangles of a whole model, and which of its vertices more than one face may have. A side
// that more than one face can use is between two of these.
#pragma once

#include <cstdint>
#include <span>

#include "space/triangle_corners.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// Is a side between two shared vertices used by more than two triangles?
[[nodiscard]] bool has_crowded_side(std::span<const TriangleCorners> triangles,
                                    std::span<const std::uint8_t> shared);

/// Numbers of the triangles whose corners are all shared, rising.
[[nodiscard]] Array<std::int64_t> triangles_of_shared(std::span<const TriangleCorners> triangles,
                                                      std::span<const std::uint8_t> shared);

}  // namespace surfmesh
