#include "proof/grid_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "proof/cell_bounds.hpp"
#include "proof/distinct_places.hpp"
#include "proof/triangle_grid.hpp"

namespace surfmesh {
namespace {

constexpr double GRID_ROUNDING = 0x1p-45;  // relative, more than that of any sum here
constexpr double FOR_NEIGHBOURS = 0.99;    // of the limit, as they add a little
constexpr std::size_t GRID_BLOCK = 1024;   // triangles at a time
constexpr std::array<std::size_t, 2> SIDES = {4, 8}, CUTS = {2, 4};

double longest_side(const SpaceCorners& p) {
    return std::max({norm(p[1] - p[0]), norm(p[2] - p[1]), norm(p[0] - p[2])});
}

/// How far points of the piece may lie from where they should, as their (u, v) are rounded.
double moved_by_rounding(const SpaceCorners& p, const PlanePiece& piece,
                         const TriangleBounds& bounds) {
    return rounded_part(piece) * (longest_side(p) + 4.0 * bounds.shift);
}

/// The largest height of points over a triangle's plane, on the safe side.
class Highest {
  public:
    Highest(const SpaceCorners& p, const TriangleFrame& frame) : p_(p), frame_(frame) {}

    void take(const EnclosedPoint& point) {
        const Point3 x = point.value - p_[0];
        const double size = std::abs(x.x) + std::abs(x.y) + std::abs(x.z);
        most_ = std::max(most_, std::abs(dot(frame_.axes[2], x)) + 2.0 * point.error +
                                    (frame_.tilt + GRID_ROUNDING) * size);
    }
    [[nodiscard]] double height(const PlanePiece& piece, const TriangleBounds& bounds) const {
        const double place = GRID_ROUNDING * 0x1p-6 * (norm(p_[0]) + longest_side(p_));
        return most_ + moved_by_rounding(p_, piece, bounds) + place + bounds.corner;
    }

  private:
    const SpaceCorners& p_;
    const TriangleFrame& frame_;
    double most_ = 0.0;
};

/// One triangle after the other, with the points of its grid.
class Grid {
  public:
    Grid(std::size_t n, bool with_slope) : n_(n), with_slope_(with_slope) {}

    /// The next one; false, where not all is known.
    bool begin(std::span<const SecondJet* const> points, const PlanePiece& piece,
               const TriangleFrame& frame, const SpaceBends& curved) {
        if (!std::all_of(points.begin(), points.end(),
                         [](const SecondJet* jet) { return is_known(*jet); }))
            return false;
        frame_ = &frame;
        const std::size_t last = points.size() - 1;  // corners 0, 2, 1 of the triangle
        const std::array<EnclosedPoint, 3> own = {(*points[0])[0], (*points[last])[0],
                                                  (*points[n_])[0]};
        const PieceSteps steps(piece);
        places_.clear();
        for_grid(n_, [&](const Barycentric& l) {
            places_.push_back(place_jet(*points[places_.size()], piece, steps, l, frame.axes, own,
                                        curved, with_slope_));
        });
        return true;
    }
    /// Of its cells.
    [[nodiscard]] BoundsOfCells cells(const FourthParts& parts) const {
        return bounds_of_cells({places_.data(), places_.size()}, n_, parts, *frame_,
                               CellPlaces::FEW, with_slope_);
    }
    /// Over the triangle's plane, of its points.
    [[nodiscard]] double highest() const {
        double most = 0.0;
        for (const PlaceJet& there : places_) most = std::max(most, std::abs(there.away[2]));
        return most;
    }

