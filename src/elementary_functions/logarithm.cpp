#include "elementary_functions/logarithm.hpp"

#include <cmath>
#include <iterator>
#include <limits>

#include "elementary_functions/blocks.hpp"
#include "elementary_functions/double_double.hpp"

namespace surfmesh::elementary {

RoundedNumber log_sum(double x, double low) {
    const Normalised n = normalised(x);
    const double part = low * (n.mantissa / x);
    const RoundedNumber f = two_sum(n.mantissa - 1.0, part);
    const RoundedNumber s = quotient(f, sum({2.0, 0.0}, f));
    const RoundedNumber z = product(s, s), cube = product(s, z);
    // 2 atanh s = 2 s + 2/3 s^3 + s^5 (2/5 + ...)
    double tail = LOGARITHM[std::size(LOGARITHM) - 1];
    for (std::size_t k = std::size(LOGARITHM) - 1; k-- > 1;) tail = tail * z.high + LOGARITHM[k];
    const RoundedNumber third = product({TWO_THIRDS[0], TWO_THIRDS[1]}, cube);
    RoundedNumber all = sum({2.0 * s.high, 2.0 * s.low}, third);
    all = sum(all, {cube.high * z.high * tail, 0.0});
    const RoundedNumber whole = two_sum(n.exponent * LN2_PARTS[0], n.exponent * LN2_PARTS[1]);
    return sum(whole, all);
}

double log_beyond(double x) {
    if (x == 0.0) return -std::numeric_limits<double>::infinity();
    if (!(x > 0.0)) return std::numeric_limits<double>::quiet_NaN();
    if (std::isinf(x)) return x;
    return sum(log_sum(x * 0x1p54), {-54.0 * LN2_PARTS[0], -54.0 * LN2_PARTS[1]}).high;
}

void log(std::span<const double> x, std::span<double> out) {
    map_blocks(x, out, log_ordinary, is_no_normal_positive, [](double a) { return log(a); });
}

}  // namespace surfmesh::elementary
