#include "proof/covering.hpp"

#include <algorithm>

namespace surfmesh {
namespace {

/// Calls f(member, how far its piece is from the triangle along its normal, where it covers it);
/// false where the ring is no more what it was.
template <class Function>
bool for_covering(TriangleRing& ring, const ProofMesh& mesh, std::int32_t t, const LookedAt& looked,
                  Function f) {
    if (!ring.begin(t)) return false;
    for (int layer = 0; layer < looked.layers[static_cast<std::size_t>(t)]; ++layer)
        if (!ring.add_layer()) return false;
    double cosine = 1.0;
    bool has_rim = false;
    for (std::size_t m = 0; m < ring.count(); ++m) {
        cosine = std::min(cosine, ring[m].cosine);
        for (const bool is_rim : ring[m].is_rim) has_rim = has_rim || is_rim;
    }
    for (std::size_t m = 1; m < ring.count(); ++m) {
        const auto other = static_cast<std::size_t>(ring.number(m));
        const double whole = looked.whole[other], corner = mesh.bounds[other].corner;
        if (looked.layers[other] > 0 || ring.apart(m) > whole + corner) continue;
        // near to the triangles across its sides; to itself, if these are not all here
        const double near = ring.is_within(m) ? looked.without[other] : whole;
        const double away = near + corner;
        const bool is_graph = !has_rim && away < ring.free();
        f(other, is_graph ? away / cosine * (1.0 + TriangleRing::ROUNDING) : intervals::INFINITE);
    }
    return true;
}

}  // namespace

Array<std::int32_t> covering_triangles(const ProofMesh& mesh,
                                       const TrianglesAtVertices& at_vertices, SideDistances& sides,
                                       const LookedAt& looked, std::span<const double> limits,
                                       std::span<const double> bound) {
    TriangleRing ring(mesh, at_vertices, sides);
    Array<std::uint8_t> is_wanted(bound.size(), 0);
    for (std::size_t t = 0; t < bound.size(); ++t) {
        if (looked.layers[t] == 0) continue;
        for_covering(ring, mesh, static_cast<std::int32_t>(t), looked,
                     [&](std::size_t other, double away) {
                         if (!(away <= std::max(limits[t], bound[t])))
                             is_wanted[static_cast<std::ptrdiff_t>(other)] = 1;
                     });
    }
    Array<std::int32_t> found;
    for (std::size_t t = 0; t < bound.size(); ++t)
        if (is_wanted[static_cast<std::ptrdiff_t>(t)] != 0)
            found.push_back(static_cast<std::int32_t>(t));
    return found;
}

void count_covering(const ProofMesh& mesh, const TrianglesAtVertices& at_vertices,
                    SideDistances& sides, const LookedAt& looked, std::span<double> bound) {
    TriangleRing ring(mesh, at_vertices, sides);
    Array<double> counted{std::span<const double>(bound)};
    for (std::size_t t = 0; t < bound.size(); ++t) {
        if (looked.layers[t] == 0) continue;
        bool is_known = true;
        const auto count = [&](std::size_t other, double away) {
            const double least = std::min(away, looked.over_ring[other]);
            if (!(least < intervals::INFINITE)) is_known = false;
            if (!is_known || least <= bound[t]) return;
            double& raised = counted[static_cast<std::ptrdiff_t>(other)];
            raised = std::max(raised, least);
        };
        if (!for_covering(ring, mesh, static_cast<std::int32_t>(t), looked, count) || !is_known)
            counted[static_cast<std::ptrdiff_t>(t)] = looked.without[t];
    }
    std::copy(counted.begin(), counted.end(), bound.begin());
}

}  // namespace surfmesh
