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

/// Six times the signed volume between a triangle and a point.
double six_volumes(std::span<const Point3> points, const TriangleCorners& t, Point3 apex) {
    const Point3 a = points[t.a] - apex, b = points[t.b] - apex, c = points[t.c] - apex;
    return dot(a, cross(b, c));
}

/// What is added up of a solid, about one of its vertices: volumes to a point far away cancel in
/// rounding.
struct SolidSums {
    Point3 apex{};
    Sum volume;
    double area = 0.0, bulge = 0.0;
    std::int64_t triangles = 0;
};

}  // namespace

Array<double> enclosed_volumes(std::span<const Point3> points,
                               std::span<const TriangleCorners> triangles,
                               std::span<const std::int32_t> solid,
                               std::span<const Point3> apexes) {
    Array<Sum> sums(apexes.size());
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        sums[solid[k]].add(six_volumes(points, triangles[k], apexes[solid[k]]));
    }
    Array<double> volumes(apexes.size());
    for (std::size_t s = 0; s < sums.size(); ++s) volumes[s] = (sums[s].total + sums[s].lost) / 6.0;
    return volumes;
}

SolidFigures solid_figures(std::span<const Point3> points,
                           std::span<const TriangleCorners> triangles,
                           std::span<const SolidsBeside> beside, const SolidParts& parts,
                           std::size_t solids) {
    SolidFigures found;
    Array<SolidSums> sums(solids);
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        const auto [behind, before] = beside[k];
        found.behind += behind >= 0 ? 1 : 0;
        found.before += before >= 0 ? 1 : 0;
        found.both += behind >= 0 && before >= 0 ? 1 : 0;
        for (const std::size_t side : {0, 1}) {
            const std::int32_t solid = beside[k][side];
            if (solid < 0) continue;
            SolidSums& own = sums[solid];
            if (own.triangles++ == 0) own.apex = points[triangles[k].a];
            const double outwards = side == 0 ? 1.0 : -1.0;
            own.volume.add(outwards * six_volumes(points, triangles[k], own.apex));
            own.area += parts.area[k];
            own.bulge += parts.bulge.empty() ? 0.0 : outwards * parts.bulge[k];
        }
    }
    for (const SolidSums& own : sums) {
        found.triangles.push_back(own.triangles);
        found.area.push_back(own.area);
        found.volume.push_back((own.volume.total + own.volume.lost) / 6.0 + own.bulge);
    }
    return found;
}

}  // namespace surfmesh
