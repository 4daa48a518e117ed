#include "proof/triangle_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "surfaces/outward.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t BLOCK = 1024;         // triangles looked at together
constexpr double BOUND_ROUNDING = 0x1p-47;  // relative, more than that of any short sum here
constexpr double TILTED = 0.1;              // a normal known no better says nothing

/// A triangle's own axes: along its first side, across it within its plane, and its normal.
struct TriangleFrame {
    Directions axes;
    std::array<Point2, 3> sides;  // directions of the sides in the first two axes, unit
    std::array<double, 3> heights;
    double tilt;  // by how much the axes may be wrong
};

/// The first axis along the first rim, across which nothing is given away then.
TriangleFrame frame_of(const SpaceCorners& p, double corner, RimSides rims) {
    TriangleFrame frame{};
    const std::size_t first_side = rims & 1 ? 0 : rims & 2 ? 1 : rims & 4 ? 2 : 0;
    const Point3 along_side = p[(first_side + 1) % 3] - p[first_side];
    const Point3 a = p[1] - p[0], b = p[2] - p[0], n = cross(a, b);
    const double area = norm(n), length = norm(along_side);
    const double longest = std::max({norm(a), norm(b), norm(p[2] - p[1])});
    frame.tilt = (32.0 * 0x1p-53 * longest * longest + 8.0 * corner * longest) / area;
    if (!(frame.tilt < TILTED)) {
        frame.tilt = TILTED;
        frame.axes = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
        return frame;
    }
    const Point3 normal = (1.0 / area) * n, first = (1.0 / length) * along_side;
    frame.axes = {first, cross(normal, first), normal};
    for (std::size_t k = 0; k < 3; ++k) {
        const Point3 side = p[(k + 1) % 3] - p[k];
        const double size = norm(side);
        frame.sides[k] = {dot(side, frame.axes[0]) / size, dot(side, frame.axes[1]) / size};
        frame.heights[k] = area / size * (1.0 - 4.0 * frame.tilt);
    }
    return frame;
}

/// Suprema of |d . r''(e, e)| for the three sides e, along the three axes d.
struct SideBends {
    std::array<std::array<double, 3>, 3> by_axis{};  // [axis][side]
};

void join(SideBends& all, const Bends& bends, const PlaneCorners& uv) {
    for (std::size_t k = 0; k < 3; ++k) {
        const Point2 e = uv[(k + 1) % 3] - uv[k];
        const double uu = e.x * e.x, both = 2.0 * e.x * e.y, vv = e.y * e.y;
        for (std::size_t d = 0; d < 3; ++d) {
            const auto term = [](double factor, Interval x) {
                if (factor == 0.0) return Interval{0.0, 0.0};
                return factor > 0.0 ? Interval{factor * x.lo, factor * x.hi}
                                    : Interval{factor * x.hi, factor * x.lo};
            };
            const Interval a = term(uu, bends.uu[d]), b = term(both, bends.uv[d]),
                           c = term(vv, bends.vv[d]);
            const double size =
                outward::magnitude(a) + outward::magnitude(b) + outward::magnitude(c);
            const double most =
                std::max(std::abs(a.lo + b.lo + c.lo), std::abs(a.hi + b.hi + c.hi));
            // nan where infinities meet
            const double found =
                most <= intervals::INFINITE ? most + BOUND_ROUNDING * size : intervals::INFINITE;
            all.by_axis[d][k] = std::max(all.by_axis[d][k], found);
        }
    }
}

/// The largest of l_0 l_1 a + l_1 l_2 b + l_2 l_0 c over the simplex, for numbers >= 0.
///
/// Inside it is a b c / D with D = 2 (ab + bc + ca) - (a^2 + b^2 + c^2) where each number is less
/// than the sum of the others; else on the side of the largest, a quarter of that.
double largest_on_simplex(double a, double b, double c) {
    const double most = std::max({a, b, c});
    if (!(most < intervals::INFINITE)) return intervals::INFINITE;
    if (2.0 * most >= (a + b + c) * (1.0 + 1e-9)) return 0.25 * most;
    const double x = a / most, y = b / most, z = c / most;
    const double D = 2.0 * (x * y + y * z + z * x) - (x * x + y * y + z * z);
    constexpr double ILL_CONDITIONED = 1e-6, SLACK = 1e-9;
    if (!(D > ILL_CONDITIONED)) return most / 3.0 * (1.0 + SLACK);
    const double inside = x * y * z / D * (1.0 + SLACK);
    return most * std::clamp(inside, 0.25, (1.0 / 3.0) * (1.0 + SLACK));
}

