// The derivatives of a function of one number over a range of it, up to the fourth, as balls.
//
//     f^(k)(x) / k!   k = 1 ... 4, for every x of the range
//
// In: an instruction and the range of its operand. Out: what chains of Taylor coefficients are made
// with (taylor_coefficients.hpp, whose source and notes on round-off hold here too).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "surfaces/ball.hpp"
#include "surfaces/outward.hpp"
#include "surfaces/taylor_coefficients.hpp"

namespace surfmesh::taylor {

using Slopes = std::array<Ball, ORDER>;

inline constexpr double FUNCTION_OFF = 0x1p-45;  // more than what functions are off, relative
inline constexpr Ball ANY_NUMBER = {0.0, intervals::INFINITE};

/// Around a range whose ends are off by the error of a function, and by so much more.
inline Ball ball_of(Interval a, double off = 0.0) {
    if (!(outward::magnitude(a) < intervals::INFINITE)) return ANY_NUMBER;
    const double mid = 0.5 * a.lo + 0.5 * a.hi;
    const double rad = std::max(a.hi - mid, mid - a.lo);
    return {mid, rad + off + FUNCTION_OFF * outward::magnitude(a)};
}

inline double least_magnitude(Interval a) {
    return intervals::holds_zero(a) ? 0.0 : std::min(std::abs(a.lo), std::abs(a.hi));
}

/// Of x^b, for b whole or x > 0.
Slopes of_power(Interval a, double b);
Slopes of_logarithm(Interval a);
/// At most radius^-k / k: of functions that are as regular as the logarithm.
Slopes like_logarithm(double radius);
/// Of functions of one operand, where they are smooth; elsewhere nothing is known.
Slopes slopes_of(const Instruction& step, Interval a);

}  // namespace surfmesh::taylor
