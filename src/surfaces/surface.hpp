// What every surface of the core can do: r(u, v) and its derivatives for a block of points at a
// time, and bounds of the derivatives over cells where it knows them.
//
// The calls change nothing, so that several threads may use one surface. None of them throws: a
// surface that asks the caller's own code says FAILED and keeps the exception (take_failure),
// which the binding throws again once the call into the core has unwound.
#pragma once

#include <array>
#include <exception>
#include <span>

#include "surfaces/enclosure.hpp"
#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// A rectangle of the (u, v) plane: a domain, or a cell of one.
struct ParameterBox {
    Point2 low, high;
};

/// How many arrays there are to an order of derivatives: 1, 3, 6, 10.
///
/// Their sequence is r; r_u, r_v; r_uu, r_uv, r_vv; r_uuu, r_uuv, r_uvv, r_vvv: the one with k
/// times d/du and l times d/dv has the number that follows.
constexpr std::size_t derivative_count(int order) {
    return static_cast<std::size_t>((order + 1) * (order + 2) / 2);
}
constexpr std::size_t derivative_number(std::size_t k, std::size_t l) {
    return (k + l) * (k + l + 1) / 2 + l;
}

enum class [[nodiscard]] SurfaceStatus {
    DONE,
    UNKNOWN,  // the surface cannot say: its bounds, or derivatives of so high an order
    FAILED,   // the caller's own code raised an exception, or returned what is no answer
};

/// The derivatives that ``derivative_bounds`` bounds: r_u, r_v, r_uu, r_uv, r_vv.
inline constexpr std::size_t BOUNDED_DERIVATIVES = 5;

class Surface {
  public:
    virtual ~Surface() = default;

    [[nodiscard]] virtual ParameterBox domain() const = 0;

    /// Derivative k of point i into out[k n + i], for the n points uv and all k up to the order.
    ///
    /// Points outside the domain are allowed. The order is at most 2; surfaces of CAD faces go to
    /// 3. out: derivative_count(order) n values.
    virtual SurfaceStatus evaluate(std::span<const Point2> uv, int order,
                                   std::span<Point3> out) const = 0;

    /// Bounds of BOUNDED_DERIVATIVES over cells: those of cell i from lower[5 i], upper[5 i] on,
    /// infinite where they are not known. UNKNOWN where the surface knows none.
    virtual SurfaceStatus derivative_bounds(std::span<const ParameterBox> /*cells*/,
                                            std::span<Point3> /*lower*/,
                                            std::span<Point3> /*upper*/) const {
        return SurfaceStatus::UNKNOWN;
    }

    /// The same with bounds of r itself before them, so that nothing is missed between points:
    /// 1 + BOUNDED_DERIVATIVES a cell. Second derivatives have none across a kink, first ones none
    /// across a jump.
    virtual SurfaceStatus all_bounds(std::span<const ParameterBox> /*cells*/,
                                     std::span<Point3> /*lower*/,
                                     std::span<Point3> /*upper*/) const {
        return SurfaceStatus::UNKNOWN;
    }

    /// Of ``all_bounds`` those of r_uu, r_uv and r_vv alone, three a cell.
    virtual SurfaceStatus bend_bounds(std::span<const ParameterBox> cells, std::span<Point3> lower,
                                      std::span<Point3> upper) const;

    /// Bounds of the absolute values of all derivatives up to the order, 2 or 3, by coordinate:
    /// that of derivative k over cell i into out[derivative_count(order) i + k], of r itself 0.
    /// UNKNOWN where the surface has none. By default what ``derivative_bounds`` gives.
    virtual SurfaceStatus derivative_magnitudes(std::span<const ParameterBox> cells, int order,
                                                std::span<Point3> out) const;

    /// The points with a proved bound of their round-off. UNKNOWN where the surface knows none.
    virtual SurfaceStatus enclose(std::span<const Point2> /*uv*/,
                                  std::span<EnclosedPoint> /*out*/) const {
        return SurfaceStatus::UNKNOWN;
    }

    /// Proved bounds of the second derivatives over cells, each along its own directions; infinite
    /// where they are not known, and across kinks. UNKNOWN where the surface knows none.
    virtual SurfaceStatus enclose_bends(std::span<const ParameterBox> /*cells*/,
                                        std::span<const Directions> /*directions*/,
                                        std::span<Bends> /*out*/) const {
        return SurfaceStatus::UNKNOWN;
    }

    /// The exception behind FAILED, once. A surface that is made of others asks them.
    [[nodiscard]] virtual std::exception_ptr take_failure() const { return {}; }

  protected:
    Surface() = default;
    Surface(const Surface&) = default;
    Surface(Surface&&) = default;
    Surface& operator=(const Surface&) = default;
    Surface& operator=(Surface&&) = default;
};

/// A surface's values at a block of points, with their memory, which is used again.
class SurfaceValues {
  public:
    SurfaceStatus evaluate(const Surface& surface, std::span<const Point2> uv, int order) {
        points_ = uv.size();
        values_.resize(derivative_count(order) * points_);
        return surface.evaluate(uv, order, values_);
    }
    /// Derivative k at all points of the block.
    [[nodiscard]] std::span<const Point3> operator[](std::size_t k) const {
        return {values_.data() + k * points_, points_};
    }
    [[nodiscard]] const Array<Point3>& all() const { return values_; }

  private:
    Array<Point3> values_;
    std::size_t points_ = 0;
};

}  // namespace surfmesh
