// Plane, cylinder, cone, sphere and torus, parametrised as CAD kernels do.
//
// In the frame (origin; x, y, z), with the radius R, the tube's radius r and the half angle a:
//
//     plane      u x + v y
//     cylinder   R e(u) + v z                              e(u) = cos u x + sin u y
//     cone       (R + v sin a) e(u) + v cos a z
//     sphere     R cos v e(u) + R sin v z
//     torus      (R + r cos v) e(u) + r sin v z
//
// All but the plane are p(v) e(u) + h(v) z: a line or a circle turned about z. So the derivative
// with k times d/du and l times d/dv is p^(l) e^(k), and h^(l) z where k = 0. The frame may be
// left-handed, which turns the normal round.
//
// Source: OCCT, package ElSLib (parametrisations).
#pragma once

#include "surfaces/face_surface.hpp"

namespace surfmesh {

/// A place with unit vectors at right angles.
struct Frame {
    Point3 origin, x, y, z;
};

class Plane final : public FaceSurface {
  public:
    Plane(const ParameterBox& domain, const Frame& frame) : FaceSurface(domain), frame_(frame) {}
    [[nodiscard]] const Frame& frame() const { return frame_; }
    SurfaceStatus evaluate(std::span<const Point2> uv, int order,
                           std::span<Point3> out) const override;
    SurfaceStatus derivative_magnitudes(std::span<const ParameterBox> cells, int order,
                                        std::span<Point3> out) const override;
    SurfaceStatus enclose(std::span<const Point2> uv, std::span<EnclosedPoint> out) const override;
    SurfaceStatus enclose_bends(std::span<const ParameterBox> cells,
                                std::span<const Directions> directions,
                                std::span<Bends> out) const override;

  private:
    Frame frame_;
};

/// The line or circle that is turned: p = radius + outwards v, h = upwards v on a line;
/// p = radius + tube cos v, h = tube sin v on a circle.
struct Profile {
    double radius;
    double outwards, upwards;
    double tube;
    bool is_circle;
};

class TurnedProfile final : public FaceSurface {
  public:
    TurnedProfile(const ParameterBox& domain, const Frame& frame, const Profile& profile)
        : FaceSurface(domain), frame_(frame), profile_(profile) {}
    [[nodiscard]] const Frame& frame() const { return frame_; }
    [[nodiscard]] const Profile& profile() const { return profile_; }
    SurfaceStatus evaluate(std::span<const Point2> uv, int order,
                           std::span<Point3> out) const override;
    SurfaceStatus derivative_magnitudes(std::span<const ParameterBox> cells, int order,
                                        std::span<Point3> out) const override;
    SurfaceStatus enclose(std::span<const Point2> uv, std::span<EnclosedPoint> out) const override;
    SurfaceStatus enclose_bends(std::span<const ParameterBox> cells,
                                std::span<const Directions> directions,
                                std::span<Bends> out) const override;

  private:
    Frame frame_;
    Profile profile_;
};

/// v runs along the generator; at v = 0 there is the radius, the half angle has either sign.
Profile profile_of_cone(double radius, double angle);

}  // namespace surfmesh
