// Arithmetic on sums of two doubles, right to about 2^-100 of the result.
//
// Source: T.J. Dekker, A floating-point technique for extending the available precision,
// Numerische Mathematik 18, 1971.
#pragma once

#include <cmath>

#include "values/rounded_number.hpp"

namespace surfmesh::elementary {

inline RoundedNumber sum(RoundedNumber a, RoundedNumber b) {
    const RoundedNumber s = two_sum(a.high, b.high);
    return fast_two_sum(s.high, s.low + (a.low + b.low));
}

inline RoundedNumber product(RoundedNumber a, RoundedNumber b) {
    const RoundedNumber p = two_product(a.high, b.high);
    return fast_two_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}

inline RoundedNumber quotient(RoundedNumber a, RoundedNumber b) {
    const double q = a.high / b.high;
    const RoundedNumber back = two_product(q, b.high);
    const double rest = ((a.high - back.high) - back.low) + (a.low - q * b.low);
    return fast_two_sum(q, rest / b.high);
}

/// The root of a > 0.
inline RoundedNumber root(RoundedNumber a) {
    const double r = std::sqrt(a.high);
    const RoundedNumber square = two_product(r, r);
    return fast_two_sum(r, (((a.high - square.high) - square.low) + a.low) / (r + r));
}

}  // namespace surfmesh::elementary
