#include "proof/smooth_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "proof/cell_bounds.hpp"
#include "proof/distinct_places.hpp"
#include "surfaces/outward.hpp"

namespace surfmesh {
namespace {

constexpr double SMOOTH_ROUNDING = 0x1p-46;   // relative, more than that of any short sum here
constexpr std::int32_t SMOOTH_TOGETHER = 12;  // triangles over one cell, at first
constexpr double LITTLE = 0.04;               // of the height: rho that is good enough
constexpr double LITTLE_OF_LIMIT = 0.005;
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

/// A triangle, and three times its middle in (u, v).
struct Member {
    Point2 middle;
    std::int32_t triangle;
};
using Group = std::span<Member>;

void widen(ParameterBox& box, Point2 p) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
}

/// Of the pieces of a group, all of which lie in the domain.
ParameterBox hull_of(std::span<const Member> group, const ProofRequest& asked,
                     const ParameterBox& domain) {
    const Point2 first = asked.uv[static_cast<std::size_t>(group[0].triangle)][0];
    ParameterBox box{first, first};
    const auto take = [&box](Point2 p) { widen(box, p); };
    for (const Member& member : group) {
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
    Group rest;
    HighMagnitudes most;
};

class SmoothBounds {
  public:
    SmoothBounds(const FourthDerivatives& surface, const ParameterBox& domain,
                 const ProofRequest& asked, std::span<TriangleBounds> out,
                 std::span<FourthParts> rho)
        : surface_(surface),
          domain_(domain),
          asked_(asked),
          out_(out),
          rho_(rho),
          places_({asked.uv.empty() ? nullptr : asked.uv[0].data(), 3 * asked.uv.size()}),
          jets_(places_.all().size()),
          is_known_(jets_.size()),
          members_(asked.uv.size()) {}

    SurfaceStatus run();

  private:
    void prepare();
    /// The triangles of a group, by their places along its longer side.
    [[nodiscard]] std::array<Group, 2> halves_of(Group group) const;
    void divide(Group group);
    /// False: rho is too large, or nothing is known. What is known already is kept if it is better.
    bool look_at(std::int32_t t, const HighMagnitudes& most);
    /// Groups that are left, where smaller cells help.
    SurfaceStatus cut_further(std::span<const Unproved> all);
    void cut(Group group);

    const FourthDerivatives& surface_;
    ParameterBox domain_;
    ProofRequest asked_;
    std::span<TriangleBounds> out_;
    std::span<FourthParts> rho_;
    DistinctPlaces places_;
    Array<SecondJet> jets_;
    Array<std::uint8_t> is_known_;
    Array<Member> members_;
    Array<Group> groups_;
};

void SmoothBounds::prepare() {
    for (std::size_t t = 0; t < asked_.uv.size(); ++t) {
        const PlaneCorners& p = asked_.uv[t];
        members_[t] = {p[0] + p[1] + p[2], static_cast<std::int32_t>(t)};
        double off = 0.0;
        for (std::size_t k = 0; k < 3 && asked_.corners_are_on_surface; ++k) {
            const auto& [value, error] = jets_[places_.at(3 * t + k)][0];
            const double away =
                norm(asked_.corners[t][k] - value) * (1.0 + SMOOTH_ROUNDING) + 2.0 * error;
            off = std::max(off, away <= intervals::INFINITE ? away : intervals::INFINITE);
        }
        out_[t] = UNKNOWN;
        rho_[t] = UNKNOWN_PARTS;
        out_[t].corner = off;
    }
    for (std::size_t i = 0; i < jets_.size(); ++i) is_known_[i] = is_known(jets_[i]) ? 1 : 0;
}

std::array<Group, 2> SmoothBounds::halves_of(Group group) const {
    ParameterBox box{group[0].middle, group[0].middle};
    for (const Member& member : group) widen(box, member.middle);
    // sides in (u, v) are compared as the triangles lie in space
    double along_u = 0.0, along_v = 0.0;
    const PlaneCorners& first = asked_.uv[static_cast<std::size_t>(group[0].triangle)];
    for (const Point2 p : first) {
        along_u = std::max(along_u, std::abs(p.x - first[0].x));
        along_v = std::max(along_v, std::abs(p.y - first[0].y));
    }
    const auto half = static_cast<std::ptrdiff_t>(group.size() / 2);
    const auto cut_by = [&](auto place) {
        std::nth_element(group.begin(), group.begin() + half, group.end(),
                         [place](const Member& a, const Member& b) {
                             const double x = place(a), y = place(b);
                             return x < y || (x == y && a.triangle < b.triangle);
                         });
    };
    if ((box.high.x - box.low.x) * along_v >= (box.high.y - box.low.y) * along_u)
        cut_by([](const Member& member) { return member.middle.x; });
    else
        cut_by([](const Member& member) { return member.middle.y; });
    const auto middle = static_cast<std::size_t>(half);
    return {group.first(middle), group.subspan(middle)};
}

void SmoothBounds::divide(Group group) {
    if (group.size() <= SMOOTH_TOGETHER) {
        groups_.push_back(group);
        return;
    }
    for (const Group half : halves_of(group)) divide(half);
}

bool SmoothBounds::look_at(std::int32_t t, const HighMagnitudes& most) {
    std::array<const SecondJet*, 3> jets{};
    for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t place = places_.at(3 * static_cast<std::size_t>(t) + k);
        if (is_known_[place] == 0) return false;
        jets[k] = &jets_[place];
    }
    const double off = out_[t].corner;
    const TriangleFrame frame = frame_of(asked_.corners[t], off, asked_.rims[t]);
    const PlanePiece piece = asked_.piece(static_cast<std::size_t>(t));
    const FourthParts rho = fourth_parts(most, piece, frame.axes);
    if (!(rho[0][0] < NONE)) return false;
    std::array<PlaceJet, 3> places{};
    const std::array<EnclosedPoint, 3> own = {(*jets[0])[0], (*jets[1])[0], (*jets[2])[0]};
    const bool with_slope = asked_.slope < NONE;
    for (std::size_t k = 0; k < 3; ++k)
        if (with_slope || !asked_.curved.empty())
            places[k] = place_jet(*jets[k], piece, AT_CORNERS[k], frame.axes, own,
                                  asked_.curve(static_cast<std::size_t>(t)), with_slope);
        else  // at corners R is L
            places[k].bends = place_bends(*jets[k], piece, AT_CORNERS[k], frame.axes);
    TriangleBounds found =
        bounds_from(averaged_bends({&places[0], &places[1], &places[2]}, rho), frame, off, false);
    if (!(found.whole < intervals::INFINITE)) return false;
    const double limit = asked_.limits[t] - off;
    // as rows of the grid are: corner 0, corner 2, corner 1
    const std::array<PlaceJet, 3> rows = {places[0], places[2], places[1]};
    const CellPlaces within = found.whole <= limit ? CellPlaces::NONE : CellPlaces::MANY;
    const auto [bends, whole, steepest] = bounds_of_cells(rows, 1, rho, frame, within, with_slope);
    const auto [height, cell_whole] = size_from(bends, frame);
    found.cell_height = height;
    found.cell_whole = cell_whole;
    found.slope = steepest;
    found.whole = std::min(found.whole, whole);
    const double part = std::max({rho[2][0], rho[2][1], rho[2][2]}) / 6.0;
    const double least = std::max(LITTLE * found.height, LITTLE_OF_LIMIT * asked_.limits[t]);
    if (rho[2][0] + rho[2][1] + rho[2][2] < rho_[t][2][0] + rho_[t][2][1] + rho_[t][2][2]) {
        out_[t] = found;
        rho_[t] = rho;
    }
    return part <= least || (found.whole <= limit && found.slope <= asked_.slope);
}

/// Could smaller cells show less? They do for one of a group's triangles, if so.
bool is_worth(const HighMagnitudes& all, const HighMagnitudes& one) {
    constexpr std::size_t FOURTH = 7;
    for (std::size_t n = FOURTH; n < all.size(); ++n) {
        const double a = all[n].x + all[n].y + all[n].z, b = one[n].x + one[n].y + one[n].z;
        if (!(a <= WORTH * b)) return true;
    }
    return false;
}

bool is_finite(const HighMagnitudes& most) {
    return std::all_of(most.begin(), most.end(), [](Point3 x) { return x.x + x.y + x.z < NONE; });
}

void SmoothBounds::cut(Group group) {
    if (group.size() == 1) {
        groups_.push_back(group);
        return;
    }
    for (const Group half : halves_of(group)) {
        if (half.size() == 1) {
            groups_.push_back(half);
            continue;
        }
        for (const Group quarter : halves_of(half)) groups_.push_back(quarter);
    }
}

SurfaceStatus SmoothBounds::cut_further(std::span<const Unproved> all) {
    Array<ParameterBox> cells;
    for (const Unproved& left : all) {
        std::swap(left.rest[0], left.rest[left.rest.size() / 2]);
        cells.push_back(hull_of(left.rest.first(1), asked_, domain_));
    }
    Array<HighMagnitudes> most(cells.size());
    const auto status =
        surface_.high_magnitudes({cells.data(), cells.size()}, {most.data(), most.size()});
    if (status != SurfaceStatus::DONE) return status;
    Array<Unproved> others;
    for (std::size_t k = 0; k < all.size(); ++k) {
        const Group rest = all[k].rest.subspan(1);
        const HighMagnitudes& over_one = most[static_cast<std::ptrdiff_t>(k)];
        if (!is_finite(over_one)) {  // which says nothing of the others
            if (!rest.empty()) others.push_back({rest, all[k].most});
            continue;
        }
        if (!is_worth(all[k].most, over_one)) continue;
        look_at(all[k].rest[0].triangle, over_one);  // there is no less of it to look at
        if (!rest.empty()) cut(rest);
    }
    return others.empty() ? status : cut_further({others.data(), others.size()});
}

SurfaceStatus SmoothBounds::run() {
    constexpr std::size_t AT_ONCE = 256;  // groups
    auto status = surface_.enclose_second(places_.all(), {jets_.data(), jets_.size()});
    if (status != SurfaceStatus::DONE) return status;
    prepare();
    divide({members_.data(), members_.size()});
    Array<ParameterBox> cells;
    Array<HighMagnitudes> most;
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
        most.resize(count);
        status = surface_.high_magnitudes({cells.data(), count}, {most.data(), count});
        if (status != SurfaceStatus::DONE) return status;
        for (std::size_t k = 0; k < count; ++k) {
            const Group group = group_of(k);
            const HighMagnitudes& over = most[static_cast<std::ptrdiff_t>(k)];
            const auto bad = std::partition(group.begin(), group.end(), [&](const Member& member) {
                return look_at(member.triangle, over);
            });
            if (bad != group.end() && group.size() > 1)
                left.push_back({Group(bad, group.end()), over});
        }
        status = cut_further({left.data(), left.size()});  // at the end of the groups
        if (status != SurfaceStatus::DONE) return status;
    }
    return status;
}

}  // namespace

SurfaceStatus smooth_bounds(const FourthDerivatives& surface, const ParameterBox& domain,
                            const ProofRequest& asked, std::span<TriangleBounds> out,
                            std::span<FourthParts> rho) {
    return SmoothBounds(surface, domain, asked, out, rho).run();
}

}  // namespace surfmesh
