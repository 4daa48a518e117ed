// Surfaces that bound their derivatives to the third order: what surfaces made of them need.
//
// In: a cell of the (u, v) plane, or a point. Out: boxes of the derivatives over the parts of the
// cell between knots, within each of which the surface is smooth; boxes of the tangents at the
// point. All round-off is in them. Nothing is changed.
#pragma once

#include <array>
#include <cstdint>

#include "surfaces/enclosure.hpp"
#include "surfaces/surface.hpp"

namespace surfmesh {

/// In the sequence of derivatives (surface.hpp); r itself is not bounded.
using DerivativeBoxes = std::array<BoxedVector, derivative_count(3)>;

/// The parts of a cell, rows of v: part (i, j) is boxes[i parts_v + j].
struct PartBoxes {
    std::size_t parts_u = 0, parts_v = 0;
    Array<DerivativeBoxes> boxes;
    // before each part along u or v: may the second derivative across jump there?
    Array<std::uint8_t> jumps_u, jumps_v;
};

/// Boxes of r_u and r_v; at a crease, of both its sides.
struct TangentBoxes {
    BoxedVector u, v;
};

class ThirdDerivatives {
  public:
    virtual ~ThirdDerivatives() = default;

    /// Boxes along three directions. False where nothing is known, and where a first derivative may
    /// jump within the cell.
    [[nodiscard]] virtual bool enclose_third(const ParameterBox& cell, const Directions& directions,
                                             PartBoxes& out) const = 0;
    [[nodiscard]] virtual bool enclose_tangents(Point2 uv, TangentBoxes& out) const = 0;

  protected:
    ThirdDerivatives() = default;
    ThirdDerivatives(const ThirdDerivatives&) = default;
    ThirdDerivatives(ThirdDerivatives&&) = default;
    ThirdDerivatives& operator=(const ThirdDerivatives&) = default;
    ThirdDerivatives& operator=(ThirdDerivatives&&) = default;
};

}  // namespace surfmesh
