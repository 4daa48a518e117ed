#include "intersection/common_points.hpp"

#include <algorithm>
#include <cmath>

#include "intersection/linear_systems.hpp"

namespace surfmesh {
namespace {

constexpr double BEYOND = 0.02;         // of the domain: how far steps may leave it
constexpr double SINGULAR = 1e-13;      // |det| of a system with unit columns: no single solution
constexpr double SLIGHTLY = 1e-14;      // added to J J^T, so that it can be solved where they touch
constexpr double LEAST_SPEED = 1e-300;  // no speed is less
constexpr double STILL = 1e-14;         // of the coordinates: steps that are none
constexpr double CURVE_STILL = 1e-15;

double kept_within(double x, double low, double high) { return std::min(std::max(x, low), high); }

Point2 kept_within(Point2 p, const ParameterBox& box) {
    return {kept_within(p.x, box.low.x, box.high.x), kept_within(p.y, box.low.y, box.high.y)};
}

double largest_coordinate(Point3 p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

/// What one point is solved with: the columns of J, divided by their speeds.
struct Linearisation {
    std::array<Point3, 4> column;
    FourNumbers speed;
    Point3 gap;
};

Linearisation linearised(const MeetingSurfaces& surfaces, std::size_t row,
                         const FourNumbers* widths) {
    const auto &a = surfaces.a, &b = surfaces.b;
    Linearisation found{
        {a[1][row], a[2][row], -1.0 * b[1][row], -1.0 * b[2][row]}, {}, a[0][row] - b[0][row]};
    double longest = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        found.speed[k] = std::max(norm(found.column[k]), LEAST_SPEED);
        if (widths != nullptr) longest = std::max(longest, found.speed[k] * (*widths)[k]);
    }
    for (std::size_t k = 0; k < 4; ++k) {
        if (widths != nullptr) found.speed[k] = longest / (*widths)[k];
        found.column[k] = (1.0 / found.speed[k]) * found.column[k];
    }
    return found;
}

/// The shortest solution x of J x = gap, J of rank 3 or nearly less.
FourNumbers least_step(const Linearisation& at) {
    const auto coordinate = [&](std::size_t k, std::size_t i) {
        const Point3& p = at.column[k];
        return i == 0 ? p.x : i == 1 ? p.y : p.z;
    };
    SquareMatrix<3> square{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 4; ++k) square[i][j] += coordinate(k, i) * coordinate(k, j);
        square[i][i] += SLIGHTLY;
    }
    std::array<double, 3> right{at.gap.x, at.gap.y, at.gap.z};
    FourNumbers step{};
    if (!(solve<3>(square, right) > 0.0)) return step;
    for (std::size_t k = 0; k < 4; ++k)
        step[k] = dot(at.column[k], Point3{right[0], right[1], right[2]});
    return step;
}

/// The step to the gap's end in a plane at the signed distance ``left``; none where it is not one.
FourNumbers step_in_plane(const Linearisation& at, Point3 normal, double left) {
    SquareMatrix<4> matrix{};
    for (std::size_t k = 0; k < 4; ++k) {
        matrix[0][k] = at.column[k].x;
        matrix[1][k] = at.column[k].y;
        matrix[2][k] = at.column[k].z;
        matrix[3][k] = k < 2 ? dot(at.column[k], normal) : 0.0;
    }
    FourNumbers step{at.gap.x, at.gap.y, at.gap.z, left};
    return solve<4>(matrix, step) > SINGULAR ? step : FourNumbers{};
}

/// Points that still move, and their places in one row for the surfaces.
struct Moving {
    Array<std::int64_t> points;
    Array<Point2> uv_a, uv_b;

    void gather(const CommonPoints& all) {
        uv_a.clear();
        uv_b.clear();
        for (const std::int64_t i : points) {
            uv_a.push_back(all.uv_a[i]);
            uv_b.push_back(all.uv_b[i]);
        }
    }
};

void read(MeetingSurfaces& surfaces, std::span<const Point2> uv_a, std::span<const Point2> uv_b,
          int order) {
    surfaces.a.read(uv_a, order);
    surfaces.b.read(uv_b, order);
}

}  // namespace

ParameterBox step_limits(const ParameterBox& domain) {
    const Point2 room = BEYOND * (domain.high - domain.low);
    return {domain.low - room, domain.high + room};
}

