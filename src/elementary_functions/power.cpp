#include "elementary_functions/power.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "elementary_functions/blocks.hpp"
#include "elementary_functions/double_double.hpp"
#include "elementary_functions/exponential.hpp"
#include "elementary_functions/logarithm.hpp"

namespace surfmesh::elementary {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

bool is_whole(double y) { return std::floor(y) == y; }
bool is_odd(double y) {
    return is_whole(y) && std::abs(y) < 0x1p53 && std::floor(0.5 * y) != 0.5 * y;
}

/// x^y for 0 < x < infinity, x not 1, and a finite y that is not 0.
double power_of_positive(double x, double y) {
    const bool grows = (x > 1.0) == (y > 0.0);
    if (std::abs(y) > 0x1p65) return grows ? INFINITE : 0.0;  // |log x| >= 2^-53
    if (std::abs(y) < 0x1p-65) return 1.0;                    // |log x| < 2^10
    const bool subnormal = x < std::numeric_limits<double>::min();
    RoundedNumber l = log_sum(subnormal ? x * 0x1p54 : x);
    if (subnormal) l = sum(l, {-54.0 * LN2_PARTS[0], -54.0 * LN2_PARTS[1]});
    const RoundedNumber exponent = two_product(y, l.high);
    const double low = exponent.low + y * l.low;
    if (exponent.high > HIGHEST_EXPONENT) return INFINITE;
    if (exponent.high < -HIGHEST_EXPONENT) return 0.0;
    const ScaledSum e = exp_sum(exponent.high, low);
    return scaled(e.high, e.exponent);
}

/// |x|^y where x is 0 or infinite, y neither 0 nor nan.
double power_at_an_end(double x, double y) { return (x == 0.0) == (y > 0.0) ? 0.0 : INFINITE; }

}  // namespace

double pow(double x, double y) {
    if (y == 0.0 || x == 1.0) return 1.0;
    if (std::isnan(x) || std::isnan(y)) return x + y;
    const double size = std::abs(x);
    if (std::isinf(y)) return size == 1.0 ? 1.0 : (size > 1.0) == (y > 0.0) ? INFINITE : 0.0;
    const double sign = std::signbit(x) && is_odd(y) ? -1.0 : 1.0;
    if (size == 0.0 || std::isinf(size)) return sign * power_at_an_end(size, y);
    if (x < 0.0 && !is_whole(y)) return std::numeric_limits<double>::quiet_NaN();
    return size == 1.0 ? sign : sign * power_of_positive(size, y);
}

double cbrt(double x) {
    if (x == 0.0 || !std::isfinite(x)) return x;
    int exponent = 0;
    const double half = std::frexp(std::abs(x), &exponent);
    const int third = (exponent + 2999) / 3 - 1000;           // rounded down, of exponent - 1
    const double m = std::ldexp(half, exponent - 3 * third);  // in [1, 8)
    double t = polynomial(CUBE_ROOT, m);
    const double cube = t * t * t;
    t *= (cube + 2.0 * m) / (2.0 * cube + m);
    const RoundedNumber square = two_product(t, t);
    const RoundedNumber back = product(square, {t, 0.0});
    t -= ((back.high - m) + back.low) / (3.0 * square.high);
    return std::copysign(std::ldexp(t, third), x);
}

double hypot(double x, double y) {
    const double a = std::max(std::abs(x), std::abs(y)), b = std::min(std::abs(x), std::abs(y));
    if (std::isinf(x) || std::isinf(y)) return INFINITE;
    if (std::isnan(x) || std::isnan(y)) return x + y;
    if (b == 0.0) return a;
    // squares and their errors are normal numbers between these; b counts for nothing far below a
    const double scale = a > 0x1p500 ? 0x1p-600 : a < 0x1p-400 ? 0x1p600 : 1.0;
    const double p = a * scale, q = b * scale;
    if (q < 0x1p-60 * p) return a;
    return root(sum(two_product(p, p), two_product(q, q))).high / scale;
}

void pow(std::span<const double> x, std::span<const double> y, std::span<double> out) {
    for (std::size_t k = 0; k < x.size(); ++k) out[k] = pow(x[k], y[k]);
}
void hypot(std::span<const double> x, std::span<const double> y, std::span<double> out) {
    for (std::size_t k = 0; k < x.size(); ++k) out[k] = hypot(x[k], y[k]);
}
void cbrt(std::span<const double> x, std::span<double> out) { map_each(x, out, cbrt); }

}  // namespace surfmesh::elementary
