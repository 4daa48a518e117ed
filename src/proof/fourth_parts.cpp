#include "proof/fourth_parts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace surfmesh {
namespace {

constexpr double FOURTH_ROUNDING = 0x1p-46;  // relative, more than that of any sum of products here
constexpr double MADE_OF = 0x1p-44;  // relative, of sums of these with weights no larger than 1
constexpr std::size_t FOURTH = 7;    // the first of the fourth derivatives

/// Rows, so that pairs are computed side by side.
using Weights = std::array<ByPair, HIGH_DERIVATIVES>;

/// Of p_a, p_b, q_aa, q_bb and q_ab of each pair of sides a and b: rows of u, rows of v.
enum Step : std::size_t { A, B, AA, BB, AB, STEPS };
struct Steps {
    std::array<ByPair, STEPS> u, v;
};

void set_weights(const Steps& steps, Weights& of) {
    const auto& [u, v] = steps;
    for (std::size_t p = 0; p < SIDE_PAIRS; ++p) {
        const double au = u[A][p], av = v[A][p], bu = u[B][p], bv = v[B][p];
        const double auu = au * au, auv = 2.0 * au * av, avv = av * av;
        const double buu = bu * bu, buv = 2.0 * bu * bv, bvv = bv * bv;
        of[7][p] = auu * buu;
        of[8][p] = auu * buv + auv * buu;
        of[9][p] = auu * bvv + auv * buv + avv * buu;
        of[10][p] = auv * bvv + avv * buv;
        of[11][p] = avv * bvv;
        const double uu = 4.0 * au * bu, uv = 4.0 * (au * bv + av * bu), vv = 4.0 * av * bv;
        const double aau = u[AA][p], aav = v[AA][p], bbu = u[BB][p], bbv = v[BB][p], abu = u[AB][p],
                     abv = v[AB][p];
        of[3][p] = auu * bbu + buu * aau + uu * abu;
        of[4][p] = (auu * bbv + auv * bbu) + (buu * aav + buv * aau) + (uu * abv + uv * abu);
        of[5][p] = (auv * bbv + avv * bbu) + (buv * aav + bvv * aau) + (uv * abv + vv * abu);
        of[6][p] = avv * bbv + bvv * aav + vv * abv;
        of[0][p] = aau * bbu + 2.0 * abu * abu;
        of[1][p] = aau * bbv + aav * bbu + 4.0 * abu * abv;
        of[2][p] = aav * bbv + 2.0 * abv * abv;
    }
}

/// By coordinate.
Point2 sizes_of_vector(Point2 a) { return {std::abs(a.x), std::abs(a.y)}; }

/// psi'(e_k) over the piece, linear, by its values at the corners: e_k, and 4 bend_k at one end, less
/// that at the other, 4 (bend_i - bend_j) opposite.
struct SideStep {
    Point2 mid, rad;
};

std::array<SideStep, 3> steps_along(const PlanePiece& piece, Point2 rounding) {
    const auto by_coordinate = [](double e, double own, double others) {
        const double size = std::abs(own);
        const double low = std::min(-size, others), high = std::max(size, others);
        return std::pair(e + 2.0 * (low + high), 2.0 * (high - low));
    };
    std::array<SideStep, 3> found;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
        const Point2 e = piece.uv[i] - piece.uv[k], own = piece.bend[k],
                     others = piece.bend[i] - piece.bend[j];
        const auto [u, off_u] = by_coordinate(e.x, own.x, others.x);
        const auto [v, off_v] = by_coordinate(e.y, own.y, others.y);
        found[k] = {{u, v}, {off_u + rounding.x, off_v + rounding.y}};
    }
    return found;
}

struct StepBalls {
    Steps mid, rad;
};

StepBalls steps_of(const PlanePiece& piece) {
    Point2 rounding{0.0, 0.0};  // of sums that may cancel
    for (const Point2 bend : piece.bend) rounding = rounding + 0x1p-46 * sizes_of_vector(bend);
    const std::array<SideStep, 3> along = steps_along(piece, rounding);
    std::array<Point2, 3> second;
    for (std::size_t k = 0; k < 3; ++k) second[k] = piece.second(k, k);
    StepBalls found;
    const auto set = [&found](Step step, std::size_t pair, Point2 mid, Point2 rad) {
        found.mid.u[step][pair] = mid.x;
        found.mid.v[step][pair] = mid.y;
        found.rad.u[step][pair] = rad.x;
        found.rad.v[step][pair] = rad.y;
    };
    for (std::size_t p = 0; p < SIDE_PAIRS; ++p) {
        const std::size_t k = PAIR_FIRST[p], l = PAIR_OTHER[p];
        set(A, p, along[k].mid, along[k].rad);
        set(B, p, along[l].mid, along[l].rad);
        set(AA, p, second[k], rounding);
        set(BB, p, second[l], rounding);
        set(AB, p, k == l ? second[k] : piece.second(k, l), rounding);
    }
    return found;
}

