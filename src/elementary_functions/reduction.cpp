#include "elementary_functions/reduction.hpp"

#include <array>
#include <bit>

namespace surfmesh::elementary {
namespace {

constexpr int WINDOW = 7;  // words of 2/pi that matter: 224 bits, of which 30 may be whole turns

/// x = mantissa 2^exponent, for a normal x > 0.
struct WholeNumber {
    std::uint64_t mantissa;
    int exponent;
};

WholeNumber whole_number(double x) {
    const auto bits = bits_of(x);
    const std::uint64_t fraction = bits & 0xfffffffffffff;
    return {fraction | 0x10000000000000, static_cast<int>(bits >> 52 & 0x7ff) - 1075};
}

/// A binary fraction of 128 bits.
struct Fraction {
    std::uint64_t high, low;
};

/// mantissa times WINDOW words of 2/pi from `first` on, least significant word first.
std::array<std::uint32_t, WINDOW + 2> product(std::uint64_t mantissa, int first) {
    std::array<std::uint32_t, WINDOW + 2> sum{};
    for (int half = 0; half < 2; ++half) {
        const std::uint64_t factor = mantissa >> (32 * half) & 0xffffffff;
        std::uint64_t carry = 0;
        for (int k = 0; k < WINDOW; ++k) {
            carry += factor * TWO_OVER_PI_WORDS[first + WINDOW - 1 - k] + sum[k + half];
            sum[k + half] = static_cast<std::uint32_t>(carry);
            carry >>= 32;
        }
        sum[WINDOW + half] = static_cast<std::uint32_t>(carry);
    }
    return sum;
}

/// The double whose 53 bits are the leading bits of `bits`, times 2^-64.
double leading(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

/// high + low of a fraction between 0 and 1/2, without its last bits.
RoundedNumber rounded(Fraction f) {
    std::uint64_t zeros = 0;
    if (f.high == 0) {
        f = {f.low, 0};
        zeros = 64;
    }
    const int shift = std::countl_zero(f.high | 1);  // | 1: a fraction is never zero, but be sure
    if (shift > 0) f = {f.high << shift | f.low >> (64 - shift), f.low << shift};
    zeros += static_cast<std::uint64_t>(shift);
    const double scale = number_of((EXPONENT_OF_ONE - zeros) << 52);
    return {leading(f.high) * scale, leading(f.high << 53 | f.low >> 11) * (scale * 0x1p-53)};
}

}  // namespace

ReducedAngle reduce_large(double x) {
    const WholeNumber number = whole_number(x < 0.0 ? -x : x);
    // words before `first` are whole turns: their weight times 2^exponent is a multiple of 4
    const int first = number.exponent < 2 ? 0 : (number.exponent - 2) / 32;
    const auto bits = product(number.mantissa, first);
    // |x| 2/pi = bits 2^-below, modulo 4; 128 of its bits from the place of 2 on
    const int below = 32 * (first + WINDOW) - number.exponent;
    const auto word = [&](int from) {  // 64 bits, the lowest of which is number `from`
        std::uint64_t found = 0;
        for (int k = 0; k < 3; ++k) {
            const int index = from / 32 + k, shift = 32 * k - from % 32;
            const std::uint64_t limb =
                index < static_cast<int>(bits.size()) ? std::uint64_t{bits[index]} : 0;
            if (shift < 64) found |= shift < 0 ? limb >> -shift : limb << shift;
        }
        return found;
    };
    const std::uint64_t high = word(below - 62), low = word(below - 126);
    std::uint64_t quadrant = high >> 62;
    Fraction fraction{high << 2 | low >> 62, low << 2};
    const bool beyond = fraction.high >> 63 != 0;  // nearer to the next multiple of pi/2
    if (beyond) {
        quadrant += 1;
        fraction.low = ~fraction.low + 1;
        fraction.high = ~fraction.high + (fraction.low == 0 ? 1 : 0);
    }
    const RoundedNumber f = rounded(fraction);
    const RoundedNumber angle = two_product(f.high, HALF_PI[0]);
    const RoundedNumber sum =
        fast_two_sum(angle.high, angle.low + (f.high * HALF_PI[1] + f.low * HALF_PI[0]));
    if (beyond != (x < 0.0)) return {-sum.high, -sum.low, x < 0.0 ? 0 - quadrant : quadrant};
    return {sum.high, sum.low, x < 0.0 ? 0 - quadrant : quadrant};
}

}  // namespace surfmesh::elementary
