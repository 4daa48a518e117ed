#include "proof/triangle_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "proof/crease_bends.hpp"
#include "proof/distinct_places.hpp"
#include "proof/grid_bounds.hpp"
#include "proof/plane_groups.hpp"
#include "proof/side_bends.hpp"
#include "proof/smooth_bounds.hpp"
#include "surfaces/outward.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t BLOCK = 1024;         // triangles looked at together
constexpr double BOUND_ROUNDING = 0x1p-47;  // relative, more than that of any short sum here

/// Of uu r_uu + uv r_uv + vv r_vv along a direction: how far up and down it may go.
struct UpAndDown {
    double up, down;

    [[nodiscard]] double most() const { return std::max(up, down); }
};

UpAndDown weighted(const Bends& bends, std::size_t d, double uu, double uv, double vv) {
    const auto term = [](double factor, Interval x) {
        if (factor == 0.0) return Interval{0.0, 0.0};
        return factor > 0.0 ? Interval{factor * x.lo, factor * x.hi}
                            : Interval{factor * x.hi, factor * x.lo};
    };
    const Interval a = term(uu, bends.uu[d]), b = term(uv, bends.uv[d]), c = term(vv, bends.vv[d]);
    const double size = outward::magnitude(a) + outward::magnitude(b) + outward::magnitude(c);
    if (!(size < intervals::INFINITE)) return {intervals::INFINITE, intervals::INFINITE};
    const double off = BOUND_ROUNDING * size;
    return {a.hi + b.hi + c.hi + off, off - (a.lo + b.lo + c.lo)};
}

void join(SideBends& all, const Bends& bends, const PlaneCorners& uv) {
    std::array<std::array<double, 3>, 3> weight{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Point2 e = uv[(k + 1) % 3] - uv[k];
        weight[k] = {e.x * e.x, 2.0 * e.x * e.y, e.y * e.y};
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const auto &own = weight[k], &a = weight[(k + 1) % 3], &b = weight[(k + 2) % 3];
        for (std::size_t d = 0; d < 3; ++d) {
            const UpAndDown found = weighted(bends, d, own[0], own[1], own[2]);
            const double differ = weighted(bends, d, a[0] - b[0], a[1] - b[1], a[2] - b[2]).most();
            all.by_axis[d][k] = std::max(all.by_axis[d][k], found.most());
            all.differ[d][k] = std::max(all.differ[d][k], differ);
            if (d < 2) continue;
            all.up[k] = std::max(all.up[k], found.up);
            all.down[k] = std::max(all.down[k], found.down);
        }
    }
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
    Array<CreaseJumps> jumps;

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
            // over the whole triangle at once: a path may meet creases of several parts
            if (exact) jumps[t] = {found[k].jump_u, found[k].jump_v};
        }
        return status;
    }
};

/// Neighbours add a little to the height.
bool is_within(const TriangleBounds& bounds, RimSides rims, double limit, double slope) {
    if (!(bounds.slope <= slope)) return false;
    constexpr double FOR_NEIGHBOURS = 0.99;
    for (std::size_t k = 0; k < 3; ++k)
        if ((rims >> k & 1) != 0 && !(bounds.rim[k] <= limit)) return false;
    return bounds.height <= FOR_NEIGHBOURS * limit;
}

SurfaceStatus corner_errors(const Surface& surface, std::span<const SpaceCorners> corners,
                            std::span<const PlaneCorners> uv, Array<double>& error) {
    const std::size_t count = corners.size();
    const DistinctPlaces places({uv.empty() ? nullptr : uv[0].data(), 3 * count});
    Array<EnclosedPoint> found(places.all().size());
    const auto status = surface.enclose(places.all(), {found.data(), found.size()});
    if (status != SurfaceStatus::DONE) return status;
    for (std::size_t t = 0; t < count; ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto& [value, off] = found[places.at(3 * t + k)];
            // each coordinate is off: twice that covers their root sum of squares
            const double away = norm(corners[t][k] - value) * (1.0 + BOUND_ROUNDING) + 2.0 * off;
            error[t] = std::max(error[t], away <= intervals::INFINITE ? away : intervals::INFINITE);
        }
    return status;
}

