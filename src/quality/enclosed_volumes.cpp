#include "quality/enclosed_volumes.hpp"

#include <cmath>

namespace surfmesh {
namespace {

/// A sum with what rounding has lost of it (Neumaier, "Rundungsfehleranalyse einiger Verfahren zur
/// Summation endlicher Summen", ZAMM 54, 1974).
struct Sum {
    double total = 0.0, lost = 0.0;

    void add(double x) {
        const double next = total + x;
        lost += std::abs(total) >= std::abs(x) ? (total - next) + x : (x - next) + total;
        total = next;
    }
};

}  // namespace

Array<double> enclosed_volumes(std::span<const Point3> points,
                               std::span<const TriangleCorners> triangles,
                               std::span<const std::int32_t> solid,
                               std::span<const Point3> apexes) {
    Array<Sum> sums(apexes.size());
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        const TriangleCorners& t = triangles[k];
        const Point3 apex = apexes[solid[k]];
        const Point3 a = points[t.a] - apex, b = points[t.b] - apex, c = points[t.c] - apex;
        sums[solid[k]].add(dot(a, cross(b, c)));
    }
    Array<double> volumes(apexes.size());
    for (std::size_t s = 0; s < sums.size(); ++s) volumes[s] = (sums[s].total + sums[s].lost) / 6.0;
    return volumes;
}

}  // namespace surfmesh
