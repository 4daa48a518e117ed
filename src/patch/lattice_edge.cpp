#include "patch/lattice_edge.hpp"

#include <cmath>

#include "surfaces/fundamental_forms.hpp"
#include "surfaces/surface_reader.hpp"

namespace surfmesh {
namespace {

constexpr double HALF_SQRT_3 = 0.86602540378443865;

/// Cosine and sine of the angle from the direction of the smaller curvature.
///
/// With m = (1 + b) / 2 and d = (1 - b) / 2 the three edges bend by m + d cos(2 phi), which is m - d
/// along that direction. Turned by delta / 2 from it, two of them bend by as much to either side
/// where sin(30 degrees - delta) = 2 m / d.
Point2 turned(double b) {
    const double s = 2.0 * (1.0 + b) / (1.0 - b);
    if (!(s < 0.5)) return {1.0, 0.0};
    const double cosine = HALF_SQRT_3 * std::sqrt(1.0 - s * s) + 0.5 * s;  // of delta
    return {std::sqrt(0.5 * (1.0 + cosine)), std::sqrt(0.5 * (1.0 - cosine))};
}

}  // namespace

std::optional<Point2> lattice_edge(const Surface& surface, const Chart& chart, Point2 place,
                                   bool stretched) {
    const ChartPoint at = chart.at(place);
    SurfaceReader r(surface);
    r.read({&at.uv, 1}, 2);
    if (r.failed()) return std::nullopt;
    const FundamentalForms forms = fundamental_forms(r[1][0], r[2][0], {r[3][0], r[4][0], r[5][0]});
    if (forms.degenerate) return std::nullopt;
    const auto [k, d1, d2] = principal_directions(forms);
    const bool first_larger = std::abs(k.k1) >= std::abs(k.k2);
    const double larger = first_larger ? k.k1 : k.k2, smaller = first_larger ? k.k2 : k.k1;
    if (k.k1 == k.k2 || !std::isfinite(larger)) return std::nullopt;
    const Point2 turn = turned(stretched ? -1.0 : smaller / larger);
    const double longer = stretched ? std::sqrt(std::abs(larger / smaller)) : 1.0;  // along
    const Point2 along = first_larger ? d2 : d1, across = first_larger ? d1 : d2;
    const Point2 uv = turn.x * longer * along + turn.y * across;
    const Point2 direction = at.direction(uv);
    if (!std::isfinite(direction.x) || !std::isfinite(direction.y)) return std::nullopt;
    return direction;
}

}  // namespace surfmesh
