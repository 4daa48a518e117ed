#include "sizing/least_counts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "elementary_functions/inverse_trigonometric.hpp"
#include "sizing/rim_sizes.hpp"

namespace surfmesh {
namespace {

constexpr double SQRT_3 = std::numbers::sqrt3;

// 1 / (2 sqrt 5)
constexpr double SADDLE_FACTOR = 0.22360679774997896;

// For ratios -1, -0.95, ... 1: the mean over the directions of the lattice of the largest distance
// over a triangle of side h, times 4 / (sqrt 3 h^2 |k1|). Tests compare it with a dense search.
constexpr std::array<double, 41> EQUILATERAL = {
    0.2759, 0.2695, 0.2637, 0.2589, 0.2548, 0.2517, 0.2497, 0.2489, 0.2494, 0.2506, 0.2518,
    0.2530, 0.2543, 0.2555, 0.2567, 0.2580, 0.2592, 0.2604, 0.2616, 0.2629, 0.2641, 0.2654,
    0.2669, 0.2686, 0.2705, 0.2729, 0.2758, 0.2795, 0.2847, 0.2908, 0.2977, 0.3051, 0.3130,
    0.3212, 0.3298, 0.3385, 0.3475, 0.3566, 0.3659, 0.3753, 0.3849};

/// Curvature of the circle through three points; 0 where two of them are one.
double circle_through(Point3 a, Point3 b, Point3 c) {
    const Point3 first = b - a, second = c - b;
    const double sides = norm(first) * norm(second) * norm(c - a);
    return sides > 0.0 ? 2.0 * norm(cross(first, second)) / sides : 0.0;
}

/// Segments on the arc over one of a line, by the curvature there.
double segments_over(double length, double curvature, double chord) {
    const double half = std::min(0.5 * length * curvature, 1.0);
    const double arc = half > 0.0 ? 2.0 * elementary::asin(half) / curvature : length;
    return std::min(arc * std::sqrt(curvature / (8.0 * chord)), arc / (LEAST_RIM * chord));
}

}  // namespace

double equilateral_factor(double ratio) {
    const double at = 20.0 * (std::clamp(ratio, -1.0, 1.0) + 1.0);
    const double below = std::min(std::floor(at), 39.0);
    const auto k = static_cast<std::size_t>(below);
    return EQUILATERAL[k] + (at - below) * (EQUILATERAL[k + 1] - EQUILATERAL[k]);
}

LeastDensity least_density(PrincipalCurvatures k, double chord, bool balanced) {
    const double first = std::abs(k.k1), second = std::abs(k.k2), large = std::max(first, second);
    if (!(large > 0.0) || !std::isfinite(large)) return {0.0, 0.0};
    const bool bowl = k.k1 * k.k2 > 0.0;
    const double on = bowl ? 2.0 / (3.0 * SQRT_3) : SADDLE_FACTOR;
    const double off = bowl ? 1.0 / (3.0 * SQRT_3) : SQRT_3 / 8.0;
    const double smallest = 1.0 / (SQRT_3 * chord * chord);  // equilateral, with sides of 2 chord
    const double ratio = std::min(first, second) / large;
    const double least = (balanced ? off : on) * std::sqrt(first * second) / chord;
    const double equilateral = equilateral_factor(bowl ? ratio : -ratio) * large / chord;
    return {std::min(least, smallest), std::min(equilateral, smallest)};
}

double least_segments(std::span<const Point3> line, bool closed, double chord, bool balanced) {
    const std::size_t nodes = line.size();
    const double fewest = closed ? 3.0 : 1.0;
    if (nodes < 3) return fewest;
    const auto at = [&](std::size_t i) { return line[i % nodes]; };
    const auto curvature = [&](std::size_t i) {
        return circle_through(at(i + nodes - 1), at(i), at(i + 1));
    };
    const double allowed = balanced ? 2.0 * chord : chord;
    const std::size_t segments = closed ? nodes : nodes - 1;
    double total = 0.0, before = closed ? curvature(0) : curvature(1);
    for (std::size_t i = 0; i < segments; ++i) {
        const double after = !closed && i + 2 == nodes ? before : curvature(i + 1);
        total += segments_over(norm(at(i + 1) - at(i)), 0.5 * (before + after), allowed);
        before = after;
    }
    return std::max(total, fewest);
}

}  // namespace surfmesh
