#include "optimisation/dihedral.hpp"

#include <cmath>

#include "elementary_functions/inverse_trigonometric.hpp"
#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t HALF_EDGES_TOGETHER = 3 << 14;  // half-edges looked at together

}  // namespace

double dihedral_angle(Point3 a, Point3 b, Point3 c, Point3 d) {
    const auto [across, along] = dihedral_turn(a, b, c, d);
    return elementary::atan2(across, along);
}

DihedralAngles find_dihedrals_over(const Triangulation& t, const Array<Point3>& point,
                                   double limit) {
    struct Found {
        HalfEdgePair edge;
        double angle;
    };
    const Array<Found> over = collect_by_blocks<Found>(
        t.tri.size(), HALF_EDGES_TOGETHER,
        [&](std::size_t first, std::size_t last, Array<Found>& own) {
            for (auto e = static_cast<HalfEdge>(first); e < static_cast<HalfEdge>(last); ++e) {
                const HalfEdge f = t.adj[e];
                if (f <= e || t.region[e / 3] == DEAD || t.region[f / 3] == DEAD) continue;
                const double angle = dihedral_angle(point[t.tri[e]], point[t.tri[f]],
                                                    point[t.tri[prev_half_edge(e)]],
                                                    point[t.tri[prev_half_edge(f)]]);
                if (angle > limit) own.push_back({{e, f}, angle});
            }
        });
    DihedralAngles found;
    for (const auto& [edge, angle] : over) {
        found.edges.push_back(edge);
        found.angles.push_back(angle);
    }
    return found;
}

Array<double> dihedral_angles(std::span<const Point3> points, std::span<const Vertex> corners,
                              std::span<const HalfEdgePair> edges) {
    Array<double> angles(edges.size(), 0.0);
    for (std::size_t k = 0; k < edges.size(); ++k) {
        const auto [e, f] = edges[k];
        if (f < 0) continue;
        const auto at = [&](HalfEdge h) { return points[corners[h]]; };
        angles[k] = dihedral_angle(at(e), at(next_half_edge(e)), at(prev_half_edge(e)),
                                   at(prev_half_edge(f)));
    }
    return angles;
}

}  // namespace surfmesh
