#include "proof/side_bends.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh {
namespace {

constexpr double SIDE_ROUNDING = 0x1p-47;  // relative, more than that of any short sum here
constexpr double TILTED = 0.1;             // a normal known no better says nothing
constexpr double ANY_WAY = 1.0;            // along an axis there is no more than in all then

double height_of(const BySide& up, const BySide& down) {
    return 0.5 * std::max(largest_on_simplex(up[0], up[1], up[2]),
                          largest_on_simplex(down[0], down[1], down[2]));
}

/// |r''(e, e)|, on the safe side.
double size_along(const SideBends& bends, std::size_t e, const TriangleFrame& frame) {
    const double x = bends.by_axis[0][e], y = bends.by_axis[1][e], z = bends.by_axis[2][e];
    return std::sqrt(x * x + y * y + z * z) *
           (1.0 + 4.0 * std::min(frame.tilt, TILTED) + SIDE_ROUNDING);
}

/// |r - L| of height and of what lies within the plane, if that is less.
double whole_from(const BySide& size, const BySide& within, double height) {
    const double all = 0.5 * largest_on_simplex(size[0], size[1], size[2]);
    const double flat = 0.5 * largest_on_simplex(within[0], within[1], within[2]);
    return std::min(all, std::sqrt(height * height + flat * flat) * (1.0 + SIDE_ROUNDING));
}

/// Of sizes along the first two axes.
BySide within_plane(const SideBends& bends, const BySide& size, const TriangleFrame& frame) {
    BySide within{};
    for (std::size_t e = 0; e < 3; ++e) {
        const double x = bends.by_axis[0][e], y = bends.by_axis[1][e];
        within[e] = std::sqrt(x * x + y * y) + 4.0 * (frame.tilt + SIDE_ROUNDING) * size[e];
    }
    return within;
}

/// The largest |(r' - L')(w)| for unit w. Along side k, from i to j, with m the third corner,
///
///     (r' - L')(x) e_k = int r''(x + s (u_i + t e_k - x))(x - u_i - t e_k, e_k),
///
/// convex in x, so largest at a corner: r''(e_k, e_k) / 2 at i and j, and at m, where
/// x - u_i - t e_k = (1/2 - t) e_k - (e_im + e_jm) / 2, a quarter of it and half of the difference of
/// those of the other sides.
double slope_from(const SideBends& bends, const BySide& size, const TriangleFrame& frame) {
    BySide part{};
    for (std::size_t k = 0; k < 3; ++k) {
        double squares = 0.0;
        for (std::size_t d = 0; d < 3; ++d) squares += bends.differ[d][k] * bends.differ[d][k];
        const double other = size[(k + 1) % 3] + size[(k + 2) % 3];
        const double differ =
            std::sqrt(squares) * (1.0 + 4.0 * std::min(frame.tilt, TILTED) + SIDE_ROUNDING) +
            SIDE_ROUNDING * other;
        const double most = std::max(0.5 * size[k], 0.25 * size[k] + 0.5 * std::min(differ, other));
        if (!(frame.lengths[k] > 0.0)) return intervals::INFINITE;
        part[k] = most / frame.lengths[k];
    }
    return slope_of(part, frame);
}

}  // namespace

double largest_on_simplex(double a, double b, double c) {
    const double most = std::max({a, b, c, 0.0});
    if (!(most < intervals::INFINITE)) return intervals::INFINITE;
    if (std::min({a, b, c}) <= 0.0) return 0.25 * most;
    if (2.0 * most >= (a + b + c) * (1.0 + 1e-9)) return 0.25 * most;
    const double x = a / most, y = b / most, z = c / most;
    const double D = 2.0 * (x * y + y * z + z * x) - (x * x + y * y + z * z);
    constexpr double ILL_CONDITIONED = 1e-6, SLACK = 1e-9;
    if (!(D > ILL_CONDITIONED)) return most / 3.0 * (1.0 + SLACK);
    const double inside = x * y * z / D * (1.0 + SLACK);
    return most * std::clamp(inside, 0.25, (1.0 / 3.0) * (1.0 + SLACK));
}

double slope_of(const BySide& part, const TriangleFrame& frame) {
    double slope = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {  // at corner k + 1, between sides k and k + 1
        const Point2 a = frame.sides[k], b = frame.sides[(k + 1) % 3];
        const double cosine = std::sqrt(std::max(0.0, 0.5 * (1.0 - dot(a, b)) - 4.0 * frame.tilt));
        const double most = std::max(part[k], part[(k + 1) % 3]);
        slope = std::max(slope, cosine > 0.0 ? most / cosine : intervals::INFINITE);
    }
    slope = slope * (1.0 + 0x1p-20) + frame.turn;  // of lengths and cosines that are less exact
    return slope <= intervals::INFINITE ? slope : intervals::INFINITE;
}

void take_larger(SideBends& all, const SideBends& other) {
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t d = 0; d < 3; ++d) {
            all.by_axis[d][k] = std::max(all.by_axis[d][k], other.by_axis[d][k]);
            all.differ[d][k] = std::max(all.differ[d][k], other.differ[d][k]);
        }
        all.up[k] = std::max(all.up[k], other.up[k]);
        all.down[k] = std::max(all.down[k], other.down[k]);
    }
}

