// The error function, within 1 ulp: a series up to 1/2, polynomials on pieces of length 1/2 up to
// 6, and 1 from there on (1 - erf 6 < 2^-55).
#pragma once

#include <span>

namespace surfmesh::elementary {

double erf(double x);

/// out[i] = erf(x[i]); x and out have one length and may be the same.
void erf(std::span<const double> x, std::span<double> out);

}  // namespace surfmesh::elementary