TriangleBounds bounds_from(const SideBends& bends, const TriangleFrame& frame, double corner) {
    std::array<double, 3> normal{}, size{};
    std::array<std::array<double, 3>, 3> across{};  // [side left][side]
    for (std::size_t e = 0; e < 3; ++e) {
        const double x = bends.by_axis[0][e], y = bends.by_axis[1][e], z = bends.by_axis[2][e];
        size[e] = std::sqrt(x * x + y * y + z * z) * (1.0 + frame.tilt * 4.0 + BOUND_ROUNDING);
        normal[e] = z + (frame.tilt + BOUND_ROUNDING) * size[e];
        for (std::size_t k = 0; k < 3; ++k) {
            const Point2 side = frame.sides[k];  // across it: (-y, x)
            across[k][e] = std::abs(side.y) * x + std::abs(side.x) * y +
                           (4.0 * frame.tilt + BOUND_ROUNDING) * size[e];
        }
    }
    TriangleBounds found{};
    found.height = 0.5 * largest_on_simplex(normal[0], normal[1], normal[2]);
    found.whole = 0.5 * largest_on_simplex(size[0], size[1], size[2]);
    found.shift = 0.5 * std::max({size[0], size[1], size[2]});
    found.corner = corner;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
        const double out = across[k][k], inner = std::max(across[k][i], across[k][j]);
        const double reserve = frame.heights[k] - 0.5 * std::max(out, inner);
        found.outward[k] = 0.125 * out;
        // beyond the side l_k <= l_i l_j out / (2 reserve), which adds so much to its height
        const double more = reserve > 0.0 ? out * std::max(normal[i], normal[j]) / (2.0 * reserve)
                                          : intervals::INFINITE;
        const double height = 0.125 * (normal[k] + (out > 0.0 ? more : 0.0));
        found.rim[k] = std::sqrt(height * height + found.outward[k] * found.outward[k]) *
                       (1.0 + BOUND_ROUNDING);
    }
    return found;
}

ParameterBox box_of(const PlaneCorners& uv) {
    return {{std::min({uv[0].x, uv[1].x, uv[2].x}), std::min({uv[0].y, uv[1].y, uv[2].y})},
            {std::max({uv[0].x, uv[1].x, uv[2].x}), std::max({uv[0].y, uv[1].y, uv[2].y})}};
}

/// A part of a triangle, of those that it is cut into.
struct Part {
    PlaneCorners uv;
    std::int32_t triangle;
};

/// The box of a part, whose corners are rounded middles of those of ``whole``, and more.
ParameterBox box_around(const PlaneCorners& part, const PlaneCorners& whole) {
    constexpr double SEVERAL_ULPS = 0x1p-48;
    const ParameterBox all = box_of(whole), box = box_of(part);
    const auto size = [](double a, double b) {
        return SEVERAL_ULPS * std::max(std::abs(a), std::abs(b));
    };
    const Point2 margin = {size(all.low.x, all.high.x), size(all.low.y, all.high.y)};
    const Point2 low = box.low - margin, high = box.high + margin;
    return {{std::max(low.x, all.low.x), std::max(low.y, all.low.y)},
            {std::min(high.x, all.high.x), std::min(high.y, all.high.y)}};
}

