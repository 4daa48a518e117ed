#include "quality/rim_losses.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "elementary_functions/inverse_trigonometric.hpp"
#include "triangulation/triangulation.hpp"

namespace surfmesh {
namespace {

constexpr double NO_SIZE = std::numeric_limits<double>::min();  // no division by zero
constexpr double NO_RIM = -1.0;                                 // instead of a sagitta

/// The larger of two, NaN where one of them is.
double larger_number(double a, double b) { return b > a || b != b ? b : a; }

Point3 normal_of(std::span<const Point3> points, const TriangleCorners& t) {
    return cross(points[t.b] - points[t.a], points[t.c] - points[t.a]);
}

/// Of each edge the sagitta; 0 where it is free and has none, ``NO_RIM`` where it is no rim.
Array<double> sagittas_of_rims(const JoinedTriangles& mesh, const Sagittas& given) {
    Array<double> sagitta(mesh.uses.size());
    for (std::size_t k = 0; k < sagitta.size(); ++k) sagitta[k] = mesh.uses[k] == 1 ? 0.0 : NO_RIM;
    for (std::size_t k = 0; k < given.rows.size(); ++k)
        if (given.rows[k] != NIL) {
            double& own = sagitta[given.rows[k]];
            own = larger_number(larger_number(own, 0.0), given.values[k]);
        }
    return sagitta;
}

}  // namespace

Array<double> edge_sagittas(std::span<const Point3> points,
                            std::span<const std::array<Vertex, 2>> segments,
                            std::span<const std::int32_t> edges) {
    const std::size_t count = segments.size();
    Array<double> length(count), turn(count, 0.0);
    Point3 before{};
    for (std::size_t k = 0; k < count; ++k) {
        const auto [start, end] = segments[k];
        const Point3 way = points[end] - points[start];
        length[k] = norm(way);
        if (k > 0 && edges[k] == edges[k - 1] && start == segments[k - 1][1]) {
            const double cosine = dot(way, before) / std::max(length[k] * length[k - 1], NO_SIZE);
            const double angle = elementary::acos(std::clamp(cosine, -1.0, 1.0));
            turn[k - 1] = larger_number(turn[k - 1], angle);
            turn[k] = angle;
        }
        before = way;
    }
    for (std::size_t k = 0; k < count; ++k) turn[k] = length[k] * turn[k] / 4.0;
    return turn;
}

RimLosses rim_losses(const JoinedTriangles& mesh, const Sagittas& sagittas,
                     std::span<const double> distance, double sharpest) {
    const Array<double> sagitta = sagittas_of_rims(mesh, sagittas);
    RimLosses lost{Array<double>(sagitta.size(), 0.0), Array<double>(mesh.faces_in_all, 0.0)};
    const std::span<const Vertex> corners = corners_in_a_row(mesh.triangles);
    for (std::size_t k = 0; k < sagitta.size(); ++k) {
        if (sagitta[k] == NO_RIM) continue;
        const auto [e, f] = mesh.half_edges[k];
        const Point3 start = mesh.points[corners[e]];
        const double length = norm(mesh.points[corners[next_half_edge(e)]] - start);
        double slanted = larger_number(distance[e / 3], 0.0);
        if (f != NIL) {
            const Point3 m = normal_of(mesh.points, mesh.triangles[e / 3]);
            const Point3 n = normal_of(mesh.points, mesh.triangles[f / 3]);
            const double size = larger_number(norm(m) * norm(n), NO_SIZE);
            const double sine = larger_number(norm(cross(m, n)) / size, sharpest);
            slanted = larger_number(distance[e / 3], distance[f / 3]) / sine;
        }
        const double off = larger_number(sagitta[k], slanted);
        lost.of_edges[k] = length * (off < length || off != off ? off : length);
        if (mesh.uses[k] > 2) continue;
        for (const HalfEdge side : {e, f})
            if (side != NIL) lost.of_faces[mesh.faces[side / 3]] += lost.of_edges[k];
    }
    return lost;
}

}  // namespace surfmesh
