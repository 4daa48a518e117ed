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
#include <span>

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

/// From the degree + 1 control points of a part's span to the Bezier coefficients over the part, the
/// same for all lines of a net.
class Restriction {
  public:
    Restriction(const SplineBasis& basis, const SpanPart& part);

    /// Replace control points, ``stride`` apart, by the coefficients.
    void apply(Homogeneous* control, std::size_t stride) const;
    /// The two coefficients at one end of the part alone, in their sequence, of a degree above 0.
    [[nodiscard]] std::array<Homogeneous, 2> at_end(const Homogeneous* control, std::size_t stride,
                                                    bool at_last) const;

  private:
    static constexpr std::size_t MOST = HIGHEST_DEGREE * (HIGHEST_DEGREE + 1) / 2;
    using Steps = std::array<double, MOST>;

    /// Weights of all steps towards t: step r = 1 ... degree has those of points r ... degree.
    void set_steps(std::span<const double> knots, double t, Steps& steps) const;
    [[nodiscard]] std::size_t first_of(std::size_t r) const {
        return (r - 1) * degree_ - (r - 1) * (r - 2) / 2;
    }
    void take_step(const Steps& steps, std::size_t r, Homogeneous* points) const;

    std::size_t degree_;
    Steps to_first_, to_last_;  // as many of them as the degree asks for
};

/// Of coefficients restricted in so many steps (the degrees together), of the largest of them.
inline double restriction_error(std::size_t degrees, double largest) {
    // a step is (1 - a) x + a y with a rounded quotient a in [0, 1]: nine roundings, of the larger
    return 16.0 * static_cast<double>(degrees + 1) * 0x1p-53 * largest;
}

}  // namespace surfmesh
