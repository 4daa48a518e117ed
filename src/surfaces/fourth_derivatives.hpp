// Surfaces that bound their fourth derivatives: how far their second ones are from linear.
//
// In: points, or cells of the (u, v) plane. Out: r and its derivatives up to the second at points
// with all round-off in their errors; the second to fourth ones over cells, by middle and radius, which
// is infinite where they are not known. Nothing is changed.
#pragma once

#include <array>
#include <span>

#include "surfaces/surface.hpp"

namespace surfmesh {

/// r, r_u, r_v, r_uu, r_uv, r_vv.
using SecondJet = std::array<EnclosedPoint, 6>;

/// Of r_uu ... r_vv, r_uuu ... r_vvv, r_uuuu, r_uuuv, r_uuvv, r_uvvv, r_vvvv.
inline constexpr std::size_t HIGH_DERIVATIVES = 12;

/// Over a cell each is within rad of mid, coordinate by coordinate.
struct HighDerivatives {
    std::array<Point3, HIGH_DERIVATIVES> mid, rad;
};

class FourthDerivatives {
  public:
    virtual ~FourthDerivatives() = default;

    /// UNKNOWN where there are none.
    virtual SurfaceStatus enclose_second(std::span<const Point2> uv,
                                         std::span<SecondJet> out) const = 0;
    virtual SurfaceStatus enclose_high(std::span<const ParameterBox> cells,
                                       std::span<HighDerivatives> out) const = 0;

  protected:
    FourthDerivatives() = default;
    FourthDerivatives(const FourthDerivatives&) = default;
    FourthDerivatives(FourthDerivatives&&) = default;
    FourthDerivatives& operator=(const FourthDerivatives&) = default;
    FourthDerivatives& operator=(FourthDerivatives&&) = default;
};

}  // namespace surfmesh
