// Offset curves c + D m / |m| along a vector, by boxes of the derivatives of c to the third order
// (unit_vector_bounds.hpp): m = c' x a, m' = c'' x a, m'' = c''' x a.
//
// Across a knot where c'' jumps by J, the derivative of m / |m| jumps by the part of (J x a) / |m|
// across it.
#include "surfaces/offset_curve.hpp"
#include "surfaces/unit_vector_bounds.hpp"

namespace surfmesh {
namespace {

using outward::add, outward::subtract, outward::multiply, outward::exactly;
using outward::dot, outward::cross;

/// Of one part along a direction, the first and the second derivative; in a frame.
struct OffsetAlong {
    Interval first, second;
};

/// An offset of which the parts are taken one after the other; all in one frame.
class OffsetParts {
  public:
    OffsetParts(Point3 side, Point3 direction, double distance)
        : side_(outward::exactly(side)), direction_(direction), distance_(distance) {}

    /// False where there may be no tangent.
    [[nodiscard]] bool take(const CurveBoxes& c, OffsetAlong& out) {
        if (!bound_unit_vector(cross(c[1], side_), unit_)) return false;
        const BoxedVector m_1 = cross(c[2], side_), m_2 = cross(c[3], side_);
        const FirstOfVector first{m_1, unit_.first(m_1)};
        const BoxedVector second = unit_.second(m_2, first, first);
        const SplitDirection split(direction_, unit_.n);
        // the first derivative is across the unit vector
        const Interval slope = outward::common(along(direction_, first.n), dot(split.t, first.n));
        const Interval square = outward::square(first.n);
        out.first = offset_by(c[1], slope, outward::norm_1(first.n));
        out.second = offset_by(c[2], split.along_second(second, square),
                               outward::norm_1(second) + outward::magnitude(square));
        return true;
    }
    /// At the knot before the part taken last.
    [[nodiscard]] double jump(const CurveBoxes& before, const CurveBoxes& after) const {
        const BoxedVector m_1 = cross(subtract(after[2], before[2]), side_);
        const BoxedVector of_unit = across(m_1, unit_.n, unit_.per_length);
        const double size = outward::magnitude(along(direction_, of_unit)) +
                            FRAME_ROUNDING * outward::norm_1(of_unit);
        return outward::above(std::abs(distance_) * outward::above(size));
    }

  private:
    [[nodiscard]] Interval offset_by(const BoxedVector& c, Interval of_unit, double size) const {
        const double margin = FRAME_ROUNDING * (outward::norm_1(c) + std::abs(distance_) * size);
        const Interval sum = add(along(direction_, c), multiply(exactly(distance_), of_unit));
        return add(sum, {-margin, margin});
    }

    BoxedVector side_;
    Point3 direction_;
    double distance_;
    UnitVector unit_{};
};

}  // namespace

/// w . (c - about) at a parameter.
bool OffsetCurve::enclose_point(double t, Point3 w, Point3 about, Interval& out) const {
    CurveAlong c;
    BoxedVector tangent{};
    UnitVector unit{};
    if (!curve_->enclose_along({t, t}, w, about, c) || !curve_->enclose_tangent(t, tangent) ||
        !bound_unit_vector(cross(tangent, exactly(side())), unit))
        return false;
    out = add(c[0], multiply(exactly(distance_), along(w, unit.n)));
    return true;
}

bool OffsetCurve::enclose_along(Interval t, Point3 w, Point3 about, CurveAlong& out) const {
    const double middle = 0.5 * (t.lo + t.hi);
    const CurveValues at_middle(*curve_, {&middle, 1}, 1);
    const Directions frame = frame_at(at_middle[1][0], side());
    CurveParts parts;
    Interval value{};
    if (!enclose_point(middle, w, about, value) || !curve_->enclose_third(t, frame, about, parts))
        return false;
    const Directions own = in_frame(frame, {side(), w, w});
    OffsetParts offset(own[0], own[1], distance_);
    const std::span boxes(parts.boxes.data(), parts.boxes.size());
    out = CurveAlong{};
    for (std::size_t p = 0; p < boxes.size(); ++p) {
        OffsetAlong found{};
        if (!offset.take(boxes[p], found)) return false;
        out[1] = p == 0 ? found.first : outward::hull(out[1], found.first);
        out[2] = p == 0 ? found.second : outward::hull(out[2], found.second);
        if (parts.jumps.data()[p] != 0)
            out.jump = outward::above(out.jump + offset.jump(boxes[p - 1], boxes[p]));
    }
    const Interval from_middle = subtract(t, exactly(middle));
    out[0] = add(value, multiply(from_middle, out[1]));
    return true;
}

}  // namespace surfmesh
