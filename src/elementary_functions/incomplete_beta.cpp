#include "elementary_functions/incomplete_beta.hpp"

#include <cmath>

#include "elementary_functions/power.hpp"

namespace surfmesh::elementary {
namespace {

constexpr int MOST_TERMS = 500;  // some ten are needed for the powers of an axis
constexpr double SMALLEST = 1e-300, ROUNDING = 3e-16;

/// The continued fraction by the modified method of Lentz.
double continued_fraction(double a, double b, double x) {
    double c = 1.0, d = 1.0 - (a + b) * x / (a + 1.0);
    const auto kept_off_zero = [](double y) { return std::abs(y) < SMALLEST ? SMALLEST : y; };
    d = 1.0 / kept_off_zero(d);
    double value = d;
    for (int m = 1; m < MOST_TERMS; ++m) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        d = 1.0 / kept_off_zero(1.0 + even * d);
        c = kept_off_zero(1.0 + even / c);
        value *= c * d;
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1.0 / kept_off_zero(1.0 + odd * d);
        c = kept_off_zero(1.0 + odd / c);
        value *= c * d;
        if (std::abs(c * d - 1.0) <= ROUNDING) break;
    }
    return value;
}

}  // namespace

double incomplete_beta(double a, double b, double beta, double x) {
    if (!(x > 0.0)) return 0.0;
    if (!(x < 1.0)) return 1.0;
    const double front = pow(x, a) * pow(1.0 - x, b) / beta;
    if (x < (a + 1.0) / (a + b + 2.0)) return front * continued_fraction(a, b, x) / a;
    return 1.0 - front * continued_fraction(b, a, 1.0 - x) / b;
}

}  // namespace surfmesh::elementary
