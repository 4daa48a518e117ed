// The same surface over another box of its parameters.
#pragma once

#include "surfaces/surface.hpp"

namespace surfmesh {

class SurfaceOverBox final : public Surface {
  public:
    /// ``surface`` outlives this one.
    SurfaceOverBox(const Surface& surface, const ParameterBox& box)
        : surface_(surface), box_(box) {}

    [[nodiscard]] ParameterBox domain() const override { return box_; }
    SurfaceStatus evaluate(std::span<const Point2> uv, int order,
                           std::span<Point3> out) const override {
        return surface_.evaluate(uv, order, out);
    }
    SurfaceStatus derivative_bounds(std::span<const ParameterBox> cells, std::span<Point3> lower,
                                    std::span<Point3> upper) const override {
        return surface_.derivative_bounds(cells, lower, upper);
    }
    SurfaceStatus derivative_magnitudes(std::span<const ParameterBox> cells, int order,
                                        std::span<Point3> out) const override {
        return surface_.derivative_magnitudes(cells, order, out);
    }
    [[nodiscard]] std::exception_ptr take_failure() const override {
        return surface_.take_failure();
    }

  private:
    const Surface& surface_;
    ParameterBox box_;
};

}  // namespace surfmesh
