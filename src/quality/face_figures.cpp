#include "quality/face_figures.hpp"

#include <cmath>
#include <limits>

namespace surfmesh {
namespace {

/// Sums that belong together lie together.
struct ShapeSums {
    std::int64_t triangles = 0;
    double area = 0.0, alpha = 0.0, least = std::numeric_limits<double>::infinity();
};

struct DistanceSums {
    double largest = 0.0, square = 0.0;
    std::int64_t marked = 0;
    std::int32_t worst = 0;
    bool is_known = false;  // has the face had a triangle?
};

}  // namespace

FaceShapes face_shapes(const JoinedTriangles& mesh, std::span<const double> area,
                       std::span<const double> alpha) {
    Array<ShapeSums> sums(mesh.faces_in_all);
    for (std::size_t t = 0; t < mesh.faces.size(); ++t) {
        ShapeSums& own = sums[mesh.faces[t]];
        ++own.triangles;
        own.area += area[t];
        own.alpha += alpha[t];
        if (alpha[t] < own.least) own.least = alpha[t];
    }
    FaceShapes found;
    for (const ShapeSums& own : sums) {
        found.triangles.push_back(own.triangles);
        found.area.push_back(own.area);
        found.alpha_sum.push_back(own.alpha);
        found.alpha_min.push_back(own.least);
    }
    return found;
}

FaceDistances face_distances(const JoinedTriangles& mesh, const TriangleDistances& of) {
    Array<DistanceSums> sums(mesh.faces_in_all);
    for (std::size_t t = 0; t < mesh.faces.size(); ++t) {
        DistanceSums& own = sums[mesh.faces[t]];
        const double d = of.distance[t];
        if (std::isnan(d) || d > own.largest || !own.is_known) {
            own.is_known = true;
            own.largest = d;
            own.worst = std::isnan(d) ? 0 : static_cast<std::int32_t>(t);
        }
        own.square += of.area[t] * of.mean_square[t];
        own.marked += of.marked[t] != 0 ? 1 : 0;
    }
    FaceDistances found;
    for (const DistanceSums& own : sums) {
        found.largest.push_back(own.largest);
        found.worst.push_back(own.worst);
        found.square.push_back(own.square);
        found.marked.push_back(own.marked);
    }
    return found;
}

}  // namespace surfmesh
