#include "elementary_functions/bessel.hpp"

#include <cmath>

#include "elementary_functions/blocks.hpp"
#include "elementary_functions/coefficients.hpp"
#include "elementary_functions/polynomial.hpp"
#include "elementary_functions/sine_cosine.hpp"

namespace surfmesh::elementary {

double bessel_0(double x) {
    if (x == 0.0) return 1.0;
    return std::isinf(x) ? 0.0 : sin(x) / x;
}

double bessel_1(double x) {
    if (std::abs(x) <= 2.0) return x * polynomial(BESSEL_1, x * x);
    if (std::isinf(x)) return 0.0;
    const SineCosine both = sincos(x);
    return (both.sine / x - both.cosine) / x;
}

double bessel_2(double x) {
    if (std::abs(x) <= 3.0) return x * x * polynomial(BESSEL_2, x * x);
    if (std::isinf(x)) return 0.0;
    const SineCosine both = sincos(x);
    return (3.0 * (both.sine / x - both.cosine) / x - both.sine) / x;
}

void bessel_0(std::span<const double> x, std::span<double> out) { map_each(x, out, bessel_0); }
void bessel_1(std::span<const double> x, std::span<double> out) { map_each(x, out, bessel_1); }
void bessel_2(std::span<const double> x, std::span<double> out) { map_each(x, out, bessel_2); }

}  // namespace surfmesh::elementary
