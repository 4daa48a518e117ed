// Which piece of the surface a triangle is compared with: sides bent in (u, v), so that r(psi) is
// linear within the triangle's plane but for the third order.
//
//        a ------ M ------ b      M: the middle of the side in space
//         `-.     |     .-'       its place in (u, v) is that of the nearest point of the surface,
//            `--- r(m) '          not the middle of those of a and b
//
// Pieces of neighbours have one curve over their side, and psi has positive Jacobian, so that they
// tile what straight ones do: rims of the face stay where they are, and so do sides whose
// parameters differ on their two sides (seams, poles): their middle slides along them.
//
// In: the triangles of one face. Out: how far middles of their sides are moved; nothing on surfaces
// that do not bound their fourth derivatives. Nothing is changed.
#pragma once

#include <cstdint>
#include <span>

#include "proof/plane_piece.hpp"
#include "surfaces/surface.hpp"
#include "values/array.hpp"

namespace surfmesh {

struct FaceSides {
    std::span<const SpaceCorners> corners;
    std::span<const PlaneCorners> uv;
    std::span<const std::int32_t> vertices, twins;
};

/// middles (m), in space, of the sides of each triangle; none: of straight ones. ``bends`` is filled.
SurfaceStatus curved_pieces(const Surface& surface, const FaceSides& face,
                            std::span<const SpaceCorners> middles, Array<PlaneBends>& bends);

/// No bends at the sides of triangles that have is_bad (m,).
void straighten(const FaceSides& face, std::span<const std::uint8_t> is_bad,
                std::span<PlaneBends> bends);

}  // namespace surfmesh
