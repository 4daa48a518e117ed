#include "surfaces/enclosure.hpp"

#include <numbers>

#include "elementary_functions/inverse_trigonometric.hpp"
#include "elementary_functions/sine_cosine.hpp"
#include "surfaces/outward.hpp"

namespace surfmesh {

Interval along(const Point3& d, const BoxedVector& vector) {
    constexpr double ROUNDING =
        0x1p-49;  // of sixteen times half an ulp: there are fewer operations
    const auto& [x, y, z] = vector;
    const Point3 size = {std::abs(d.x), std::abs(d.y), std::abs(d.z)};
    const Point3 twice = {x.lo + x.hi, y.lo + y.hi, z.lo + z.hi};
    const Point3 wide = {x.hi - x.lo, y.hi - y.lo, z.hi - z.lo};
    const double middle = 0.5 * dot(d, twice), reach = 0.5 * dot(size, wide);
    const double most = size.x * outward::magnitude(x) + size.y * outward::magnitude(y) +
                        size.z * outward::magnitude(z);
    const double margin = reach + ROUNDING * most;
    return intervals::known(middle - margin, middle + margin);  // nan: nothing is known
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
