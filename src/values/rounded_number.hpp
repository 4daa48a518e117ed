// Sums and products of doubles with their rounding errors: the error-free transformations.
//
// Sources: D.E. Knuth, The Art of Computer Programming 2, 4.2.2; T.J. Dekker, A floating-point
// technique for extending the available precision, Numerische Mathematik 18, 1971.
#pragma once

namespace surfmesh {

/// The unevaluated sum high + low, where low is at most half an ulp of high.
struct RoundedNumber {
    double high, low;
};

/// a b as a sum (high, low) without error, by Dekker's splitting.
inline RoundedNumber two_product(double a, double b) {
    constexpr double SPLITTER = 0x1p27 + 1.0;
    const double high = a * b;
    double t = SPLITTER * a;
    const double a1 = t - (t - a), a0 = a - a1;
    t = SPLITTER * b;
    const double b1 = t - (t - b), b0 = b - b1;
    return {high, a0 * b0 - (((high - a1 * b1) - a0 * b1) - a1 * b0)};
}

/// a + b as (rounded sum, error), without error (Knuth).
inline RoundedNumber two_sum(double a, double b) {
    const double sum = a + b, bb = sum - a;
    return {sum, (a - (sum - bb)) + (b - bb)};
}

/// The same where |a| >= |b| or a is 0 (Dekker).
inline RoundedNumber fast_two_sum(double a, double b) {
    const double sum = a + b;
    return {sum, b - (sum - a)};
}

}  // namespace surfmesh
