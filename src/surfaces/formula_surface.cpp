#include "surfaces/formula_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "elementary_functions/bits.hpp"
#include "surfaces/tape_balls.hpp"
#include "surfaces/tape_evaluation.hpp"
#include "surfaces/tape_taylor.hpp"

namespace surfmesh {
namespace {

constexpr double NUDGE = 1e-9;     // of the domain: how far inwards derivatives are taken
constexpr std::size_t SECOND = 9;  // the first number of second derivatives, after r, r_u and r_v

std::span<const double> as_numbers(std::span<const Point2> uv) {
    static_assert(sizeof(Point2) == 2 * sizeof(double));
    return {reinterpret_cast<const double*>(uv.data()), 2 * uv.size()};
}

std::span<double> as_numbers(std::span<Point3> values) {
    static_assert(sizeof(Point3) == 3 * sizeof(double));
    return {reinterpret_cast<double*>(values.data()), 3 * values.size()};
}

bool is_finite(Point3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// Some of n points, and where their derivatives are taken instead.
struct Moved {
    Array<std::int64_t> points;
    Array<Point2> uv;
};

/// Derivatives of moved points into those of all n: out[k n + i], k >= 1.
void evaluate_moved(const Tape& tape, const Moved& moved, std::size_t n, std::span<Point3> out) {
    const std::size_t count = moved.points.size(), derivatives = out.size() / n;
    Array<Point3> found(derivatives * count);
    evaluate(tape, as_numbers({moved.uv.data(), count}), found);
    for (std::size_t k = 1; k < derivatives; ++k)
        for (std::size_t i = 0; i < count; ++i)
            out[k * n + static_cast<std::size_t>(moved.points[i])] = found[k * count + i];
}

/// Of three outputs of a tape.
EnclosedPoint enclosed(const Ball* of) {
    return {{of[0].mid, of[1].mid, of[2].mid}, std::max({of[0].rad, of[1].rad, of[2].rad})};
}

/// Are all of these finite? Without a branch.
bool are_finite(std::span<const double> numbers) {
    std::uint64_t beyond = 0;
    for (const double x : numbers)
        beyond |= elementary::is_above(x, std::numeric_limits<double>::max());
    return beyond >> 63 == 0;
}

/// Is a derivative of point i not finite?
bool is_broken(std::span<const Point3> out, std::size_t n, std::size_t i) {
    for (std::size_t k = n + i; k < out.size(); k += n)
        if (!is_finite(out[k])) return true;
    return false;
}

}  // namespace

double SpeedLimits::kept_off(double u) const {
    if (lowest.empty()) return u;
    const auto after = std::upper_bound(places.begin(), places.end(), u) - places.begin();
    const auto last = static_cast<std::ptrdiff_t>(lowest.size()) - 1;
    const std::ptrdiff_t piece = std::clamp<std::ptrdiff_t>(after - 1, 0, last);
    return std::min(std::max(u, lowest[piece]), highest[piece]);
}

FormulaSurface::FormulaSurface(Tapes tapes, ParameterBox domain, std::array<SpeedLimits, 2> limits)
    : tapes_(std::move(tapes)), domain_(domain), limits_(std::move(limits)) {}

Point2 FormulaSurface::kept_off(Point2 uv) const {
    return {limits_[0].kept_off(uv.x), limits_[1].kept_off(uv.y)};
}

/// Towards the middle of the domain; away from it in the middle.
Point2 FormulaSurface::nudged(Point2 uv, double fraction) const {
    const auto moved = [fraction](double x, double first, double last) {
        const double towards = x > 0.5 * (first + last) ? -1.0 : 1.0;
        return x + towards * fraction * (last - first);
    };
    return {moved(uv.x, domain_.low.x, domain_.high.x), moved(uv.y, domain_.low.y, domain_.high.y)};
}

SurfaceStatus FormulaSurface::evaluate(std::span<const Point2> uv, int order,
                                       std::span<Point3> out) const {
    if (order < 0 || order > 2) return SurfaceStatus::UNKNOWN;
    const Tape* tape = tapes_[static_cast<std::size_t>(order)].get();
    if (tape == nullptr) return SurfaceStatus::UNKNOWN;
    const std::size_t n = uv.size();
    surfmesh::evaluate(*tape, as_numbers(uv), out);
    if (order == 0 || n == 0) return SurfaceStatus::DONE;

    const bool bent = !limits_[0].lowest.empty() || !limits_[1].lowest.empty();
    if (bent) {
        Moved near;
        for (std::size_t i = 0; i < n; ++i) {
            const Point2 clear = kept_off(uv[i]);
            if (clear.x == uv[i].x && clear.y == uv[i].y) continue;
            near.points.push_back(static_cast<std::int64_t>(i));
            near.uv.push_back(clear);
        }
        evaluate_moved(*tape, near, n, out);
    }
    mend(*tape, uv, out);
    return SurfaceStatus::DONE;
}

void FormulaSurface::mend(const Tape& tape, std::span<const Point2> uv,
                          std::span<Point3> out) const {
    const std::size_t n = uv.size();
    if (are_finite(as_numbers(out.subspan(n)))) return;
    Array<std::int64_t> broken;
    for (std::size_t i = 0; i < n; ++i)
        if (is_broken(out, n, i)) broken.push_back(static_cast<std::int64_t>(i));
    for (const double fraction : {NUDGE, 1e3 * NUDGE}) {
        Moved inside;
        for (const std::int64_t i : broken) {
            inside.points.push_back(i);
            inside.uv.push_back(nudged(kept_off(uv[static_cast<std::size_t>(i)]), fraction));
        }
        evaluate_moved(tape, inside, n, out);
        broken.clear();
        for (const std::int64_t i : inside.points)
            if (is_broken(out, n, static_cast<std::size_t>(i))) broken.push_back(i);
    }
    for (const std::int64_t i : broken)
        for (std::size_t k = n + static_cast<std::size_t>(i); k < out.size(); k += n)
            out[k] = {0.0, 0.0, 0.0};
}

/// Bounds of r and its derivatives, those of the ``first`` numbers left out.
SurfaceStatus FormulaSurface::bounds_from(std::size_t first, Kinks kinks,
                                          std::span<const ParameterBox> cells,
                                          std::span<Point3> lower, std::span<Point3> upper) const {
    if (tapes_[2] == nullptr) return SurfaceStatus::UNKNOWN;
    Array<Point2> low(cells.size()), high(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        low[i] = cells[i].low;
        high[i] = cells[i].high;
    }
    bounds(*tapes_[2], as_numbers(low), as_numbers(high), kinks, first, as_numbers(lower),
           as_numbers(upper));
    return SurfaceStatus::DONE;
}

SurfaceStatus FormulaSurface::derivative_bounds(std::span<const ParameterBox> cells,
                                                std::span<Point3> lower,
                                                std::span<Point3> upper) const {
    return bounds_from(3, Kinks::LEFT_OUT, cells, lower, upper);
}

SurfaceStatus FormulaSurface::all_bounds(std::span<const ParameterBox> cells,
                                         std::span<Point3> lower, std::span<Point3> upper) const {
    return bounds_from(0, Kinks::UNBOUNDED, cells, lower, upper);
}

SurfaceStatus FormulaSurface::bend_bounds(std::span<const ParameterBox> cells,
                                          std::span<Point3> lower, std::span<Point3> upper) const {
    return bounds_from(SECOND, Kinks::UNBOUNDED, cells, lower, upper);
}

SurfaceStatus FormulaSurface::enclose(std::span<const Point2> uv,
                                      std::span<EnclosedPoint> out) const {
    if (tapes_[0] == nullptr) return SurfaceStatus::UNKNOWN;
    Array<Ball> found(3 * uv.size());
    enclose_outputs(*tapes_[0], as_numbers(uv), found);
    for (std::size_t i = 0; i < uv.size(); ++i) out[i] = enclosed(found.data() + 3 * i);
    return SurfaceStatus::DONE;
}

SurfaceStatus FormulaSurface::enclose_bends(std::span<const ParameterBox> cells,
                                            std::span<const Directions> directions,
                                            std::span<Bends> out) const {
    if (tapes_[2] == nullptr) return SurfaceStatus::UNKNOWN;
    Array<Point2> low(cells.size()), high(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        low[i] = cells[i].low;
        high[i] = cells[i].high;
    }
    Array<Point3> lower(3 * cells.size()), upper(3 * cells.size());
    enclosures(*tapes_[2], as_numbers(low), as_numbers(high), SECOND, as_numbers(lower),
               as_numbers(upper));
    for (std::size_t i = 0; i < cells.size(); ++i) {
        std::array<BoxedVector, 3> second;
        for (std::size_t k = 0; k < 3; ++k) {
            const Point3 a = lower[3 * i + k], b = upper[3 * i + k];
            second[k] = {{a.x, b.x}, {a.y, b.y}, {a.z, b.z}};
        }
        for (std::size_t d = 0; d < 3; ++d) {
            out[i].uu[d] = along(directions[i][d], second[0]);
            out[i].uv[d] = along(directions[i][d], second[1]);
            out[i].vv[d] = along(directions[i][d], second[2]);
        }
    }
    return SurfaceStatus::DONE;
}

SurfaceStatus FormulaSurface::enclose_second(std::span<const Point2> uv,
                                             std::span<SecondJet> out) const {
    constexpr std::size_t AT_ONCE = 4 * TAPE_BLOCK;  // whose bounds stay in the cache
    if (tapes_[2] == nullptr) return SurfaceStatus::UNKNOWN;
    Array<Ball> found;
    for (std::size_t start = 0; start < uv.size(); start += AT_ONCE) {
        const auto some = uv.subspan(start, std::min(AT_ONCE, uv.size() - start));
        found.resize(18 * some.size());
        enclose_outputs(*tapes_[2], as_numbers(some), found);
        for (std::size_t i = 0; i < 6 * some.size(); ++i)
            out[start + i / 6][i % 6] = enclosed(found.data() + 3 * i);
    }
    return SurfaceStatus::DONE;
}

SurfaceStatus FormulaSurface::enclose_high(std::span<const ParameterBox> cells,
                                           std::span<HighDerivatives> out) const {
    if (tapes_[0] == nullptr) return SurfaceStatus::UNKNOWN;
    Array<Point2> low(cells.size()), high(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        low[i] = cells[i].low;
        high[i] = cells[i].high;
    }
    Array<DerivativeBalls> found(3 * cells.size());
    high_derivatives(*tapes_[0], as_numbers(low), as_numbers(high), found);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const DerivativeBalls &x = found[3 * i], &y = found[3 * i + 1], &z = found[3 * i + 2];
        for (std::size_t k = 0; k < HIGH_DERIVATIVES; ++k) {
            out[i].mid[k] = {x.mid[k], y.mid[k], z.mid[k]};
            out[i].rad[k] = {x.rad[k], y.rad[k], z.rad[k]};
        }
    }
    return SurfaceStatus::DONE;
}

}  // namespace surfmesh
