// Powers, the cube root and the length of a vector.
//
// In: any doubles. Out: x^y within 1 ulp and at zeros, infinities and nan as C99 (annex F) has it,
// from the logarithm as a sum of two doubles; the cube root within 0.51 ulp, by a polynomial, one
// step of Halley's method and one of Newton's whose remainder is exact.
#pragma once

#include <span>

namespace surfmesh::elementary {

double pow(double x, double y);
double cbrt(double x);
/// sqrt(x^2 + y^2) within 0.51 ulp, without overflow on the way; infinite where either is.
double hypot(double x, double y);

/// out[i] = pow(x[i], y[i]); all have one length, and out may be one of the others.
void pow(std::span<const double> x, std::span<const double> y, std::span<double> out);
/// out[i] = hypot(x[i], y[i]), likewise.
void hypot(std::span<const double> x, std::span<const double> y, std::span<double> out);
void cbrt(std::span<const double> x, std::span<double> out);

}  // namespace surfmesh::elementary
