#include "quality/explained_losses.hpp"

#include <algorithm>
#include <limits>

namespace surfmesh {
namespace {

constexpr double TINY = std::numeric_limits<double>::min();  // no division by zero

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
        const double longest = std::max(std::max(dot(ab, ab), dot(bc, bc)), dot(ca, ca)),
                     square = slant * (distance * distance) * longest /
                              std::max(4.0 * area * area, TINY),
                     bent = figures.bend.empty() ? 0.0 : distance * figures.bend[k],
                     fraction = std::min(square, 1.0) + bent;
        lost[mesh.faces[k]] += area * std::min(fraction, 1.0);
    }
    return lost;
}

}  // namespace surfmesh
