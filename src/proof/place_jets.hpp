// R = r(psi) and its derivatives at places of a piece, along its sides.
#pragma once

#include <algorithm>
#include <cmath>

#include "proof/fourth_parts.hpp"
#include "proof/side_bends.hpp"
#include "surfaces/fourth_derivatives.hpp"

namespace surfmesh {

/// What r_u, r_v, r_uu, r_uv and r_vv are multiplied by, for R''(e, e) of a side e at a place of the
/// piece, R = r(psi): r'' along psi'(e), and r' along psi''(e, e). And numbers no less than these,
/// of which rounding is a part.
struct SideWeight {
    std::array<double, 5> value, size;
};

inline SideWeight weight_of(const PlanePiece& piece, std::size_t k, const Barycentric& l) {
    const Point2 e = piece.along(k, l), bend = piece.second(k, k);
    Point2 most = {0.0, 0.0};
    for (std::size_t j = 0; j < 3; ++j)
        most = most + Point2{4.0 * std::abs(piece.bend[j].x), 4.0 * std::abs(piece.bend[j].y)};
    most = most + Point2{std::abs(e.x), std::abs(e.y)};
    return {{bend.x, bend.y, e.x * e.x, 2.0 * e.x * e.y, e.y * e.y},
            {std::abs(bend.x), std::abs(bend.y), most.x * most.x, 2.0 * most.x * most.y,
             most.y * most.y}};
}

/// R''(e, e) of three sides e along three axes, with bounds of how far they are off; what suprema
/// over a triangle are made of.
struct PlaceBends {
    std::array<std::array<double, 3>, 3> value;  // [axis][side]
    std::array<double, 3> error;                 // by side
};

inline PlaceBends place_bends(const SecondJet& jet, const PlanePiece& piece, const Barycentric& l,
                              const Directions& axes) {
    constexpr double ROUNDING = 0x1p-46;  // relative, more than that of any short sum here
    std::array<double, 5> off{};
    for (std::size_t n = 0; n < 5; ++n) {
        const auto& [value, error] = jet[n + 1];
        off[n] =
            2.0 * error + ROUNDING * (std::abs(value.x) + std::abs(value.y) + std::abs(value.z));
    }
    PlaceBends found{};
    for (std::size_t k = 0; k < 3; ++k) {
        const SideWeight weight = weight_of(piece, k, l);
        Point3 bend{0.0, 0.0, 0.0};
        double error = 0.0;
        for (std::size_t n = 0; n < 5; ++n) {
            bend = bend + weight.value[n] * jet[n + 1].value;
            error += weight.size[n] * off[n];
        }
        for (std::size_t d = 0; d < 3; ++d) found.value[d][k] = dot(axes[d], bend);
        found.error[k] = error * (1.0 + ROUNDING);
    }
    return found;
}

/// ``all`` joined with what is there; more: what may be added, by axis and side. with_slope: else
/// differences between sides are left out.
void join(SideBends& all, const PlaceBends& there, const FourthParts& more, bool with_slope);

/// Is all of it finite?
inline bool is_known(const SecondJet& jet) {
    double size = 0.0;
    for (const auto& [value, error] : jet)
        size += std::abs(value.x) + std::abs(value.y) + std::abs(value.z) + error;
    return size < intervals::INFINITE;
}

/// R' along the sides at a place of the piece, less that of the triangle through r(u_i); and how far
/// R is from that triangle there. Along the axes: [axis][side], [axis].
struct PlaceJet {
    PlaceBends bends;
    std::array<BySide, 3> slope;
    BySide slope_error;  // by side
    std::array<double, 3> away;
    double away_error;
};

/// corners: r(u_i); curved: how far the middles of the sides of a quadratic triangle are moved, which R is
/// compared with then instead of the straight one. with_slope: else R' is left out.
PlaceJet place_jet(const SecondJet& jet, const PlanePiece& piece, const Barycentric& l,
                   const Directions& axes, const std::array<EnclosedPoint, 3>& corners,
                   const SpaceBends& curved, bool with_slope);

}  // namespace surfmesh
