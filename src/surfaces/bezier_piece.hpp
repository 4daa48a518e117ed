// A spline between two of its knots as a Bezier polynomial over a part of that span.
//
// In: a basis, a range of the parameter; the control points of a span. Out: the parts of the range,
// each within one span; the Bezier coefficients over a part, between which the polynomial lies, as
// do its derivatives between the differences of these. Computed to nearest: each is within
// ``restriction_error`` of the exact one.
//
// Source: Piegl, Tiller, "The NURBS Book", 1997, 5.3 and 5.4; L. Ramshaw, "Blossoms are polar
// forms", Computer Aided Geometric Design 6 (1989), 323-358.
#pragma once

#include <array>
#include <cstdint>

#include "surfaces/spline_basis.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// A part of a parameter's range within one span.
struct SpanPart {
    std::int64_t span;
    double first, last;  // of the polynomial: more than the part where that is narrow for its span
    double width;        // of the part itself
    bool
        after_crease;  // a knot as often as the degree, or a seam, is between this and the last one
};

/// The parts of a range, in their sequence, brought back by whole periods; false where it holds a
/// jump (a knot more often than the degree) inside, or leaves the knots by much.
[[nodiscard]] bool split_at_knots(const SplineBasis& basis, double first, double last,
                                  Array<SpanPart>& parts);

/// Of splines whose pieces are asked for: what CAD kernels allow.
inline constexpr std::size_t HIGHEST_DEGREE = 25;

/// x, y, z and the weight of a control point, the first three times the weight.
using Homogeneous = std::array<double, 4>;

/// Replace the degree + 1 control points of a part's span, `stride` apart, by the Bezier
/// coefficients over the part. work: degree + 1 points.
void restrict_to(const SplineBasis& basis, const SpanPart& part, Homogeneous* control,
                 std::size_t stride, Homogeneous* work);

/// Of coefficients restricted in so many steps (the degrees together), of the largest of them.
inline double restriction_error(std::size_t degrees, double largest) {
    // a step is (1 - a) x + a y with a rounded quotient a in [0, 1]: nine roundings, of the larger
    return 16.0 * static_cast<double>(degrees + 1) * 0x1p-53 * largest;
}

}  // namespace surfmesh
