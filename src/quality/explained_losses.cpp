#include "quality/explained_losses.hpp"

#include <limits>

namespace surfmesh {
namespace {

constexpr double TINY = std::numeric_limits<double>::min();  // no division by zero

/// The larger of two, NaN where one of them is.
double larger_of(double a, double b) { return b > a || b != b ? b : a; }

}  // namespace

Array<double> explained_areas(const JoinedTriangles& mesh, const LossFigures& figures,
                              double slant) {
    Array<double> lost(mesh.faces_in_all, 0.0);
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
        const TriangleCorners& t = mesh.triangles[k];
        const Point3 a = mesh.points[t.a], b = mesh.points[t.b], c = mesh.points[t.c];
        const Point3 ab = b - a, bc = c - b, ca = a - c;
        const double area = figures.area[k], distance = figures.distance[k];
        // the height is 2 area / longest
        const double longest = larger_of(larger_of(dot(ab, ab), dot(bc, bc)), dot(ca, ca)),
                     square = slant * (distance * distance) * longest /
                              larger_of(4.0 * area * area, TINY),
                     bent = figures.bend.empty() ? 0.0 : distance * figures.bend[k],
                     fraction = (square > 1.0 ? 1.0 : square) + bent;
        lost[mesh.faces[k]] += area * (fraction > 1.0 ? 1.0 : fraction);
    }
    return lost;
}

}  // namespace surfmesh
