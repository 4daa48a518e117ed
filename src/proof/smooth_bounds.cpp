#include "proof/smooth_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "proof/cell_bounds.hpp"
#include "proof/distinct_places.hpp"
#include "proof/plane_groups.hpp"
#include "surfaces/outward.hpp"

namespace surfmesh {
namespace {

constexpr double SMOOTH_ROUNDING = 0x1p-46;  // relative, more than that of any short sum here
constexpr std::size_t SMOOTH_TOGETHER = 24;  // triangles over one cell, at first
constexpr double LITTLE = 0.08;              // of the height: good enough to leave open
constexpr double OF_LIMIT = 2.0;  // what a grid of points leaves a small part of: grid_bounds.hpp
constexpr double WORTH =
    1.5;  // how much less fourth derivatives are over one triangle: else no cuts

constexpr double NONE = intervals::INFINITE;
constexpr TriangleBounds UNKNOWN = {.height = NONE,
                                    .outward = {NONE, NONE, NONE},
                                    .rim = {NONE, NONE, NONE},
                                    .shift = NONE,
                                    .whole = NONE,
                                    .corner = NONE,
                                    .inner = {NONE, NONE, NONE},
                                    .beside = {NONE, NONE, NONE},
                                    .steep = {NONE, NONE, NONE},
                                    .along = {NONE, NONE, NONE},
                                    .others = {NONE, NONE, NONE},
                                    .bend = NONE,
                                    .slope = NONE,
                                    .cell_height = NONE,
                                    .cell_whole = NONE};

/// How much of a height is left open: by what fourth derivatives along the normal are not known.
double open_part(const FourthParts& parts) {
    double most = 0.0;
    for (const double rad : parts.rad) most = std::max(most, rad);
    return most / 36.0;
}

/// Is a height by the largest of what corners say much above one by what they say of the middle?
bool is_loose(double height, const CellCorners& corners) {
    constexpr double MUCH = 1.05;
    BySide sum{};  // nine times the mean of g, (x + u_i + u_j) / 3
    for (std::size_t k = 0; k < 3; ++k) {
        const auto at = [&](std::size_t c) { return corners[c % 3]->bends.value[2][k]; };
        sum[k] = 4.0 * (at(k) + at(k + 1)) + at(k + 2);
    }
    const double up = largest_on_simplex(sum[0], sum[1], sum[2]),
                 down = largest_on_simplex(-sum[0], -sum[1], -sum[2]);
    return height > MUCH * std::max(up, down) / 18.0;
}

void widen(ParameterBox& box, Point2 p) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
}

/// Of the pieces of a group, all of which lie in the domain.
ParameterBox hull_of(std::span<const PlacedTriangle> group, const ProofRequest& asked,
                     const ParameterBox& domain) {
    const Point2 first = asked.uv[static_cast<std::size_t>(group[0].triangle)][0];
    ParameterBox box{first, first};
    const auto take = [&box](Point2 p) { widen(box, p); };
    for (const PlacedTriangle& member : group) {
        const PlanePiece piece = asked.piece(static_cast<std::size_t>(member.triangle));
        for (const Point2 p : piece.uv) take(p);
        if (piece.is_straight()) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const Point2 p = piece.control(k);
            const Point2 off = {0x1p-48 * std::abs(p.x), 0x1p-48 * std::abs(p.y)};
            const Point2 low = p - off, high = p + off;
            take({std::max(low.x, domain.low.x), std::max(low.y, domain.low.y)});
            take({std::min(high.x, domain.high.x), std::min(high.y, domain.high.y)});
        }
    }
    return box;
}

/// What is left of a group, and the derivatives over its cell.
struct Unproved {
    TriangleGroup rest;
    HighDerivatives over;
};