std::array<PlaneCorners, 4> cut(const PlaneCorners& t) {
    const Point2 a = 0.5 * (t[0] + t[1]), b = 0.5 * (t[1] + t[2]), c = 0.5 * (t[2] + t[0]);
    return {{{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {b, c, a}}};
}

/// A block of triangles on its way.
struct Block {
    const Surface& surface;
    std::span<const PlaneCorners> uv;
    Array<TriangleFrame> frames;
    Array<SideBends> bends;

    SurfaceStatus look_at(const Array<Part>& parts, bool exact) {
        Array<ParameterBox> cells;
        Array<Directions> directions;
        cells.reserve(parts.size());
        directions.reserve(parts.size());
        for (const Part& part : parts) {
            cells.push_back(exact ? box_of(part.uv) : box_around(part.uv, uv[part.triangle]));
            directions.push_back(frames[part.triangle].axes);
        }
        Array<Bends> found(parts.size());
        const auto status = surface.enclose_bends({cells.data(), cells.size()},
                                                  {directions.data(), directions.size()},
                                                  {found.data(), found.size()});
        if (status != SurfaceStatus::DONE) return status;
        for (const Part& part : parts) bends[part.triangle] = SideBends{};
        for (std::size_t k = 0; k < parts.size(); ++k) {
            const std::int32_t t = parts[k].triangle;
            join(bends[t], found[k], uv[t]);
        }
        return status;
    }
};

/// Neighbours add a little to the height.
bool is_within(const TriangleBounds& bounds, RimSides rims, double limit) {
    constexpr double FOR_NEIGHBOURS = 0.99;
    for (std::size_t k = 0; k < 3; ++k)
        if ((rims >> k & 1) != 0 && !(bounds.rim[k] <= limit)) return false;
    return bounds.height <= FOR_NEIGHBOURS * limit;
}

SurfaceStatus corner_errors(const Surface& surface, std::span<const SpaceCorners> corners,
                            std::span<const PlaneCorners> uv, Array<double>& error) {
    const std::size_t count = corners.size();
    Array<EnclosedPoint> found(3 * count);
    const std::span<const Point2> places{uv.empty() ? nullptr : uv[0].data(), 3 * count};
    const auto status = surface.enclose(places, {found.data(), found.size()});
    if (status != SurfaceStatus::DONE) return status;
    for (std::size_t t = 0; t < count; ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto& [value, off] = found[3 * t + k];
            // each coordinate is off: twice that covers their root sum of squares
            const double away = norm(corners[t][k] - value) * (1.0 + BOUND_ROUNDING) + 2.0 * off;
            error[t] = std::max(error[t], away <= intervals::INFINITE ? away : intervals::INFINITE);
        }
    return status;
}

SurfaceStatus bounds_of_block(const Surface& surface, const ProofRequest& asked, int depth,
                              std::span<TriangleBounds> out) {
    const auto& [corners, uv, limits, rims, on_surface] = asked;
    const std::size_t count = corners.size();
    Array<double> off(count, 0.0);
    if (const auto status = corner_errors(surface, corners, uv, off); status != SurfaceStatus::DONE)
        return status;
    Block block{surface, uv, Array<TriangleFrame>(count), Array<SideBends>(count)};
    Array<Part> parts;
    for (std::size_t t = 0; t < count; ++t) {
        block.frames[t] = frame_of(corners[t], off[t], rims[t]);
        parts.push_back({uv[t], static_cast<std::int32_t>(t)});
    }
    for (int level = 0; !parts.empty(); ++level) {
        if (const auto status = block.look_at(parts, level == 0); status != SurfaceStatus::DONE)
            return status;
        Array<Part> finer;
        for (const Part& part : parts) {
            const std::int32_t t = part.triangle;
            out[t] = bounds_from(block.bends[t], block.frames[t], off[t]);
            // a kink on a line of the cut would be missed: what has no bound at first has none
            const bool may_cut = level < depth && out[t].whole < intervals::INFINITE;
            if (!may_cut || is_within(out[t], rims[t], limits[t] - off[t])) continue;
            for (const PlaneCorners& quarter : cut(part.uv)) finer.push_back({quarter, t});
        }
        parts = std::move(finer);
    }
    return SurfaceStatus::DONE;
}

}  // namespace

SurfaceStatus triangle_bounds(const Surface& surface, const ProofRequest& asked, int depth,
                              std::span<TriangleBounds> out) {
    for (std::size_t start = 0; start < asked.corners.size(); start += BLOCK) {
        const std::size_t count = std::min(BLOCK, asked.corners.size() - start);
        const ProofRequest block{
            .corners = asked.corners.subspan(start, count),
            .uv = asked.uv.subspan(start, count),
            .limits = asked.limits.subspan(start, count),
            .rims = asked.rims.subspan(start, count),
            .corners_are_on_surface = asked.corners_are_on_surface,
        };
        const auto status = bounds_of_block(surface, block, depth, out.subspan(start, count));
        if (status != SurfaceStatus::DONE) return status;
    }
    return SurfaceStatus::DONE;
}

}  // namespace surfmesh
