#include "proof/place_jets.hpp"

namespace surfmesh {
namespace {

constexpr double JET_ROUNDING = 0x1p-44;  // relative, more than that of any sum here

/// Less what the quadratic triangle adds to the straight one.
void take_curved(PlaceJet& jet, const SpaceBends& curved, const Barycentric& l,
                 const Directions& axes) {
    Point3 away{0.0, 0.0, 0.0};
    double size = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Point3 bend = curved[k];
        away = away + 4.0 * l[k] * l[(k + 1) % 3] * bend;
        size += 8.0 * (std::abs(bend.x) + std::abs(bend.y) + std::abs(bend.z));
    }
    for (std::size_t d = 0; d < 3; ++d) {
        jet.away[d] -= dot(axes[d], away);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
            const Point3 along =
                4.0 * ((l[k] - l[i]) * curved[k] + l[j] * curved[i] - l[j] * curved[j]);
            jet.bends.value[d][k] += 8.0 * dot(axes[d], curved[k]);
            jet.slope[d][k] -= dot(axes[d], along);
        }
    }
    jet.bends.error += JET_ROUNDING * size;
    jet.slope_error += JET_ROUNDING * size;
    jet.away_error += 0x1p-50 * size;
}

double size_of(Point3 x) { return std::abs(x.x) + std::abs(x.y) + std::abs(x.z); }

/// R'(e_k) less the sides of the triangle through ``corners``.
void take_slopes(PlaceJet& found, const SecondJet& jet, const PlanePiece& piece,
                 const PieceSteps& steps, const Barycentric& l, const Directions& axes,
                 const std::array<EnclosedPoint, 3>& corners) {
    double size = 0.0, error = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const EnclosedPoint &from = corners[k], &to = corners[(k + 1) % 3];
        const Point3 side = to.value - from.value;
        const Point2 p = piece.along(k, l);
        const Point3 slope = p.x * jet[1].value + p.y * jet[2].value;
        for (std::size_t d = 0; d < 3; ++d) found.slope[d][k] = dot(axes[d], slope - side);
        size = std::max(size, size_of(side) + size_of(slope));
        error = std::max(error, 2.0 * (from.error + to.error));
    }
    const std::array<double, 5> off = rounding_of(jet, JET_ROUNDING);
    found.slope_error = error + JET_ROUNDING * size +
                        (steps.most.x * off[0] + steps.most.y * off[1]) * (1.0 + JET_ROUNDING);
}

}  // namespace

void join(SideBends& all, const PlaceBends& there, const std::array<BySide, 3>& more,
          bool with_slope) {
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t d = 0; d < 3; ++d)
            all.by_axis[d][k] = std::max(all.by_axis[d][k],
                                         std::abs(there.value[d][k]) + (more[d][k] + there.error));
        const double value = there.value[2][k], off = more[2][k] + there.error;
        all.up[k] = std::max(all.up[k], value + off);
        all.down[k] = std::max(all.down[k], off - value);
    }
    for (std::size_t d = 0; d < 3 && with_slope; ++d)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
            const double differ = std::abs(there.value[d][i] - there.value[d][j]);
            const double both = more[d][i] + there.error + more[d][j] + there.error;
            all.differ[d][k] = std::max(all.differ[d][k], differ + both);
        }
}

PlaceJet place_jet(const SecondJet& jet, const PlanePiece& piece, const PieceSteps& steps,
                   const Barycentric& l, const Directions& axes,
                   const std::array<EnclosedPoint, 3>& corners, const SpaceBends& curved,
                   bool with_slope) {
    PlaceJet found{};
    found.bends = place_bends(jet, piece, steps, l, axes);
    if (with_slope) take_slopes(found, jet, piece, steps, l, axes, corners);
    Point3 flat{0.0, 0.0, 0.0};
    double error = jet[0].error, size = size_of(jet[0].value);
    for (std::size_t k = 0; k < 3; ++k) {
        const EnclosedPoint& from = corners[k];
        flat = flat + l[k] * from.value;
        error += from.error;
        size += size_of(from.value);
    }
    for (std::size_t d = 0; d < 3; ++d) found.away[d] = dot(axes[d], jet[0].value - flat);
    found.away_error = 2.0 * error + 0x1p-50 * size;
    if (std::any_of(curved.begin(), curved.end(), [](Point3 x) { return size_of(x) != 0.0; }))
        take_curved(found, curved, l, axes);
    return found;
}

}  // namespace surfmesh