class SmoothBounds {
  public:
    SmoothBounds(const FourthDerivatives& surface, const ParameterBox& domain,
                 const ProofRequest& asked, std::span<TriangleBounds> out,
                 std::span<FourthParts> parts)
        : surface_(surface),
          domain_(domain),
          asked_(asked),
          out_(out),
          parts_(parts),
          places_({asked.uv.empty() ? nullptr : asked.uv[0].data(), 3 * asked.uv.size()}),
          jets_(Array<SecondJet>::unfilled(places_.all().size())),
          is_known_(jets_.size()),
          is_bounded_(asked.uv.size(), 0),
          off_(asked.uv.size(), 0.0),
          part_(asked.uv.size(), NONE),
          members_(placed_triangles(asked.uv)) {}

    SurfaceStatus run();

  private:
    void prepare();
    /// Where bounds were put off, or nothing was found.
    void finish();
    void divide(TriangleGroup group);
    /// False: too much is left open, or nothing is known. What is known already is kept if it is better.
    /// is_last: there is no smaller cell, so that bounds are made of what there is.
    bool look_at(std::int32_t t, const DerivativeRows& over, bool is_last);
    [[nodiscard]] bool is_known_at(std::int32_t t) const;
    [[nodiscard]] const SecondJet& jet_at(std::int32_t t, std::size_t corner) const {
        return jets_.begin()[places_.at(3 * static_cast<std::size_t>(t) + corner)];
    }
    [[nodiscard]] double height_at_corner(std::int32_t t, const TriangleFrame& frame) const;
    [[nodiscard]] TriangleFrame frame_at(std::int32_t t) const {
        return frame_of(asked_.corners[t], off_[t], asked_.rims[t]);
    }
    /// Of one triangle, with the fourth derivatives that are known. False as above.
    bool bound(std::int32_t t, const TriangleFrame& frame);
    /// Groups that are left, where smaller cells help.
    SurfaceStatus cut_further(std::span<const Unproved> all);
    void cut(TriangleGroup group);

    const FourthDerivatives& surface_;
    ParameterBox domain_;
    ProofRequest asked_;
    std::span<TriangleBounds> out_;
    std::span<FourthParts> parts_;
    DistinctPlaces places_;
    Array<SecondJet> jets_;
    Array<std::uint8_t> is_known_, is_bounded_;  // of places; of triangles, with their parts
    Array<double> off_,
        part_;  // how far corners are off; how much of the height is left open, so far
    Array<PlacedTriangle> members_;
    Array<TriangleGroup> groups_;
};

void SmoothBounds::prepare() {
    for (std::size_t t = 0; t < asked_.uv.size(); ++t) {
        double& off = off_.begin()[t];
        for (std::size_t k = 0; k < 3 && asked_.corners_are_on_surface; ++k) {
            const auto& [value, error] = jets_[places_.at(3 * t + k)][0];
            const double away =
                norm(asked_.corners[t][k] - value) * (1.0 + SMOOTH_ROUNDING) + 2.0 * error;
            off = std::max(off, away <= intervals::INFINITE ? away : intervals::INFINITE);
        }
    }
    for (std::size_t i = 0; i < jets_.size(); ++i) is_known_[i] = is_known(jets_[i]) ? 1 : 0;
}

void SmoothBounds::finish() {
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(out_.size()); ++t) {
        if (part_[t] < NONE && is_bounded_[t] == 0) bound(t, frame_at(t));
        if (part_[t] < NONE) continue;
        out_[t] = UNKNOWN;
        out_[t].corner = off_[t];
        parts_[t] = UNKNOWN_PARTS;
    }
}

void SmoothBounds::divide(TriangleGroup group) {
    if (group.size() <= SMOOTH_TOGETHER) {
        groups_.push_back(group);
        return;
    }
    for (const TriangleGroup half : halves_of(group, asked_.uv)) divide(half);
}

bool SmoothBounds::is_known_at(std::int32_t t) const {
    for (std::size_t k = 0; k < 3; ++k)
        if (is_known_[places_.at(3 * static_cast<std::size_t>(t) + k)] == 0) return false;
    return true;
}

