// Hyperbolic functions and their inverses: within 2 ulp, the sign of zero kept.
//
// Near 0 by odd series, elsewhere by the exponential and the logarithm as sums of two doubles, so
// that what cancels has been computed to more than double precision.
#pragma once

#include <span>

namespace surfmesh::elementary {

double sinh(double x);
double cosh(double x);
double tanh(double x);
double asinh(double x);
double acosh(double x);  // nan below 1
double atanh(double x);  // nan outside [-1, 1], infinite at its ends

/// out[i] = f(x[i]); x and out have one length and may be the same.
void sinh(std::span<const double> x, std::span<double> out);
void cosh(std::span<const double> x, std::span<double> out);
void tanh(std::span<const double> x, std::span<double> out);
void asinh(std::span<const double> x, std::span<double> out);
void acosh(std::span<const double> x, std::span<double> out);
void atanh(std::span<const double> x, std::span<double> out);

}  // namespace surfmesh::elementary
