// The regularised incomplete beta function.
#pragma once

namespace surfmesh::elementary {

/// I_x(a, b), the integral of t^(a - 1) (1 - t)^(b - 1) from 0 to x over that from 0 to 1.
///
/// ``beta``: that from 0 to 1, B(a, b). a, b > 0; x from 0 to 1. By its continued fraction (NIST
/// Digital Library of Mathematical Functions, 8.17.22), from the end where that converges fast.
double incomplete_beta(double a, double b, double beta, double x);

}  // namespace surfmesh::elementary
