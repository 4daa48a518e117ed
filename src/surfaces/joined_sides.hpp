// Which opposite sides of a surface's domain are one curve: a search may go on across them.
//
// In: a surface. Out: for u and for v whether the side where it is least is that where it is
// largest, at the same value of the other parameter or, as of a Moebius strip, at the mirrored one.
#pragma once

#include "surfaces/surface_reader.hpp"

namespace surfmesh {

struct JoinedSides {
    enum class Kind { OPEN, SAME, MIRRORED };
    Kind u, v;

    /// A place beyond joined sides by less than the domain's width, where it is within them; what
    /// is beyond open ones stays there.
    [[nodiscard]] Point2 crossed(Point2 place, const ParameterBox& domain) const;
};

/// Compared at a few places; the block that was read before is forgotten.
[[nodiscard]] JoinedSides joined_sides(SurfaceReader& surface);

}  // namespace surfmesh
