// A surface that is the caller's own object in Python: the only one that takes the interpreter.
//
// The object satisfies surfmesh.geometry.surface.Surface. It is called for a block of points at a
// time, from any thread; what it returns is checked for number, shape and type. The first
// exception is kept until it is taken.
#pragma once

#include <nanobind/nanobind.h>

#include "surfaces/surface.hpp"

namespace surfmesh {

class CallbackSurface final : public Surface {
  public:
    /// Throws what reading the object's ``domain`` throws; the interpreter is held.
    explicit CallbackSurface(nanobind::object surface);
    ~CallbackSurface() override;
    CallbackSurface(const CallbackSurface&) = delete;
    CallbackSurface& operator=(const CallbackSurface&) = delete;

    [[nodiscard]] ParameterBox domain() const override { return domain_; }
    SurfaceStatus evaluate(std::span<const Point2> uv, int order,
                           std::span<Point3> out) const override;
    SurfaceStatus derivative_bounds(std::span<const ParameterBox> cells, std::span<Point3> lower,
                                    std::span<Point3> upper) const override;
    /// UNKNOWN where the object has none.
    SurfaceStatus all_bounds(std::span<const ParameterBox> cells, std::span<Point3> lower,
                             std::span<Point3> upper) const override;
    [[nodiscard]] std::exception_ptr take_failure() const override;

    /// The object, for the collector of cyclic references, which may take it away.
    [[nodiscard]] nanobind::object& object() { return surface_; }

  private:
    SurfaceStatus bounds_by(const char* method, std::span<const ParameterBox> cells,
                            std::span<Point3> lower, std::span<Point3> upper) const;

    nanobind::object surface_;  // touched only while the interpreter is held, as is failure_
    ParameterBox domain_;
    mutable std::exception_ptr failure_;
};

/// What a binding does once its call has unwound: throw what the caller's own surface raised.
void raise_failure(const Surface& surface, SurfaceStatus status);

}  // namespace surfmesh