CommonPoints pull_onto_both(MeetingSurfaces& surfaces, std::span<const Point2> uv_a,
                            std::span<const Point2> uv_b, const PullLimits& limits, int steps) {
    const ParameterBox box_a = step_limits(surfaces.a.domain());
    const ParameterBox box_b = step_limits(surfaces.b.domain());
    CommonPoints found{Array<Point2>(uv_a), Array<Point2>(uv_b), Array<Point3>(uv_a.size()),
                       Array<double>(uv_a.size())};
    Moving moving;
    for (std::size_t i = 0; i < uv_a.size(); ++i) {
        const auto k = static_cast<std::ptrdiff_t>(i);
        found.uv_a[k] = kept_within(uv_a[i], box_a);
        found.uv_b[k] = kept_within(uv_b[i], box_b);
        moving.points.push_back(k);
    }
    for (int round = 0; round < steps && !moving.points.empty(); ++round) {
        moving.gather(found);
        read(surfaces, moving.uv_a, moving.uv_b, 1);
        if (surfaces.failed()) return found;
        std::size_t kept = 0;
        for (std::size_t row = 0; row < moving.points.size(); ++row) {
            const std::int64_t i = moving.points[static_cast<std::ptrdiff_t>(row)];
            const auto point = static_cast<std::size_t>(i);
            const Linearisation at =
                linearised(surfaces, row, limits.widths.empty() ? nullptr : &limits.widths[point]);
            const Point3 on_a = surfaces.a[0][row];
            FourNumbers step =
                limits.normal.empty()
                    ? least_step(at)
                    : step_in_plane(at, limits.normal[point],
                                    dot(limits.normal[point], on_a - limits.through[point]));
            double longest = 0.0;
            for (std::size_t k = 0; k < 4; ++k) {
                if (!std::isfinite(step[k])) step[k] = 0.0;
                longest = std::max(longest, std::abs(step[k]));
                step[k] /= at.speed[k];
            }
            found.uv_a[i] = kept_within(found.uv_a[i] - Point2{step[0], step[1]}, box_a);
            found.uv_b[i] = kept_within(found.uv_b[i] - Point2{step[2], step[3]}, box_b);
            if (!(longest <= STILL * (1.0 + largest_coordinate(on_a))))
                moving.points[static_cast<std::ptrdiff_t>(kept++)] = i;
        }
        moving.points.resize(kept);
    }
    read(surfaces, {found.uv_a.data(), uv_a.size()}, {found.uv_b.data(), uv_a.size()}, 0);
    for (std::size_t i = 0; i < uv_a.size(); ++i) {
        const Point3 a = surfaces.a[0][i], b = surfaces.b[0][i];
        found.point[static_cast<std::ptrdiff_t>(i)] = 0.5 * (a + b);
        found.gap[static_cast<std::ptrdiff_t>(i)] = norm(a - b);
    }
    return found;
}

namespace {

/// The step (fraction, u, v) that brings a curve's point c and a surface's point r together.
std::array<double, 3> piercing_step(Point3 gap, const std::array<Point3, 3>& column) {
    SquareMatrix<3> matrix{};
    std::array<double, 3> speed{}, step{gap.x, gap.y, gap.z};
    for (std::size_t k = 0; k < 3; ++k) {
        speed[k] = std::max(norm(column[k]), LEAST_SPEED);
        matrix[0][k] = column[k].x / speed[k];
        matrix[1][k] = column[k].y / speed[k];
        matrix[2][k] = column[k].z / speed[k];
    }
    if (!(solve<3>(matrix, step) > SINGULAR)) return {0.0, 0.0, 0.0};
    for (std::size_t k = 0; k < 3; ++k) step[k] = std::isfinite(step[k]) ? step[k] / speed[k] : 0.0;
    return step;
}

}  // namespace

Piercings pull_onto_curve(const CurvePiece& piece, SurfaceReader& surface,
                          std::span<const double> fraction, std::span<const Point2> uv) {
    const std::size_t count = fraction.size();
    const ParameterBox box = step_limits(surface.domain());
    const double rate = piece.last - piece.first;
    Piercings found{Array<double>(fraction), Array<Point2>(uv), Array<Point3>(count),
                    Array<double>(count)};
    Array<double> t(count);
    const auto place_on_curve = [&] {
        for (std::size_t i = 0; i < count; ++i) {
            const auto k = static_cast<std::ptrdiff_t>(i);
            t[k] = piece.first + found.fraction[k] * rate;
        }
    };
    for (int round = 0; round < NEWTON_STEPS; ++round) {
        place_on_curve();
        const CurveValues c(piece.curve, {t.data(), count}, 1);
        surface.read({found.uv.data(), count}, 1);
        if (surface.failed()) return found;
        double longest = 0.0, farthest = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            const auto k = static_cast<std::ptrdiff_t>(i);
            const std::array<Point3, 3> column{rate * c[1][i], -1.0 * surface[1][i],
                                               -1.0 * surface[2][i]};
            const auto step = piercing_step(c[0][i] - surface[0][i], column);
            for (std::size_t m = 0; m < 3; ++m)
                longest = std::max(longest, std::abs(step[m]) * norm(column[m]));
            farthest = std::max(farthest, largest_coordinate(c[0][i]));
            found.fraction[k] = kept_within(found.fraction[k] - step[0], 0.0, 1.0);
            found.uv[k] = kept_within(found.uv[k] - Point2{step[1], step[2]}, box);
        }
        if (longest <= CURVE_STILL * (1.0 + farthest)) break;
    }
    place_on_curve();
    const CurveValues c(piece.curve, {t.data(), count}, 0);
    surface.read({found.uv.data(), count}, 0);
    for (std::size_t i = 0; i < count; ++i) {
        found.point[static_cast<std::ptrdiff_t>(i)] = c[0][i];
        found.gap[static_cast<std::ptrdiff_t>(i)] = norm(c[0][i] - surface[0][i]);
    }
    return found;
}

}  // namespace surfmesh