/// Each |mid| + factor rad.
Steps sizes_of(const StepBalls& steps, double factor) {
    Steps found;
    for (std::size_t k = 0; k < STEPS; ++k)
        for (std::size_t p = 0; p < SIDE_PAIRS; ++p) {
            found.u[k][p] = std::abs(steps.mid.u[k][p]) + factor * steps.rad.u[k][p];
            found.v[k][p] = std::abs(steps.mid.v[k][p]) + factor * steps.rad.v[k][p];
        }
    return found;
}

double sum_of_sizes(Point3 x) { return std::abs(x.x) + std::abs(x.y) + std::abs(x.z); }

/// Derivatives along one axis: middles, their sizes, and the largest that they may have.
struct AlongAxis {
    DerivativeRows::Row mid, size, most;

    AlongAxis(const DerivativeRows& over, Point3 axis) {
        const double x = std::abs(axis.x), y = std::abs(axis.y), z = std::abs(axis.z);
        for (std::size_t n = 0; n < HIGH_DERIVATIVES; ++n) {
            mid[n] = axis.x * over.mid[0][n] + axis.y * over.mid[1][n] + axis.z * over.mid[2][n];
            size[n] = std::abs(mid[n]);
            most[n] = size[n] + over.rounding[n] + x * over.rad[0][n] + y * over.rad[1][n] +
                      z * over.rad[2][n];
        }
    }
};

/// R'''' of each pair along each axis.
struct FourthBalls {
    std::array<ByPair, 3> mid, rad;
};

/// Of the derivatives from ``first`` on.
FourthBalls along_axes(const DerivativeRows& over, const PlanePiece& piece, std::size_t first,
                       const Directions& axes) {
    const StepBalls steps = steps_of(piece);
    Weights mid, size, most;
    set_weights(steps.mid, mid);
    set_weights(sizes_of(steps, 0.0), size);
    set_weights(sizes_of(steps, 1.0), most);
    FourthBalls found;
    for (std::size_t d = 0; d < 3; ++d) {
        const AlongAxis along(over, axes[d]);
        ByPair middle{}, radius{};  // in registers
        for (std::size_t n = first; n < HIGH_DERIVATIVES; ++n)
            for (std::size_t p = 0; p < SIDE_PAIRS; ++p) {
                middle[p] += mid[n][p] * along.mid[n];
                radius[p] += most[n][p] * along.most[n] - size[n][p] * along.size[n];
            }
        found.mid[d] = middle;
        found.rad[d] = radius;
    }
    return found;
}

}  // namespace

DerivativeRows::DerivativeRows(const HighDerivatives& over) {
    for (std::size_t n = 0; n < HIGH_DERIVATIVES; ++n) {
        const Point3 x = over.mid[n], r = over.rad[n];
        mid[0][n] = x.x, mid[1][n] = x.y, mid[2][n] = x.z;
        rad[0][n] = r.x, rad[1][n] = r.y, rad[2][n] = r.z;
        rounding[n] = FOURTH_ROUNDING * (sum_of_sizes(x) + sum_of_sizes(r));
    }
}

FourthParts fourth_parts(const DerivativeRows& over, const PlanePiece& piece,
                         const Directions& axes) {
    const auto [mid, rad] = along_axes(over, piece, piece.is_straight() ? FOURTH : 0, axes);
    FourthParts found;
    for (std::size_t p = 0; p < SIDE_PAIRS; ++p) {
        found.mid[p] = mid[2][p];
        found.rad[p] = rad[2][p] * (1.0 + MADE_OF) + MADE_OF * std::abs(mid[2][p]);
    }
    double all = 0.0;
    for (std::size_t d = 0; d < 3; ++d) {
        ByPair part;
        for (std::size_t p = 0; p < SIDE_PAIRS; ++p) {
            part[p] = (std::abs(mid[d][p]) + rad[d][p]) * ((1.0 + FOURTH_ROUNDING) / 6.0);
            all += part[p];
        }
        const auto largest = [&part](std::size_t a, std::size_t b, std::size_t c) {
            return std::max(std::max(part[a], part[b]), part[c]);
        };
        found.rho[d] = {largest(0, 1, 2), largest(1, 3, 4), largest(2, 4, 5)};  // with each side
    }
    return all < intervals::INFINITE ? found : UNKNOWN_PARTS;
}

}  // namespace surfmesh
