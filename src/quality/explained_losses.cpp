#include "quality/explained_losses.hpp"

#include <cmath>
#include <limits>

namespace surfmesh {
namespace {

constexpr double TINY = std::numeric_limits<double>::min();  // no division by zero

/// The larger of two, NaN where one of them is.
double larger_of(double a, double b) { return b > a || b != b ? b : a; }

}  // namespace

ExplainedLosses explained_losses(std::span<const Point3> points,
                                 std::span<const TriangleCorners> triangles,
                                 std::span<const double> area, std::span<const double> distance,
                                 double slant) {
    ExplainedLosses lost{Array<double>(triangles.size()), Array<double>(triangles.size())};
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        const TriangleCorners& t = triangles[k];
        const Point3 a = points[t.a], b = points[t.b], c = points[t.c];
        const Point3 ab = b - a, bc = c - b, ca = a - c;
        const double longest =
            std::sqrt(larger_of(larger_of(dot(ab, ab), dot(bc, bc)), dot(ca, ca)));
        const double height = 2.0 * area[k] / larger_of(longest, TINY);
        const double ratio = distance[k] / larger_of(height, TINY),
                     square = slant * (ratio * ratio);
        lost.area[k] = area[k] * (square > 1.0 ? 1.0 : square);
        lost.volume[k] = area[k] * distance[k];
    }
    return lost;
}

}  // namespace surfmesh
