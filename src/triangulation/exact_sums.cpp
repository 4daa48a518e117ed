#include "triangulation/exact_sums.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace surfmesh {
namespace {

constexpr int DIGITS = 53;
constexpr double LARGEST = 1.7976931348623157e308, LEAST = 5e-324;
constexpr std::int64_t OUT_OF_REACH = 1 << 20;

/// Exponent of the unit of a term; out of reach for zero.
std::int64_t unit_of(ScaledNumber term) {
    if (term.mantissa == 0.0) return -OUT_OF_REACH;
    int exponent;
    std::frexp(term.mantissa, &exponent);
    return std::int64_t{exponent} - DIGITS + term.exponent;
}

}  // namespace

// Each term is an integer below 2**53 times a unit, a power of two. They are added from the
// largest unit down. What is summed so far is either larger than all that may still come, and has
// the sign of the sum, or less than (count + 1) 2**53 of the next unit: an int64 holds it.
double exact_sum(std::span<const ScaledNumber> terms) {
    std::int64_t total = 0, unit = OUT_OF_REACH;
    std::size_t left = terms.size();
    while (left > 0) {
        std::int64_t below = -OUT_OF_REACH;
        for (const ScaledNumber& term : terms) {
            const std::int64_t here = unit_of(term);
            if (below < here && here < unit) below = here;
        }
        if (below == -OUT_OF_REACH) break;  // what is left are zeros
        const std::int64_t gap = unit - below;
        if (total != 0) {
            const double magnitude = static_cast<double>(std::abs(total));
            const double rest = static_cast<double>(left + 1) * 0x1p53;
            if (gap > 62 || std::ldexp(magnitude, static_cast<int>(gap)) >= rest) break;
            total *= std::int64_t{1} << gap;
        }
        unit = below;
        for (const ScaledNumber& term : terms) {
            if (unit_of(term) != unit) continue;
            int exponent;
            const double digits = std::frexp(term.mantissa, &exponent);
            total += static_cast<std::int64_t>(std::ldexp(digits, DIGITS));
            --left;
        }
    }
    if (total == 0) return 0.0;
    const auto power = static_cast<int>(std::clamp<std::int64_t>(unit, -2000, 2000));
    const double size = std::ldexp(static_cast<double>(std::abs(total)), power);
    return std::copysign(std::min(std::max(size, LEAST), LARGEST), static_cast<double>(total));
}

}  // namespace surfmesh