PieceSize size_from(const SideBends& bends, const TriangleFrame& frame) {
    BySide size{}, up{}, down{};
    for (std::size_t e = 0; e < 3; ++e) {
        size[e] = size_along(bends, e, frame);
        const double tilted = (frame.tilt + SIDE_ROUNDING) * size[e];
        up[e] = bends.up[e] + tilted;
        down[e] = bends.down[e] + tilted;
    }
    const double height = height_of(up, down);
    return {height, whole_from(size, within_plane(bends, size, frame), height)};
}

double whole_with(const SideBends& bends, const TriangleFrame& frame, double height) {
    BySide size{};
    for (std::size_t e = 0; e < 3; ++e) size[e] = size_along(bends, e, frame);
    return whole_from(size, within_plane(bends, size, frame), height);
}

TriangleBounds bounds_from(const SideBends& bends, const TriangleFrame& frame, double corner,
                           bool with_slope) {
    BySide normal{}, size{}, up{}, down{};
    std::array<BySide, 3> across{}, along{};  // [side left][side]
    for (std::size_t e = 0; e < 3; ++e) {
        const double x = bends.by_axis[0][e], y = bends.by_axis[1][e], z = bends.by_axis[2][e];
        size[e] = size_along(bends, e, frame);
        const double tilted = (frame.tilt + SIDE_ROUNDING) * size[e];
        normal[e] = z + tilted;
        up[e] = bends.up[e] + tilted;
        down[e] = bends.down[e] + tilted;
        for (std::size_t k = 0; k < 3; ++k) {
            const Point2 side = frame.sides[k];  // across it: (-y, x)
            const double more = (4.0 * frame.tilt + SIDE_ROUNDING) * size[e];
            across[k][e] = std::abs(side.y) * x + std::abs(side.x) * y + more;
            along[k][e] = std::abs(side.x) * x + std::abs(side.y) * y + more;
        }
    }
    TriangleBounds found{};
    found.height = height_of(up, down);
    found.whole = whole_from(size, within_plane(bends, size, frame), found.height);
    found.slope = with_slope ? slope_from(bends, size, frame) : intervals::INFINITE;
    found.shift = 0.5 * std::max({size[0], size[1], size[2]});
    found.bend = 0.5 * std::max({normal[0], normal[1], normal[2]});
    found.corner = corner;
    found.cell_height = found.height;
    found.cell_whole = found.whole;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
        found.along[k] = 0.5 * along[k][k];
        found.others[k] = 0.5 * std::max(along[k][i], along[k][j]);
        const double out = across[k][k], inner = std::max(across[k][i], across[k][j]);
        const double reserve = frame.heights[k] - 0.5 * std::max(out, inner);
        found.outward[k] = 0.125 * out;
        found.inner[k] = 0.5 * inner;
        // beyond the side l_k <= l_i l_j out / (2 reserve), which adds so much to its height
        found.steep[k] =
            reserve > 0.0 ? std::max(normal[i], normal[j]) / (2.0 * reserve) : intervals::INFINITE;
        const double more = out > 0.0 ? out * found.steep[k] : 0.0;
        found.beside[k] = 0.125 * (normal[k] + more);
        found.rim[k] =
            std::sqrt(found.beside[k] * found.beside[k] + found.outward[k] * found.outward[k]) *
            (1.0 + SIDE_ROUNDING);
    }
    return found;
}

/// The first axis along the first rim, across which nothing is given away then.
TriangleFrame frame_of(const SpaceCorners& p, double corner, RimSides rims) {
    TriangleFrame frame{};
    const std::size_t first_side = rims & 1 ? 0 : rims & 2 ? 1 : rims & 4 ? 2 : 0;
    const std::array<Point3, 3> sides = {p[1] - p[0], p[2] - p[1], p[0] - p[2]};
    const BySide lengths = {norm(sides[0]), norm(sides[1]), norm(sides[2])};
    const Point3 n = cross(sides[0], p[2] - p[0]);
    const double area = norm(n);
    const double longest = std::max({lengths[0], lengths[1], lengths[2]});
    frame.tilt = (32.0 * 0x1p-53 * longest * longest + 8.0 * corner * longest) / area;
    frame.turn = 4.0 * corner * longest / area;  // over the least height
    if (!(frame.tilt < TILTED)) {
        frame.tilt = ANY_WAY;
        frame.axes = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
        return frame;
    }
    const Point3 normal = (1.0 / area) * n, first = (1.0 / lengths[first_side]) * sides[first_side];
    frame.axes = {first, cross(normal, first), normal};
    for (std::size_t k = 0; k < 3; ++k) {
        const double part = 1.0 / lengths[k];
        frame.lengths[k] = lengths[k];
        frame.sides[k] = {part * dot(sides[k], frame.axes[0]), part * dot(sides[k], frame.axes[1])};
        frame.heights[k] = part * area * (1.0 - 4.0 * frame.tilt);
    }
    return frame;
}

}  // namespace surfmesh
