#include "proof/crease_bends.hpp"

#include <cmath>

namespace surfmesh {
namespace {

constexpr double CREASE_ROUNDING = 1.0 + 0x1p-48;

/// ``times`` what creases add.
SideBends with_creases(const SideBends& smooth, const CreaseJumps& jumps, const PlaneCorners& uv,
                       double times) {
    SideBends found = smooth;
    for (std::size_t d = 0; d < 3; ++d) {
        BySide more{};
        for (std::size_t k = 0; k < 3; ++k) {
            const Point2 e = uv[(k + 1) % 3] - uv[k];
            more[k] = 2.0 * times * CREASE_ROUNDING *
                      (std::abs(e.x) * jumps.u[d] + std::abs(e.y) * jumps.v[d]);
            if (!(more[k] <= intervals::INFINITE)) more[k] = intervals::INFINITE;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            found.by_axis[d][k] += more[k];
            found.differ[d][k] += more[(k + 1) % 3] + more[(k + 2) % 3];
            if (d < 2) continue;
            found.up[k] += more[k];
            found.down[k] += more[k];
        }
    }
    return found;
}

}  // namespace

TriangleBounds bounds_with_creases(const SideBends& smooth, const CreaseJumps& jumps,
                                   const PlaneCorners& uv, const TriangleFrame& frame,
                                   double corner) {
    if (!jumps.any()) return bounds_from(smooth, frame, corner, true);
    TriangleBounds found = bounds_from(with_creases(smooth, jumps, uv, 1.0), frame, corner, true);
    const PieceSize cell = size_from(with_creases(smooth, jumps, uv, FINEST_CELLS), frame);
    found.cell_height = cell.height;
    found.cell_whole = cell.whole;
    return found;
}

}  // namespace surfmesh
