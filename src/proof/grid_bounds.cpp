#include "proof/grid_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "proof/corner_bends.hpp"

namespace surfmesh {
namespace {

constexpr double ROUNDING = 0x1p-45;     // relative, more than that of any sum here
constexpr double FOR_NEIGHBOURS = 0.99;  // of the limit, as they add a little
constexpr std::size_t BLOCK = 256;       // triangles at a time
constexpr std::array<std::size_t, 2> SIDES = {4, 8};

std::size_t points_of(std::size_t side) { return (side + 1) * (side + 2) / 2; }

/// Rounding of (u, v) moves points by this part of what the triangle moves them by.
double rounded_part(const PlaneCorners& uv) {
    const auto part = [](double x, double y, double z) {
        const double size = std::max({std::abs(x), std::abs(y), std::abs(z)});
        const double range = std::max({x, y, z}) - std::min({x, y, z});
        return range > 0.0 ? 0x1p-49 * size / range : 0.0;
    };
    return part(uv[0].x, uv[1].x, uv[2].x) + part(uv[0].y, uv[1].y, uv[2].y);
}

/// One triangle with the points of its grid.
struct Grid {
    std::span<const SecondJet> points;
    const SpaceCorners& corners;
    const PlaneCorners& uv;
    const TriangleFrame& frame;
    double n;

    /// The largest height of the points over the triangle's plane.
    [[nodiscard]] double highest(const TriangleBounds& bounds) const {
        double most = 0.0;
        const SpaceCorners& p = corners;
        for (const SecondJet& jet : points) {
            const auto& [r, error] = jet[0];
            const Point3 x = r - p[0];
            const double size = std::abs(x.x) + std::abs(x.y) + std::abs(x.z);
            most = std::max(most, std::abs(dot(frame.axes[2], x)) + 2.0 * error +
                                      (frame.tilt + ROUNDING) * size);
        }
        const double longest = std::max({norm(p[1] - p[0]), norm(p[2] - p[1]), norm(p[0] - p[2])});
        const double place = ROUNDING * 0x1p-6 * (norm(p[0]) + longest);
        return most + rounded_part(uv) * (longest + 4.0 * bounds.shift) + place + bounds.corner;
    }

    /// Suprema over the triangle.
    [[nodiscard]] SideBends bends(const FourthParts& rho) const {
        const SideWeights weight = weights_of(uv);
        SideBends found;
        for (const SecondJet& jet : points)
            for (std::size_t k = 0; k < 3; ++k) {
                const auto [bend, error] = bend_of(jet, weight[k]);
                for (std::size_t d = 0; d < 3; ++d) {
                    const double value = dot(frame.axes[d], bend);
                    const double more = rho[d][k] / (n * n) + error * (1.0 + ROUNDING);
                    found.by_axis[d][k] = std::max(found.by_axis[d][k], std::abs(value) + more);
                    if (d < 2) continue;
                    found.up[k] = std::max(found.up[k], value + more);
                    found.down[k] = std::max(found.down[k], more - value);
                }
            }
        return found;
    }
};

Array<Point2> places_of(const ProofRequest& asked, std::span<const std::int32_t> which,
                        std::size_t side) {
    const double n = static_cast<double>(side);
    Array<Point2> uv;
    for (const std::int32_t t : which)
        for (std::size_t i = 0; i <= side; ++i)
            for (std::size_t j = 0; i + j <= side; ++j) {
                const double a = static_cast<double>(i) / n, b = static_cast<double>(j) / n;
                const PlaneCorners& c = asked.uv[static_cast<std::size_t>(t)];
                uv.push_back((1.0 - a - b) * c[0] + a * c[1] + b * c[2]);
            }
    return uv;
}

SurfaceStatus lower_some(const FourthDerivatives& surface, const ProofRequest& asked,
                         std::span<const FourthParts> rho, std::size_t side,
                         std::span<const std::int32_t> which, std::span<TriangleBounds> out,
                         Array<std::int32_t>& left) {
    constexpr double STAYS = 0.25;  // of its heights: a piece does over its triangle then
    const double n = static_cast<double>(side), scale = 1.0 / (n * n);
    const Array<Point2> uv = places_of(asked, which, side);
    Array<SecondJet> jets(uv.size());
    const auto status = surface.enclose_second({uv.data(), uv.size()}, {jets.data(), jets.size()});
    if (status != SurfaceStatus::DONE) return status;
    for (std::size_t k = 0; k < which.size(); ++k) {
        const auto t = static_cast<std::size_t>(which[k]);
        const std::span<const SecondJet> points{jets.data() + k * points_of(side), points_of(side)};
        if (!std::all_of(points.begin(), points.end(), is_known)) continue;
        const TriangleFrame frame = frame_of(asked.corners[t], out[t].corner, asked.rims[t]);
        const Grid grid{points, asked.corners[t], asked.uv[t], frame, n};
        TriangleBounds found = bounds_from(grid.bends(rho[t]), frame, out[t].corner);
        const double cell = std::min(found.cell_height, out[t].cell_height);
        const double most = asked.corners_are_on_surface ? grid.highest(found) : found.height;
        found.height = std::min(found.height, (most + scale * cell) * (1.0 + ROUNDING));
        out[t] = lower_of(out[t], found);
        const double limit = FOR_NEIGHBOURS * asked.limits[t];
        const double least = std::min({frame.heights[0], frame.heights[1], frame.heights[2]});
        if (!(out[t].height <= limit) && (most <= limit || out[t].shift > STAYS * least))
            left.push_back(which[k]);
    }
    return status;
}

}  // namespace

SurfaceStatus lower_by_grid(const FourthDerivatives& surface, const ProofRequest& asked,
                            std::span<const FourthParts> rho, Array<std::int32_t>& which,
                            std::span<TriangleBounds> out) {
    for (const std::size_t side : SIDES) {
        Array<std::int32_t> left;
        for (std::size_t start = 0; start < which.size(); start += BLOCK) {
            const std::size_t count = std::min(BLOCK, which.size() - start);
            const auto status =
                lower_some(surface, asked, rho, side, {which.data() + start, count}, out, left);
            if (status != SurfaceStatus::DONE) return status;
        }
        which = std::move(left);
    }
    return SurfaceStatus::DONE;
}

}  // namespace surfmesh
