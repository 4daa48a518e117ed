#include "elementary_functions/error_function.hpp"

#include <cmath>

#include "elementary_functions/blocks.hpp"
#include "elementary_functions/coefficients.hpp"
#include "elementary_functions/double_double.hpp"
#include "elementary_functions/polynomial.hpp"

namespace surfmesh::elementary {
namespace {

/// For |x| < 1/2.
double erf_near_zero(double x) {
    if (x == 0.0) return x;
    // products of parts would underflow: the first term, all that counts there, is scaled
    const double scale = std::abs(x) < 0x1p-500 ? 0x1p500 : 1.0;
    const RoundedNumber first = two_product(x * scale, TWO_OVER_ROOT_PI[0]);
    const double z = x * x;
    const double rest = (x * scale) * TWO_OVER_ROOT_PI[1] + x * z * polynomial(ERROR_FUNCTION, z);
    return (first.high + (first.low + rest)) / scale;
}

}  // namespace

double erf(double x) {
    const double size = std::abs(x);
    if (size < 0.5) return erf_near_zero(x);
    if (size >= 6.0) return std::copysign(1.0, x);
    if (std::isnan(x)) return x;
    const int piece = static_cast<int>(2.0 * size);
    const double* c = ERROR_FUNCTION_PIECES[piece - 1];
    const double d = size - 0.25 * (2 * piece + 1);
    double slope = c[15];
    for (int k = 14; k >= 2; --k) slope = slope * d + c[k];
    return std::copysign(c[0] + (c[1] + d * slope), x);
}

void erf(std::span<const double> x, std::span<double> out) { map_each(x, out, erf); }

}  // namespace surfmesh::elementary
