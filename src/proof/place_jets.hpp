// R = r(psi) and its derivatives at places of a piece, along its sides.
#pragma once

#include <algorithm>
#include <cmath>

#include "proof/fourth_parts.hpp"
#include "proof/side_bends.hpp"
#include "surfaces/fourth_derivatives.hpp"

namespace surfmesh {

/// R''(e, e) of three sides e along three axes, with bounds of how far they are off; what suprema
/// over a triangle are made of.
struct PlaceBends {
    std::array<std::array<double, 3>, 3> value;  // [axis][side]
    double error;
};

/// How much of the round-off of derivatives of r there may be in those of R.
struct PieceSteps {
    Point2 most;  // no less than psi' along any side, by coordinate, and what rounding is a part of
    Point2 bend;  // than psi''

    explicit PieceSteps(const PlanePiece& piece) : most{0.0, 0.0}, bend{0.0, 0.0} {
        Point2 side{0.0, 0.0};
        for (std::size_t k = 0; k < 3; ++k) {
            const Point2 e = piece.uv[(k + 1) % 3] - piece.uv[k], b = piece.bend[k];
            bend = bend + Point2{8.0 * std::abs(b.x), 8.0 * std::abs(b.y)};
            side = {std::max(side.x, std::abs(e.x)), std::max(side.y, std::abs(e.y))};
        }
        most = side + bend;
    }
};

/// By how much the derivatives of a jet are off, r_u to r_vv, and ``part`` of themselves for rounding.
inline std::array<double, 5> rounding_of(const SecondJet& jet, double part) {
    std::array<double, 5> off{};
    for (std::size_t n = 0; n < 5; ++n) {
        const auto& [value, error] = jet[n + 1];
        off[n] = 2.0 * error + part * (std::abs(value.x) + std::abs(value.y) + std::abs(value.z));
    }
    return off;
}

/// r'' along psi'(e), and r' along psi''(e, e).
inline PlaceBends place_bends(const SecondJet& jet, const PlanePiece& piece,
                              const PieceSteps& steps, const Barycentric& l,
                              const Directions& axes) {
    constexpr double ROUNDING = 0x1p-46;  // relative, more than that of any short sum here
    const std::array<double, 5> off = rounding_of(jet, ROUNDING);
    PlaceBends found{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Point2 e = piece.along(k, l), q = piece.second(k, k);
        const Point3 bend = q.x * jet[1].value + q.y * jet[2].value + e.x * e.x * jet[3].value +
                            2.0 * e.x * e.y * jet[4].value + e.y * e.y * jet[5].value;
        for (std::size_t d = 0; d < 3; ++d) found.value[d][k] = dot(axes[d], bend);
    }
    const auto& [u, v] = steps.most;
    found.error = (steps.bend.x * off[0] + steps.bend.y * off[1] + u * u * off[2] +
                   2.0 * u * v * off[3] + v * v * off[4]) *
                  (1.0 + ROUNDING);
    return found;
}

/// ``all`` joined with what is there; more: what may be added, by axis and side. with_slope: else
/// differences between sides are left out.
void join(SideBends& all, const PlaceBends& there, const std::array<BySide, 3>& more,
          bool with_slope);

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
    double slope_error;
    std::array<double, 3> away;
    double away_error;
};

/// corners: r(u_i); curved: how far the middles of the sides of a quadratic triangle are moved, which R is
/// compared with then instead of the straight one. with_slope: else R' is left out.
PlaceJet place_jet(const SecondJet& jet, const PlanePiece& piece, const PieceSteps& steps,
                   const Barycentric& l, const Directions& axes,
                   const std::array<EnclosedPoint, 3>& corners, const SpaceBends& curved,
                   bool with_slope);

}  // namespace surfmesh
