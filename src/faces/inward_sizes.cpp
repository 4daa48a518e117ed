#include "faces/inward_sizes.hpp"

#include <algorithm>
#include <cmath>

#include "elementary_functions/power.hpp"
#include "faces/face_boundary.hpp"
#include "sizing/principal_lattice.hpp"

namespace surfmesh {
namespace {

/// What all rules allow on a surface of this diagonal.
double allowed(const EvenSurface& even, const AskedRules& asked, double diagonal, bool on_lattice) {
    const SizeRules rules = rules_on(asked, diagonal, on_lattice);
    if (!even.radius || rules.by_curvature.empty()) return rules.largest;
    const PrincipalCurvatures k{1.0 / *even.radius, 0.0};
    double size = 0.0;
    return rules.from_curvature({&k, 1}, {&size, 1}) ? size : 0.0;
}

/// The same where it does not depend on the diagonal; no size falls as that grows.
std::optional<double> allowed_on_any(const EvenSurface& even, const AskedRules& asked,
                                     bool on_lattice) {
    const Point2 extent = even.extent();
    int exponent = 0;
    std::frexp(elementary::hypot(extent.x, extent.y), &exponent);
    const double reach = std::ldexp(1.0, exponent + 1);  // the diagonal is no longer
    const double least = allowed(even, asked, 0.0, on_lattice);
    if (least > 0.0 && least == allowed(even, asked, reach, on_lattice)) return least;
    return {};
}

/// Where a largest size is stated the finest one alone is left to the diagonal: that of the
/// rectangle will do.
double known_diagonal(const EvenSurface& even, const AskedRules& asked) {
    const Point2 extent = even.extent();
    if (asked.bounds.max_size) return elementary::hypot(extent.x, extent.y);
    return norm(extent_over(even.surface, even.box));
}

bool has_room_for_lattice(const EvenSurface& even, double size) {
    const Point2 extent = even.extent();
    return std::min(extent.x, extent.y) >= LEAST_ROWS * size;
}

}  // namespace

Point2 EvenSurface::extent() const {
    const Point2 speed = speeds();
    return {speed.x * (box.high.x - box.low.x), speed.y * (box.high.y - box.low.y)};
}

InwardSizes inward_sizes(const EvenSurface& even, const AskedRules& asked) {
    const auto largest = allowed_on_any(even, asked, false);
    if (!largest) return {allowed(even, asked, known_diagonal(even, asked), false), false};
    if (even.radius && may_form_lattice(asked) && has_room_for_lattice(even, *largest)) {
        const auto larger = allowed_on_any(even, asked, true);
        if (larger && *larger > *largest) return {*larger, true};
    }
    return {*largest, false};
}

}  // namespace surfmesh
