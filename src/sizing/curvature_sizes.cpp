#include "sizing/curvature_sizes.hpp"

#include <cmath>

namespace surfmesh {
namespace {

// Largest ratio of two sizes of which no more than the square is taken.
constexpr double LARGEST_RATIO = 1e100;

constexpr double SADDLE_RESERVE = 0.7;  // where the curvatures are opposite

constexpr double BOWL_RESERVE = 0.74;  // of stretched sizes, where both curvatures are one

// In the worst direction: where the lattice follows the rims and not the principal directions.
constexpr double LATTICE_RESERVE = 0.81;

// Of stretched triangles whose corners move until these lie nearer: curved one way only, a bowl and a
// saddle as much both ways.
constexpr double EVENED_RESERVE = 0.84, EVENED_BOWL_RESERVE = 0.88, EVENED_SADDLE_RESERVE = 0.93;

// In the worst direction of a lattice on saddles whose edges lie 15 degrees from principal ones.
constexpr double SADDLE_LATTICE_RESERVE = 0.87, COSINE_30 = 0.86602540378443865;

constexpr double SQRT3 = 1.7320508075688772;

double sign(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : x; }

/// b: signed ratio of h_i^2 k_i, -1 to 1, where sizes differ by up to ``ratio``.
double balance(PrincipalCurvatures k, double ratio) {
    const double first = std::abs(k.k1), second = std::abs(k.k2);
    const double small = first < second ? k.k1 * sign(k.k2) : k.k2 * sign(k.k1);
    const double bound = least(ratio, LARGEST_RATIO);
    const double found = bound * bound * (small / most(first, second));
    if (std::isnan(found)) return 0.0;
    return least(most(found, -1.0), 1.0);
}

/// Fraction of ``chord`` for two sizes of balance b; more where a bowl bends as much both ways, where
/// triangles are round.
double stretched_reserve(PrincipalCurvatures k, double b) {
    const double reserve = STRAIGHT_RESERVE + (STRETCHED_RESERVE - STRAIGHT_RESERVE) * std::abs(b);
    const double alike = most(balance(k, 1.0), 0.0);
    return reserve + (BOWL_RESERVE - STRETCHED_RESERVE) * (alike * alike);
}

/// The same where corners move: more where both curvatures decide, and most on saddles, where few
/// triangles have an edge along a principal direction.
double evened_reserve(PrincipalCurvatures k, double b) {
    const double most_of_it = k.k1 * k.k2 < 0.0 ? EVENED_SADDLE_RESERVE : EVENED_BOWL_RESERVE;
    const double both = std::sqrt(std::abs(balance(k, 1.0))) * std::abs(b);
    return EVENED_RESERVE + (most_of_it - EVENED_RESERVE) * both;
}

/// Sizes of balance b at which triangles deviate by ``used``; never less than 2 ``chord``.
PrincipalSizes sizes_within(PrincipalCurvatures k, double b, double used, double chord) {
    const double bound = used / most(0.125, (1.0 + b) / 12.0);
    return {most(std::sqrt(bound / std::abs(k.k1)), 2.0 * chord),
            most(std::sqrt(bound / std::abs(k.k2)), 2.0 * chord)};
}

}  // namespace

double deviation_factor(PrincipalCurvatures k) {
    return most(std::abs(k.k1 + k.k2) / 12.0, most(std::abs(k.k1), std::abs(k.k2)) / 8.0);
}

double deviation_reserve(PrincipalCurvatures k) {
    const double first = std::abs(k.k1), second = std::abs(k.k2);
    const double alike = least(first, second) / most(first, second);
    if (!(alike <= 1.0)) return DEVIATION_RESERVE;  // both 0, or infinite
    // on saddles free rims bend more than the surface: with larger sizes inside, fields fall to them
    if (k.k1 * k.k2 < 0.0) return DEVIATION_RESERVE + (SADDLE_RESERVE - DEVIATION_RESERVE) * alike;
    return DEVIATION_RESERVE + (ALIKE_RESERVE - DEVIATION_RESERVE) * alike;
}

double chord_size(PrincipalCurvatures k, double chord) {
    return most(std::sqrt(deviation_reserve(k) * chord / deviation_factor(k)), 2.0 * chord);
}

double lattice_chord_size(PrincipalCurvatures k, double chord) {
    return most(std::sqrt(LATTICE_RESERVE * chord / deviation_factor(k)), 2.0 * chord);
}

PrincipalSizes saddle_lattice_sizes(PrincipalCurvatures k, double chord, double ratio) {
    return sizes_within(k, balance(k, ratio), SADDLE_LATTICE_RESERVE / COSINE_30 * chord, chord);
}

double quartic_factor(PrincipalCurvatures k) {
    return 1.75 * most(0.0020, 0.0003 + 0.0082 * balance(k, 1.0));
}

double quadratic_chord_size(PrincipalCurvatures k, double chord) {
    const double large = most(std::abs(k.k1), std::abs(k.k2));
    const double fourth = chord / (quartic_factor(k) * large * large * large);
    return most(std::sqrt(std::sqrt(fourth)), 2.0 * chord);
}

double share_of_width(PrincipalCurvatures k, double ratio) {
    const double b = balance(k, ratio);
    const double one_sided = most(0.125, (1.0 + b) / 12.0);
    return one_sided / most(one_sided, SQRT3 * (1.0 - b) / 16.0);
}

double angle_size(PrincipalCurvatures k, double angle) {
    // both may be infinite
    const double mean = k.k1 == -k.k2 ? 0.0 : k.k1 + k.k2;
    const double bent = k.k1 == k.k2 ? 0.0 : k.k1 - k.k2;
    const double bend = 0.5 * std::abs(mean) / ROUND_RESERVE + std::abs(bent) / BENT_RESERVE;
    return SQRT3 * radians(angle) / bend;
}

double normal_deviation_size(PrincipalCurvatures k, double angle) {
    return SQRT3 * 0.75 * radians(angle) / most(std::abs(k.k1), std::abs(k.k2));
}

PrincipalSizes principal_chord_sizes(PrincipalCurvatures k, double chord, double ratio) {
    const double b = balance(k, ratio);
    return sizes_within(k, b, stretched_reserve(k, b) * chord, chord);
}

PrincipalSizes evened_chord_sizes(PrincipalCurvatures k, double chord, double ratio) {
    const double b = balance(k, ratio);
    return sizes_within(k, b, evened_reserve(k, b) * chord, chord);
}

PrincipalSizes principal_angle_sizes(PrincipalCurvatures k, double angle, double ratio) {
    const double first = std::abs(k.k1), second = std::abs(k.k2), large = most(first, second);
    const double b = balance(k, ratio);
    // (3 - b) / 2, the parts with a reserve each
    const double bend = 0.5 * (1.0 + b) / ROUND_RESERVE + (1.0 - b) / BENT_RESERVE;
    const double wanted = SQRT3 * radians(angle) / bend;
    return {wanted / std::sqrt(large * first), wanted / std::sqrt(large * second)};
}

}  // namespace surfmesh
