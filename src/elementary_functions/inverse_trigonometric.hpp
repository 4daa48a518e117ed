// Arcus functions: atan and atan2 within 0.7 ulp, asin and acos within 1.5.
//
// In: any doubles; nan where a function is undefined. Out: as C99 (annex F) has it at zeros and
// infinities. atan(a/b) = pi/4 + atan((a - b)/(a + b)) brings quotients to at most tan(pi/8),
// beyond 1 the quotient is turned over; asin near 1 is taken from the half angle (W.J. Cody,
// W. Waite, Software Manual for the Elementary Functions, 1980, chapters 10 and 11).
#pragma once

#include <span>

namespace surfmesh::elementary {

double atan(double x);
double atan2(double y, double x);
double asin(double x);
double acos(double x);

/// out[i] = f(x[i]); x and out have one length and may be the same.
void atan(std::span<const double> x, std::span<double> out);
void asin(std::span<const double> x, std::span<double> out);
void acos(std::span<const double> x, std::span<double> out);
/// out[i] = atan2(y[i], x[i]), likewise.
void atan2(std::span<const double> y, std::span<const double> x, std::span<double> out);

}  // namespace surfmesh::elementary