/// About as high as the piece is, by the curvature at a corner alone.
double SmoothBounds::height_at_corner(std::int32_t t, const TriangleFrame& frame) const {
    const PlanePiece piece = asked_.piece(static_cast<std::size_t>(t));
    const PlaceBends there =
        place_bends(jet_at(t, 0), piece, PieceSteps(piece), AT_CORNERS[0], frame.axes);
    const auto& [x, y, z] = there.value[2];
    return 0.125 * std::max({std::abs(x), std::abs(y), std::abs(z)});
}

bool SmoothBounds::look_at(std::int32_t t, const DerivativeRows& over, bool is_last) {
    if (!is_known_at(t)) return false;
    const TriangleFrame frame = frame_at(t);
    const FourthParts parts =
        fourth_parts(over, asked_.piece(static_cast<std::size_t>(t)), frame.axes);
    const double part = open_part(parts);
    if (!(part < part_[t])) return false;
    parts_[t] = parts;
    part_[t] = part;
    is_bounded_[t] = 0;
    const bool is_large = part > OF_LIMIT * asked_.limits[t];
    if (!is_last && is_large && part > LITTLE * height_at_corner(t, frame)) return false;
    return bound(t, frame);
}

/// The slope of one cell.
double steepest_of(const std::array<PlaceJet, 3>& corners, const FourthParts& parts,
                   const TriangleFrame& frame) {
    // as rows of the grid are: corner 0, corner 2, corner 1
    const std::array<PlaceJet, 3> rows = {corners[0], corners[2], corners[1]};
    return bounds_of_cells(rows, 1, parts, frame, CellPlaces::NONE, true).slope;
}

bool SmoothBounds::bound(std::int32_t t, const TriangleFrame& frame) {
    const PlanePiece piece = asked_.piece(static_cast<std::size_t>(t));
    const FourthParts& parts = parts_[t];
    const double off = off_[t], part = part_[t];
    const std::array<const SecondJet*, 3> jets = {&jet_at(t, 0), &jet_at(t, 1), &jet_at(t, 2)};
    const PieceSteps steps(piece);
    std::array<PlaceJet, 3> places{};
    const std::array<EnclosedPoint, 3> own = {(*jets[0])[0], (*jets[1])[0], (*jets[2])[0]};
    const bool with_slope = asked_.slope < NONE;
    for (std::size_t k = 0; k < 3; ++k)
        if (with_slope || !asked_.curved.empty())
            places[k] = place_jet(*jets[k], piece, steps, AT_CORNERS[k], frame.axes, own,
                                  asked_.curve(static_cast<std::size_t>(t)), with_slope);
        else  // at corners R is L
            places[k].bends = place_bends(*jets[k], piece, steps, AT_CORNERS[k], frame.axes);
    const CellCorners corners = {&places[0], &places[1], &places[2]};
    const SideBends averaged = averaged_bends(corners, parts);
    TriangleBounds found = bounds_from(averaged, frame, off, false);
    is_bounded_[t] = 1;
    if (!(found.whole < intervals::INFINITE)) {
        part_[t] = NONE;
        return false;
    }
    const double limit = asked_.limits[t] - off;
    const PieceSize rises = size_from(bends_of_cell(corners, parts.rho, false), frame);
    found.cell_height = rises.height;
    found.cell_whole = rises.whole;
    found.slope = with_slope ? steepest_of(places, parts, frame) : NONE;
    // else places within say nothing more
    if (part <= limit && (found.whole > limit || is_loose(found.height, corners))) {
        const double high = height_at_places(corners, parts, frame, rises.height, found.whole);
        found.height = std::min(found.height, high);
        found.whole = std::min(found.whole, whole_with(averaged, frame, found.height));
        if (found.whole > limit && found.height <= limit)
            found.whole = std::min(found.whole, size_at_places(corners, parts, frame, rises).whole);
    }
    const double least = std::max(LITTLE * found.height, OF_LIMIT * asked_.limits[t]);
    out_[t] = found;
    return part <= least || (found.whole <= limit && found.slope <= asked_.slope);
}

