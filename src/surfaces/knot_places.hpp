// The parts of a spline between its knots, for derivatives to the third order: their least width,
// where the second may jump, and the polynomials on both sides of a parameter.
#pragma once

#include <array>
#include <cstdint>

#include "surfaces/bezier_piece.hpp"
#include "surfaces/interval.hpp"

namespace surfmesh {

/// A part that has a width, within the same span: of cells that have none, as along a side.
SpanPart with_width(const SplineBasis& basis, SpanPart part);

/// May a second derivative jump before the parts; false where a first one may.
[[nodiscard]] bool jumps_before(const SplineBasis& basis, const Array<SpanPart>& parts,
                                Array<std::uint8_t>& jumps);

/// The polynomials of a parameter, two where it is a crease.
struct PlacesAtParameter {
    std::array<SpanPart, 2> part;
    std::array<bool, 2> from_last;  // the parameter is the part's last one
    std::size_t count = 0;
};

/// domain: what is in use, at whose ends there is one side only.
PlacesAtParameter places_at(const SplineBasis& basis, double t, Interval domain);

}  // namespace surfmesh
