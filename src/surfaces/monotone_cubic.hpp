// A cubic spline that rises wherever its points do, once differentiable.
//
// Slopes are weighted harmonic means of those of the two steps beside a point, zero where these
// differ in sign (Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5, 1984, 300-304); at an end a
// parabola through three points gives the slope, held back where it would overshoot (Moler,
// Numerical Computing with Matlab, section 3.6). The same as SciPy's PchipInterpolator.
//
//     y_k -- h_k, m_k -- y_k+1       m: slope of the straight step, d: slope of the spline
//     d_k           d_k+1
#pragma once

#include <span>

#include "values/array.hpp"

namespace surfmesh {

class MonotoneCubic {
  public:
    /// Through points y at rising x, at least two.
    MonotoneCubic(std::span<const double> x, std::span<const double> y);

    /// Beyond the ends the outermost cubics go on.
    [[nodiscard]] double value(double x) const;
    [[nodiscard]] double derivative(double x) const;

  private:
    /// Of 1, w, w^2, w^3 in the distance w from the left end of a piece.
    struct Cubic {
        double c[4];
    };
    [[nodiscard]] std::ptrdiff_t piece_at(double x) const;

    Array<double> x_;
    Array<Cubic> pieces_;
};

}  // namespace surfmesh