SurfaceStatus bounds_of_block(const Surface& surface, const ProofRequest& asked, int depth,
                              std::span<TriangleBounds> out) {
    const auto& [corners, uv, bends, limits, rims, on_surface, slope, curved] = asked;
    const std::size_t count = corners.size();
    Array<double> off(count, 0.0);
    if (on_surface)
        if (const auto status = corner_errors(surface, corners, uv, off);
            status != SurfaceStatus::DONE)
            return status;
    Block block{surface, uv, Array<TriangleFrame>(count), Array<SideBends>(count),
                Array<CreaseJumps>(count)};
    Array<Part> parts;
    for (std::size_t t = 0; t < count; ++t) {
        block.frames[t] = frame_of(corners[t], off[t], rims[t]);
        parts.push_back({uv[t], static_cast<std::int32_t>(t)});
    }
    for (int level = 0; !parts.empty(); ++level) {
        if (const auto status = block.look_at(parts, level == 0); status != SurfaceStatus::DONE)
            return status;
        Array<std::int32_t> open;
        for (const Part& part : parts) {
            const std::int32_t t = part.triangle;
            if (!open.empty() && open.back() == t) continue;  // its parts come together
            const double height = level == 0 ? intervals::INFINITE : out[t].height;
            out[t] =
                bounds_with_creases(block.bends[t], block.jumps[t], uv[t], block.frames[t], off[t]);
            out[t].height = std::min(out[t].height, height);
            // a kink on a line of the cut would be missed: what has no bound at first has none
            if (level < depth && out[t].whole < intervals::INFINITE &&
                !is_within(out[t], rims[t], limits[t] - off[t], slope))
                open.push_back(t);
        }
        if (level == 0 && on_surface)
            if (const auto status = lower_heights(surface, asked, open, out);
                status != SurfaceStatus::DONE)
                return status;
        Array<Part> finer;
        for (const Part& part : parts) {
            if (!std::binary_search(open.begin(), open.end(), part.triangle)) continue;
            for (const PlaneCorners& quarter : cut(part.uv))
                finer.push_back({quarter, part.triangle});
        }
        parts = std::move(finer);
    }
    return SurfaceStatus::DONE;
}

SurfaceStatus bounds_by_cells(const Surface& surface, const ProofRequest& asked, int depth,
                              std::span<TriangleBounds> out) {
    for (std::size_t start = 0; start < asked.corners.size(); start += BLOCK) {
        const std::size_t count = std::min(BLOCK, asked.corners.size() - start);
        const auto status =
            bounds_of_block(surface, asked.part(start, count), depth, out.subspan(start, count));
        if (status != SurfaceStatus::DONE) return status;
    }
    return SurfaceStatus::DONE;
}

/// Some triangles of those that are asked for.
struct SomeTriangles {
    Array<SpaceCorners> corners;
    Array<PlaneCorners> uv;
    Array<PlaneBends> bends;
    Array<double> limits;
    Array<RimSides> rims;
    Array<SpaceBends> curved;

    void clear() {
        corners.clear();
        uv.clear();
        bends.clear();
        limits.clear();
        rims.clear();
        curved.clear();
    }
    void add(const ProofRequest& asked, std::int32_t number) {
        const auto t = static_cast<std::size_t>(number);
        corners.push_back(asked.corners[t]);
        uv.push_back(asked.uv[t]);
        bends.push_back(asked.bends[t]);
        limits.push_back(asked.limits[t]);
        rims.push_back(asked.rims[t]);
        if (!asked.curved.empty()) curved.push_back(asked.curved[t]);
    }
    [[nodiscard]] ProofRequest request(const ProofRequest& asked) const {
        const auto all = [](const auto& array) { return std::span(array.data(), array.size()); };
        return {all(corners), all(uv),    all(bends),
                all(limits),  all(rims),  asked.corners_are_on_surface,
                asked.slope,  all(curved)};
    }
};

/// Bounds by cells of ``which`` triangles, where they are lower.
SurfaceStatus bounds_of_some(const Surface& surface, const ProofRequest& asked, int depth,
                             const Array<std::int32_t>& which, std::span<TriangleBounds> out) {
    SomeTriangles some;
    for (const std::int32_t t : which) some.add(asked, t);
    Array<TriangleBounds> found(which.size());
    const auto status =
        bounds_by_cells(surface, some.request(asked), depth, {found.data(), found.size()});
    if (status != SurfaceStatus::DONE) return status;
    for (std::size_t k = 0; k < which.size(); ++k) {
        const auto row = static_cast<std::ptrdiff_t>(k);
        TriangleBounds& known = out[static_cast<std::size_t>(which[row])];
        known = lower_of(known, found[row]);
    }
    return status;
}

/// Is rho a large part of what is known, on the finest grid?
bool is_vague(const TriangleBounds& bounds, const FourthParts& parts) {
    constexpr double LARGE = 0.1, FINEST = 1.0 / 64.0;
    double most = 0.0;
    for (const BySide& along : parts.rho) most = std::max({most, along[0], along[1], along[2]});
    return most / 6.0 * FINEST > LARGE * bounds.cell_whole;
}

