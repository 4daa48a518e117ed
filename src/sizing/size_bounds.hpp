// What the least of all size rules is kept within on a surface.
//
// In: what is stated, and how large the surface is. Out: the smallest and the largest size. Who stated
// them, and in what words, is known in Python (surfmesh.sizing.rules.size_rules), which asks here.
#pragma once

#include <optional>

namespace surfmesh {

/// No size is smaller, as a fraction of the diagonal: at an apex the curvature is infinite.
inline constexpr double FINEST_SIZE = 1e-5;

/// ``angle`` asks for no smaller size, as a fraction of the diagonal: triangles about an apex are
/// bent by as much at any size.
inline constexpr double FINEST_BY_ANGLE = 2e-4;

/// No size is larger where none is stated, as a fraction of the diagonal.
inline constexpr double DEFAULT_MAX_SIZE = 0.1;

/// Likewise for the longer of two sizes of an anisotropic metric.
inline constexpr double LONGEST_SIZE = 1.0;

/// Model units; nothing where there is no number.
struct StatedBounds {
    std::optional<double> min_size, max_size;
    std::optional<double> size = {};  // the same everywhere
    bool has_size = false;            // a number or a law: then no largest one is assumed
    bool is_anisotropic = false;
};

/// Model units. The largest may be infinite, where a law alone decides.
struct SizeBounds {
    double smallest, largest;
    double longest;                         // along the longer axis of an anisotropic metric
    std::optional<double> default_largest;  // where it holds, before a smallest one is heard
};

/// diagonal: of the surface's bounding box.
[[nodiscard]] SizeBounds size_bounds(const StatedBounds& stated, double diagonal);

}  // namespace surfmesh
