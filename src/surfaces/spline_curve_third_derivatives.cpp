// Derivatives of a spline curve to the third order over ranges, by the differences of the Bezier
// coefficients of each span that a range meets; and its tangents at parameters, by those at an end.
#include "surfaces/bezier_boxes.hpp"
#include "surfaces/boxed_vectors.hpp"
#include "surfaces/knot_places.hpp"
#include "surfaces/spline_curve.hpp"

namespace surfmesh {

/// Over a part, of the derivatives up to the order, or at its first or last parameter where that is
/// given; the curve itself about a point.
CurveBoxes SplineCurve::boxes_of_part(const SpanPart& part, const Directions& directions,
                                      Point3 about, int order, const BezierCorner* end) const {
    const std::size_t count = basis_.degree() + 1;
    Array<Homogeneous> control(count);
    const Point3 middle = control_[part.span - static_cast<std::int64_t>(basis_.degree() / 2)];
    const double largest = coefficients(part, middle, {control.data(), count});
    const BezierNet net{count,
                        1,
                        part.last - part.first,
                        0.0,
                        {control.data(), count},
                        2.0 * restriction_error(basis_.degree(), largest),
                        largest,
                        !weights_.empty()};
    BezierWork work(count);
    const DerivativeBoxes found = boxes_of_net(net, directions, order, end, work);
    const auto& [x, y, z] = found[0];
    const BoxedVector value = {
        outward::add(x, outward::along_between(directions[0], about, middle)),
        outward::add(y, outward::along_between(directions[1], about, middle)),
        outward::add(z, outward::along_between(directions[2], about, middle))};
    return {value, found[1], found[3], found[6]};
}

bool SplineCurve::enclose_third(Interval t, const Directions& directions, Point3 about,
                                CurveParts& out) const {
    Array<SpanPart> parts;
    out.boxes.clear();
    if (basis_.degree() > HIGHEST_DEGREE || !split_at_knots(basis_, t.lo, t.hi, parts) ||
        !jumps_before(basis_, parts, out.jumps))
        return false;
    for (const SpanPart& part : parts)
        out.boxes.push_back(boxes_of_part(with_width(basis_, part), directions, about, 3, nullptr));
    return true;
}

bool SplineCurve::enclose_tangent(double t, BoxedVector& out) const {
    if (basis_.degree() > HIGHEST_DEGREE) return false;
    const auto places = places_at(basis_, t, {basis_.limits().first, basis_.limits().last});
    for (std::size_t i = 0; i < places.count; ++i) {
        const BezierCorner end{places.from_last[i], false};
        const BoxedVector found = boxes_of_part(places.part[i], AXES, {0.0, 0.0, 0.0}, 1, &end)[1];
        out = i == 0 ? found : outward::hull(out, found);
    }
    return true;
}

}  // namespace surfmesh
