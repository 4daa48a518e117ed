#include "proof/side_distances.hpp"

#include <algorithm>
#include <array>

#include "values/segment.hpp"

namespace surfmesh {
namespace {

constexpr double DISTANCE_ROUNDING = 0x1p-45;  // relative, more than that of any sum here
constexpr std::array<std::size_t, 3> CELLS = {4, 16, 64};
constexpr double ENOUGH = 0.1;       // of the distance: what is between points
constexpr double OF_SIDE = 0x1p-10;  // of the side: which is as good, for what is made of it

}  // namespace

SideDistances::SideDistances(const Surface& surface, const ProofMesh& mesh)
    : surface_(surface), mesh_(mesh), known_(mesh.twins.size(), -1.0) {}

double SideDistances::at(std::size_t h) {
    double& known = known_[static_cast<std::ptrdiff_t>(h)];
    if (known < 0.0) known = computed(h);
    return known;
}

double SideDistances::computed(std::size_t h) {
    const std::size_t t = h / 3, k = h % 3, next = (k + 1) % 3;
    const TriangleBounds& bounds = mesh_.bounds[t];
    const PlanePiece piece{mesh_.uv[t], mesh_.bends[t]};
    const Point3 a = mesh_.corners[t][k], b = mesh_.corners[t][next];
    const double size = norm(a) + norm(b);
    const double length = norm(b - a);
    const double rounded = rounded_part(piece) * (length + 4.0 * bounds.shift);
    double found = intervals::INFINITE;
    for (const std::size_t cells : CELLS) {
        const double n = static_cast<double>(cells);
        uv_.clear();
        for (std::size_t i = 0; i <= cells; ++i) {
            Barycentric l{};
            l[next] = static_cast<double>(i) / n;
            l[k] = 1.0 - l[next];
            uv_.push_back(piece.at(l));
        }
        points_.resize(uv_.size());
        if (surface_.enclose({uv_.data(), uv_.size()}, {points_.data(), points_.size()}) !=
            SurfaceStatus::DONE)
            return intervals::INFINITE;
        double most = 0.0;
        for (const auto& [value, error] : points_)
            most = std::max(most, distance_to_segment(value, a, b) + 2.0 * error);
        const double between = bounds.cell_whole / (n * n);
        const double all = most + between + rounded + DISTANCE_ROUNDING * size;
        if (all < found) found = all;
        if (between <= std::max(ENOUGH * most, OF_SIDE * length)) break;
    }
    return found;
}

}  // namespace surfmesh
