// What every curve of the core can do: c(t) and its derivatives for a block of parameters.
//
// Curves of the (u, v) plane are curves in space with z = 0. The calls change nothing, so that
// several threads may use one curve, and none of them fails.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "surfaces/enclosure.hpp"
#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

/// Parameters of a piece of a curve.
struct ParameterRange {
    double first, last;
};

/// Ranges of w . (c - about), w . c' and w . c'' for a vector w; and how much w . c' jumps at creases,
/// in absolute value and in all.
struct CurveAlong {
    std::array<Interval, 3> order;
    double jump = 0.0;

    Interval& operator[](std::size_t k) { return order[k]; }
    const Interval& operator[](std::size_t k) const { return order[k]; }
};

/// Boxes of c - about, c', c'' and c''' along three directions.
using CurveBoxes = std::array<BoxedVector, 4>;

/// The parts of a range between knots, within each of which the curve is smooth; c'' may jump
/// before some of them.
struct CurveParts {
    Array<CurveBoxes> boxes;
    Array<std::uint8_t> jumps;
};

class Curve {
  public:
    virtual ~Curve() = default;

    /// 2 in the (u, v) plane, 3 in space.
    [[nodiscard]] virtual int dimension() const = 0;

    /// Derivative k at t[i] into out[k n + i], for the n parameters t and all k up to the order.
    virtual void evaluate(std::span<const double> t, int order, std::span<Point3> out) const = 0;

    /// Bounds of the absolute values of the derivatives 1 to ``order`` over ranges, by
    /// coordinate: that of derivative k over range i into out[(order + 1) i + k], of c itself 0.
    /// False where the curve has none.
    [[nodiscard]] virtual bool derivative_magnitudes(std::span<const ParameterRange> /*ranges*/,
                                                     int /*order*/,
                                                     std::span<Point3> /*out*/) const {
        return false;
    }

    /// Proved bounds over a range of t; false where none are known.
    [[nodiscard]] virtual bool enclose_along(Interval /*t*/, Point3 /*w*/, Point3 /*about*/,
                                             CurveAlong& /*out*/) const {
        return false;
    }

    /// Proved boxes to the third order along directions of any length, over a range of t that may
    /// have no length; false where none are known, and where c' may jump within the range.
    [[nodiscard]] virtual bool enclose_third(Interval /*t*/, const Directions& /*directions*/,
                                             Point3 /*about*/, CurveParts& /*out*/) const {
        return false;
    }
    /// A proved box of c' at a parameter; at a crease, of both its sides.
    [[nodiscard]] virtual bool enclose_tangent(double /*t*/, BoxedVector& /*out*/) const {
        return false;
    }

  protected:
    Curve() = default;
    Curve(const Curve&) = default;
    Curve(Curve&&) = default;
    Curve& operator=(const Curve&) = default;
    Curve& operator=(Curve&&) = default;
};

/// A curve's values at a block of parameters, with their memory.
class CurveValues {
  public:
    CurveValues(const Curve& curve, std::span<const double> t, int order)
        : values_(static_cast<std::size_t>(order + 1) * t.size()), count_(t.size()) {
        curve.evaluate(t, order, values_);
    }
    /// Derivative k at all parameters.
    [[nodiscard]] std::span<Point3> operator[](int k) const {
        return {values_.data() + static_cast<std::size_t>(k) * count_, count_};
    }
    [[nodiscard]] const Array<Point3>& all() const { return values_; }

  private:
    Array<Point3> values_;
    std::size_t count_;
};

}  // namespace surfmesh
