#include "surfaces/enclosure.hpp"

#include <numbers>

#include "elementary_functions/inverse_trigonometric.hpp"
#include "elementary_functions/sine_cosine.hpp"
#include "surfaces/outward.hpp"

namespace surfmesh {

Interval along(const Point3& direction, const BoxedVector& vector) {
    using namespace outward;
    return add(
        add(multiply(exactly(direction.x), vector.x), multiply(exactly(direction.y), vector.y)),
        multiply(exactly(direction.z), vector.z));
}

Interval wave_range(double a, double b, Interval t) {
    constexpr double TAU = 2.0 * std::numbers::pi;
    // sines, products and the sum: each within an ulp or two of the amplitude. A crest that is
    // missed for a phase off by as little changes the range by the square of that
    constexpr double ROUNDING = 0x1p-49, FARTHEST = 1e6;
    const double most = std::abs(a) + std::abs(b), margin = ROUNDING * most;
    if (!(std::abs(t.lo) < FARTHEST && std::abs(t.hi) < FARTHEST && t.hi - t.lo < TAU))
        return {-most - margin, most + margin};
    const auto [s0, c0] = elementary::sincos(t.lo);
    const auto [s1, c1] = elementary::sincos(t.hi);
    const double first = a * c0 + b * s0, last = a * c1 + b * s1;
    const double slope_first = b * c0 - a * s0, slope_last = b * c1 - a * s1;
    double lo = std::min(first, last), hi = std::max(first, last);
    // within half a turn there is an extreme where the slope changes its sign, and one alone
    const bool short_way = t.hi - t.lo < 0.25 * TAU;
    if (!short_way || slope_first * slope_last <= 0.0 ||
        std::min(std::abs(slope_first), std::abs(slope_last)) <= 1e-9 * most) {
        const double amplitude = std::sqrt(a * a + b * b) * (1.0 + 0x1p-50) + margin;
        if (!short_way || first + last >= 0.0) hi = amplitude;
        if (!short_way || first + last <= 0.0) lo = -amplitude;
    }
    return {lo - margin, hi + margin};
}

}  // namespace surfmesh
