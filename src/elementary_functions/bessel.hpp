// Spherical Bessel functions of order 0, 1 and 2: sin(x)/x and its derivatives' parts.
//
// In: any double. Out: within 2 ulp up to x = 2, beyond it within 4 ulp of 1/|x|, their envelope
// (near zeros of the functions that is more of themselves); 0 at infinity.
#pragma once

#include <span>

namespace surfmesh::elementary {

double bessel_0(double x);
double bessel_1(double x);
double bessel_2(double x);

/// out[i] = f(x[i]); x and out have one length and may be the same.
void bessel_0(std::span<const double> x, std::span<double> out);
void bessel_1(std::span<const double> x, std::span<double> out);
void bessel_2(std::span<const double> x, std::span<double> out);

}  // namespace surfmesh::elementary