  private:
    std::size_t n_;
    bool with_slope_;
    const TriangleFrame* frame_ = nullptr;
    Array<PlaceJet> places_;
};

Array<Point2> places_of(const ProofRequest& asked, std::span<const std::int32_t> which,
                        std::size_t side) {
    Array<Point2> uv;
    for (const std::int32_t t : which)
        append_grid(asked.piece(static_cast<std::size_t>(t)), side, uv);
    return uv;
}

/// Could a lower bound of the cells bring it within its limit?
bool is_open(const TriangleBounds& bounds, double points, const TriangleFrame& frame, double asked,
             double slope) {
    if (!(bounds.slope <= slope)) return true;
    if (bounds.whole + bounds.corner <= asked) return false;
    constexpr double STAYS = 0.25;  // of its heights: a piece does over its triangle then
    const double limit = FOR_NEIGHBOURS * asked;
    const double least = std::min({frame.heights[0], frame.heights[1], frame.heights[2]});
    return !(bounds.height <= limit) && (points <= limit || bounds.shift > STAYS * least);
}

SurfaceStatus lower_some(const FourthDerivatives& surface, const ProofRequest& asked,
                         std::span<const FourthParts> parts, std::size_t side,
                         std::span<const std::int32_t> which, std::span<TriangleBounds> out,
                         Array<std::int32_t>& left) {
    const Array<Point2> uv = places_of(asked, which, side);
    const DistinctPlaces places({uv.data(), uv.size()});
    auto jets = Array<SecondJet>::unfilled(places.all().size());
    const auto status = surface.enclose_second(places.all(), {jets.data(), jets.size()});
    if (status != SurfaceStatus::DONE) return status;
    const bool with_slope = asked.slope < intervals::INFINITE;
    Array<const SecondJet*> points(points_of_grid(side));
    Grid grid(side, with_slope);
    for (std::size_t k = 0; k < which.size(); ++k) {
        const auto t = static_cast<std::size_t>(which[k]);
        for (std::size_t i = 0; i < points.size(); ++i)
            points.begin()[i] = &jets[places.at(k * points.size() + i)];
        const TriangleFrame frame = frame_of(asked.corners[t], out[t].corner, asked.rims[t]);
        const PlanePiece piece = asked.piece(t);
        if (!grid.begin({points.data(), points.size()}, piece, frame, asked.curve(t))) continue;
        const BoundsOfCells cells = grid.cells(parts[t]);
        TriangleBounds found = bounds_from(cells.bends, frame, out[t].corner, with_slope);
        const double moved = moved_by_rounding(asked.corners[t], piece, found);
        found.height = std::min(found.height, cells.away.height + moved);
        found.whole = std::min(found.whole, cells.away.whole + moved);
        found.slope = std::min(found.slope, cells.slope);
        out[t] = lower_of(out[t], found);
        const bool is_far = !(out[t].whole + out[t].corner <= asked.limits[t]);
        if (asked.curved.empty()
                ? is_open(out[t], grid.highest(), frame, asked.limits[t], asked.slope)
                : is_far)
            left.push_back(which[k]);
    }
    return status;
}

SurfaceStatus lower_some_heights(const Surface& surface, const ProofRequest& asked,
                                 std::size_t side, std::span<const std::int32_t> which,
                                 std::span<TriangleBounds> out, Array<std::int32_t>& left) {
    const double scale = 1.0 / static_cast<double>(side * side);
    const Array<Point2> uv = places_of(asked, which, side);
    Array<EnclosedPoint> points(uv.size());
    const auto status = surface.enclose({uv.data(), uv.size()}, {points.data(), points.size()});
    if (status != SurfaceStatus::DONE) return status;
    for (std::size_t k = 0; k < which.size(); ++k) {
        const auto t = static_cast<std::size_t>(which[k]);
        const TriangleFrame frame = frame_of(asked.corners[t], out[t].corner, asked.rims[t]);
        Highest highest(asked.corners[t], frame);
        const std::size_t count = points_of_grid(side);
        for (const EnclosedPoint& point : std::span(points.data() + k * count, count))
            highest.take(point);
        const double most = highest.height(asked.piece(t), out[t]);
        const double found = (most + scale * out[t].cell_height) * (1.0 + GRID_ROUNDING);
        if (found < out[t].height) out[t].height = found;
        if (is_open(out[t], most, frame, asked.limits[t], asked.slope)) left.push_back(which[k]);
    }
    return status;
}

/// With the grids of one size after the other, some triangles at a time.
template <class LowerSome>
SurfaceStatus with_grids(Array<std::int32_t>& which, std::span<const std::size_t> sides,
                         LowerSome lower) {
    for (const std::size_t side : sides) {
        Array<std::int32_t> left;
        for (std::size_t start = 0; start < which.size(); start += GRID_BLOCK) {
            const std::size_t count = std::min(GRID_BLOCK, which.size() - start);
            const auto status =
                lower(side, std::span<const std::int32_t>(which.data() + start, count), left);
            if (status != SurfaceStatus::DONE) return status;
        }
        which = std::move(left);
    }
    return SurfaceStatus::DONE;
}

}  // namespace

SurfaceStatus lower_by_grid(const FourthDerivatives& surface, const ProofRequest& asked,
                            std::span<const FourthParts> parts, Array<std::int32_t>& which,
                            std::span<TriangleBounds> out) {
    return with_grids(
        which, CUTS,
        [&](std::size_t side, std::span<const std::int32_t> some, Array<std::int32_t>& left) {
            return lower_some(surface, asked, parts, side, some, out, left);
        });
}

SurfaceStatus lower_heights(const Surface& surface, const ProofRequest& asked,
                            Array<std::int32_t>& which, std::span<TriangleBounds> out) {
    return with_grids(
        which, SIDES,
        [&](std::size_t side, std::span<const std::int32_t> some, Array<std::int32_t>& left) {
            return lower_some_heights(surface, asked, side, some, out, left);
        });
}

}  // namespace surfmesh
