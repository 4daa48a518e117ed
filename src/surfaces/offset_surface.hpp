// A surface at a fixed distance from another, with exact derivatives: r + d n, with n = N / |N|
// and N = r_u x r_v.
//
// With s = |N| and N = s n the derivatives of n follow from those of N by the product rule:
//
//     N_u  = s_u n + s n_u                           s_u  = n . N_u
//     N_uv = s_uv n + s_u n_v + s_v n_u + s n_uv     s_uv = n_v . N_u + n . N_uv
//
// Where the other one has no normal (a pole), r lies on the limit of the normal from inside the
// domain, and the derivatives are those a little further inside.
//
// Source: OCCT, Geom_OffsetSurface (side of the offset).
#pragma once

#include <memory>

#include "surfaces/face_surface.hpp"

namespace surfmesh {

class OffsetSurface final : public FaceSurface {
  public:
    /// The basis must know its third derivatives; its own domain is that of the offset.
    OffsetSurface(std::shared_ptr<const Surface> basis, double distance)
        : FaceSurface(basis->domain()), basis_(std::move(basis)), distance_(distance) {}

    /// UNKNOWN for derivatives beyond the second.
    SurfaceStatus evaluate(std::span<const Point2> uv, int order,
                           std::span<Point3> out) const override;
    /// To the second order, where the basis has them to the third.
    SurfaceStatus derivative_magnitudes(std::span<const ParameterBox> cells, int order,
                                        std::span<Point3> out) const override;
    /// Where the basis bounds its derivatives to the third order; infinite where it may have no normal.
    SurfaceStatus enclose(std::span<const Point2> uv, std::span<EnclosedPoint> out) const override;
    SurfaceStatus enclose_bends(std::span<const ParameterBox> cells,
                                std::span<const Directions> directions,
                                std::span<Bends> out) const override;
    [[nodiscard]] std::exception_ptr take_failure() const override {
        return basis_->take_failure();
    }

  private:
    [[nodiscard]] bool is_pole(Point3 r_u, Point3 r_v) const;
    SurfaceStatus evaluate_at_pole(Point2 uv, int order, std::span<Point3> out) const;

    std::shared_ptr<const Surface> basis_;
    double distance_;
};

}  // namespace surfmesh