/// Point by point or by height.
bool is_near(const TriangleBounds& bounds, const ProofRequest& asked, std::size_t t) {
    const double limit = asked.limits[t] - bounds.corner;
    if (bounds.whole <= limit) return bounds.slope <= asked.slope;
    return asked.curved.empty() && is_within(bounds, asked.rims[t], limit, asked.slope);
}

/// By corners and fourth derivatives; by a grid of points where they say too little, and by cells,
/// of straight pieces, where they say nothing.
SurfaceStatus bounds_of_smooth(const Surface& surface, const FourthDerivatives& fourth,
                               const ProofRequest& asked, int depth,
                               std::span<TriangleBounds> out) {
    auto parts = Array<FourthParts>::unfilled(out.size());
    auto status = smooth_bounds(fourth, surface.domain(), asked, out, {parts.data(), parts.size()});
    if (status == SurfaceStatus::UNKNOWN && !asked.curved.empty()) return status;
    if (status == SurfaceStatus::UNKNOWN) return bounds_by_cells(surface, asked, depth, out);
    if (status != SurfaceStatus::DONE) return status;
    Array<std::int32_t> open, unknown;
    for (std::size_t t = 0; t < out.size(); ++t) {
        const auto number = static_cast<std::int32_t>(t);
        if (!(out[t].whole < intervals::INFINITE))
            unknown.push_back(number);
        else if (!is_near(out[t], asked, t))
            open.push_back(number);
    }
    status = lower_by_grid(fourth, asked, {parts.data(), parts.size()}, open, out);
    if (status != SurfaceStatus::DONE) return status;
    for (const std::int32_t t : open)
        if (is_vague(out[static_cast<std::size_t>(t)], parts[t])) unknown.push_back(t);
    if (!asked.curved.empty()) return status;
    Array<std::int32_t> straight;
    for (const std::int32_t t : unknown)
        if (asked.piece(static_cast<std::size_t>(t)).is_straight()) straight.push_back(t);
    return bounds_of_some(surface, asked, depth, straight, out);
}

constexpr std::size_t PROVED_TOGETHER = 1024;  // whose corners and bounds stay in the cache

/// Some triangles after the others: those that lie beside each other share their corners.
class SmoothParts {
  public:
    SmoothParts(const Surface& surface, const FourthDerivatives& fourth, const ProofRequest& asked,
                int depth, std::span<TriangleBounds> out)
        : surface_(surface), fourth_(fourth), asked_(asked), depth_(depth), out_(out) {}

    SurfaceStatus bound(TriangleGroup group) {
        if (group.size() <= PROVED_TOGETHER) return bound_at_once(group);
        for (const TriangleGroup half : halves_of(group, asked_.uv))
            if (const auto status = bound(half); status != SurfaceStatus::DONE) return status;
        return SurfaceStatus::DONE;
    }

  private:
    SurfaceStatus bound_at_once(TriangleGroup group) {
        some_.clear();
        for (const PlacedTriangle& member : group) some_.add(asked_, member.triangle);
        found_.resize(group.size());
        const auto status = bounds_of_smooth(surface_, fourth_, some_.request(asked_), depth_,
                                             {found_.data(), found_.size()});
        for (std::size_t k = 0; k < group.size(); ++k)
            out_[static_cast<std::size_t>(group[k].triangle)] = found_.begin()[k];
        return status;
    }

    const Surface& surface_;
    const FourthDerivatives& fourth_;
    ProofRequest asked_;
    int depth_;
    std::span<TriangleBounds> out_;
    SomeTriangles some_;
    Array<TriangleBounds> found_;
};

}  // namespace

SurfaceStatus triangle_bounds(const Surface& surface, const ProofRequest& asked, int depth,
                              std::span<TriangleBounds> out) {
    const auto* fourth = dynamic_cast<const FourthDerivatives*>(&surface);
    if (fourth == nullptr && !asked.curved.empty()) return SurfaceStatus::UNKNOWN;
    if (fourth == nullptr) return bounds_by_cells(surface, asked, depth, out);
    if (out.empty()) return SurfaceStatus::DONE;
    if (out.size() <= PROVED_TOGETHER) return bounds_of_smooth(surface, *fourth, asked, depth, out);
    const Array<PlacedTriangle> members = placed_triangles(asked.uv);
    SmoothParts parts(surface, *fourth, asked, depth, out);
    return parts.bound({members.data(), members.size()});
}

}  // namespace surfmesh
