#include "faces/loop_figures.hpp"

#include <cmath>

namespace surfmesh {

Array<LoopFigures> loop_figures(const FaceBoundary& boundary) {
    Array<LoopFigures> found;
    std::int32_t row = 0, piece = 0;
    for (const std::int32_t piece_end : boundary.loop_end) {
        const std::int32_t begin = row, end = boundary.piece_end[piece_end - 1];
        LoopFigures own{static_cast<double>(end - begin - (piece_end - piece)), 0.0, 0.0, 0.0};
        for (; row < end; ++row) {
            if (row > begin) own.length += norm(boundary.points[row] - boundary.points[row - 1]);
            if (!std::isfinite(boundary.sizes[row])) continue;
            own.sizes += boundary.sizes[row];
            own.sized += 1.0;
        }
        piece = piece_end;
        found.push_back(own);
    }
    return found;
}

}  // namespace surfmesh
