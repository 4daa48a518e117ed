// The surface of three formulas in u and v: tapes of r, of r and its first, and of its second
// derivatives.
//
// Where a derivative is not finite (the apex of a cone) the derivatives are those a billionth of
// the domain further inside; where the speed has no bound (the rim of z = sqrt(1 - u^2)) those as
// near to that place as the limits allow. r itself is left as it is.
#pragma once

#include <array>
#include <memory>

#include "surfaces/fourth_derivatives.hpp"
#include "surfaces/surface.hpp"
#include "surfaces/tape.hpp"
#include "surfaces/tape_bounds.hpp"

namespace surfmesh {

/// How near to places of infinite speed derivatives are taken, along one parameter.
///
///     places   p0 ---------- p1 ---------- p2
///     limits     [lo0, hi0]    [lo1, hi1]         within each piece between two of them
struct SpeedLimits {
    Array<double> places;  // ascending, or none: the speed is finite everywhere
    Array<double> lowest, highest;

    [[nodiscard]] double kept_off(double u) const;
};

class FormulaSurface final : public Surface, public FourthDerivatives {
  public:
    using Tapes = std::array<std::shared_ptr<const Tape>, 3>;

    /// tapes: of order 0, 1, 2, two inputs and 3 derivative_count(order) outputs each; none where
    /// an order is not wanted.
    FormulaSurface(Tapes tapes, ParameterBox domain, std::array<SpeedLimits, 2> limits);

    [[nodiscard]] ParameterBox domain() const override { return domain_; }
    SurfaceStatus evaluate(std::span<const Point2> uv, int order,
                           std::span<Point3> out) const override;
    /// Of the smooth pieces in a cell, whether there are kinks between them or not.
    SurfaceStatus derivative_bounds(std::span<const ParameterBox> cells, std::span<Point3> lower,
                                    std::span<Point3> upper) const override;
    SurfaceStatus all_bounds(std::span<const ParameterBox> cells, std::span<Point3> lower,
                             std::span<Point3> upper) const override;
    SurfaceStatus bend_bounds(std::span<const ParameterBox> cells, std::span<Point3> lower,
                              std::span<Point3> upper) const override;
    SurfaceStatus enclose(std::span<const Point2> uv, std::span<EnclosedPoint> out) const override;
    SurfaceStatus enclose_bends(std::span<const ParameterBox> cells,
                                std::span<const Directions> directions,
                                std::span<Bends> out) const override;
    SurfaceStatus enclose_second(std::span<const Point2> uv,
                                 std::span<SecondJet> out) const override;
    SurfaceStatus enclose_high(std::span<const ParameterBox> cells,
                               std::span<HighDerivatives> out) const override;

  private:
    SurfaceStatus bounds_from(std::size_t first, Kinks kinks, std::span<const ParameterBox> cells,
                              std::span<Point3> lower, std::span<Point3> upper) const;
    /// Derivatives that are not finite replaced by those further inside, in the end by 0.
    void mend(const Tape& tape, std::span<const Point2> uv, std::span<Point3> out) const;
    [[nodiscard]] Point2 kept_off(Point2 uv) const;
    [[nodiscard]] Point2 nudged(Point2 uv, double fraction) const;

    Tapes tapes_;
    ParameterBox domain_;
    std::array<SpeedLimits, 2> limits_;
};

}  // namespace surfmesh
