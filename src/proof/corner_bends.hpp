// Second derivatives at points, along a triangle's sides.
#pragma once

#include <cmath>

#include "proof/side_bends.hpp"
#include "surfaces/fourth_derivatives.hpp"

namespace surfmesh {

/// What r_uu, r_uv and r_vv are multiplied by, for r''(e, e) of a side e.
using SideWeights = std::array<std::array<double, 3>, 3>;

inline SideWeights weights_of(const PlaneCorners& uv) {
    SideWeights weight{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Point2 e = uv[(k + 1) % 3] - uv[k];
        weight[k] = {e.x * e.x, 2.0 * e.x * e.y, e.y * e.y};
    }
    return weight;
}

/// r''(e, e), and how far it is off at most.
inline EnclosedPoint bend_of(const SecondJet& jet, const std::array<double, 3>& weight) {
    constexpr double ROUNDING = 0x1p-46;  // relative, more than that of any short sum here
    EnclosedPoint found{{0.0, 0.0, 0.0}, 0.0};
    for (std::size_t n = 0; n < 3; ++n) {
        const auto& [value, error] = jet[n + 1];
        found.value = found.value + weight[n] * value;
        const double size = std::abs(value.x) + std::abs(value.y) + std::abs(value.z);
        found.error += std::abs(weight[n]) * (2.0 * error + ROUNDING * size);
    }
    return found;
}

/// Is all of it finite?
inline bool is_known(const SecondJet& jet) {
    double size = 0.0;
    for (const auto& [value, error] : jet)
        size += std::abs(value.x) + std::abs(value.y) + std::abs(value.z) + error;
    return size < intervals::INFINITE;
}

}  // namespace surfmesh
