#include "optimisation/size_reduction.hpp"

namespace surfmesh {
namespace {

constexpr double SMALLEST_SHRINK = 0.85;  // least factor by which one round lowers a wanted size

}  // namespace

int shrink_far(const Triangulation& t, SurfaceFrames& s, VertexMarks& marks,
               std::span<const Triangle> triangles, std::span<const double> deviation, double limit,
               double smallest) {
    int far = 0;
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        if (deviation[k] <= limit) continue;
        ++far;
        const double factor = std::max(std::sqrt(limit / deviation[k]), SMALLEST_SHRINK);
        for (HalfEdge e = 3 * triangles[k]; e < 3 * triangles[k] + 3; ++e) {
            const Vertex v = t.tri[e];
            if (s.scale[v] * factor >= smallest) shorten(s, v, factor);
            marks.active[v] = 1;
        }
    }
    return far;
}

int lower_sizes(SurfaceFrames& s, VertexMarks& marks, std::span<const Vertex> vertices,
                std::span<const double> factors, double smallest) {
    int count = 0;
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        const Vertex v = vertices[k];
        marks.active[v] = 1;
        const double factor = std::max(factors[k], smallest / std::max(s.scale[v], smallest));
        if (!(factor < 1.0)) continue;
        shorten(s, v, factor);
        ++count;
    }
    return count;
}

}  // namespace surfmesh
