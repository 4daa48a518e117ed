#include "surfaces/box_diagonal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "surfaces/fundamental_forms.hpp"

namespace surfmesh {

double box_diagonal(std::span<const Point3> points) {
    Point3 low = points[0], high = low;
    for (const Point3 p : points) {
        if (std::isnan(norm_1(p))) return std::numeric_limits<double>::quiet_NaN();
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Point3 extent = high - low;
    const double largest = std::max({extent.x, extent.y, extent.z});
    if (!(largest > 0.0 && std::isfinite(largest))) return largest;
    const Point3 scaled{extent.x / largest, extent.y / largest, extent.z / largest};
    return largest * std::sqrt(lane_dot(scaled, scaled));
}

}  // namespace surfmesh