bool is_finite(const HighDerivatives& over) {
    return std::all_of(over.rad.begin(), over.rad.end(),
                       [](Point3 x) { return x.x + x.y + x.z < NONE; });
}

void SmoothBounds::cut(TriangleGroup group) {
    if (group.size() == 1) {
        groups_.push_back(group);
        return;
    }
    for (const TriangleGroup half : halves_of(group, asked_.uv)) {
        if (half.size() == 1) {
            groups_.push_back(half);
            continue;
        }
        for (const TriangleGroup quarter : halves_of(half, asked_.uv)) groups_.push_back(quarter);
    }
}

SurfaceStatus SmoothBounds::cut_further(std::span<const Unproved> all) {
    Array<ParameterBox> cells;
    for (const Unproved& left : all) {
        std::swap(left.rest[0], left.rest[left.rest.size() / 2]);
        cells.push_back(hull_of(left.rest.first(1), asked_, domain_));
    }
    Array<HighDerivatives> found(cells.size());
    const auto status =
        surface_.enclose_high({cells.data(), cells.size()}, {found.data(), found.size()});
    if (status != SurfaceStatus::DONE) return status;
    Array<Unproved> others;
    for (std::size_t k = 0; k < all.size(); ++k) {
        const TriangleGroup rest = all[k].rest.subspan(1);
        const std::int32_t first = all[k].rest[0].triangle;
        const HighDerivatives& over_one = found[static_cast<std::ptrdiff_t>(k)];
        if (!is_finite(over_one)) {  // which says nothing of the others
            if (!rest.empty()) others.push_back({rest, all[k].over});
            continue;
        }
        const double before = part_[first];
        look_at(first, DerivativeRows(over_one), true);  // there is no less of it to look at
        // could smaller cells show less of others? They do for one, if so
        if (!rest.empty() && !(before <= WORTH * part_[first])) cut(rest);
    }
    return others.empty() ? status : cut_further({others.data(), others.size()});
}

SurfaceStatus SmoothBounds::run() {
    constexpr std::size_t AT_ONCE = 32;  // groups
    auto status = surface_.enclose_second(places_.all(), {jets_.data(), jets_.size()});
    if (status != SurfaceStatus::DONE) return status;
    prepare();
    divide({members_.data(), members_.size()});
    Array<ParameterBox> cells;
    Array<HighDerivatives> found;
    Array<Unproved> left;
    std::size_t count = 0;
    for (std::size_t start = 0; start < groups_.size(); start += count) {
        count = std::min(AT_ONCE, groups_.size() - start);
        const auto group_of = [&](std::size_t k) {
            return groups_[static_cast<std::ptrdiff_t>(start + k)];
        };
        cells.clear();
        left.clear();
        for (std::size_t k = 0; k < count; ++k)
            cells.push_back(hull_of(group_of(k), asked_, domain_));
        found.resize(count);
        status = surface_.enclose_high({cells.data(), count}, {found.data(), count});
        if (status != SurfaceStatus::DONE) return status;
        for (std::size_t k = 0; k < count; ++k) {
            const TriangleGroup group = group_of(k);
            const HighDerivatives& over = found[static_cast<std::ptrdiff_t>(k)];
            const DerivativeRows by_row(over);
            const auto bad =
                std::partition(group.begin(), group.end(), [&](const PlacedTriangle& member) {
                    return look_at(member.triangle, by_row, group.size() == 1);
                });
            if (bad != group.end() && group.size() > 1)
                left.push_back({TriangleGroup(bad, group.end()), over});
        }
        status = cut_further({left.data(), left.size()});  // at the end of the groups
        if (status != SurfaceStatus::DONE) return status;
    }
    finish();
    return status;
}

}  // namespace

SurfaceStatus smooth_bounds(const FourthDerivatives& surface, const ParameterBox& domain,
                            const ProofRequest& asked, std::span<TriangleBounds> out,
                            std::span<FourthParts> parts) {
    return SmoothBounds(surface, domain, asked, out, parts).run();
}

}  // namespace surfmesh
