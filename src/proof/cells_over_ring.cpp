#include "proof/cells_over_ring.hpp"

#include <algorithm>
#include <cmath>

#include "values/segment.hpp"

namespace surfmesh {

void CellsOverRing::take(const PieceInCells& piece) {
    bounds_ = &piece.bounds;
    points_ = piece.points;
    side_ = piece.side;
    scale_ = 1.0 / static_cast<double>(side_ * side_);
    rounded_uv_ = piece.rounded_uv;
    const std::size_t count = points_.size();
    feet_.resize(count);
    height_.resize(ring_.count() * count);
    inside_.resize(ring_.count() * count);
    is_beyond_.resize(ring_.count() * count);
    for (std::size_t k = 0; k < count; ++k) feet_[k] = ring_.foot(points_[k].value);
}

double CellsOverRing::bound(const PieceInCells& piece, double limit, bool is_last) {
    take(piece);
    measure(0);
    const double least = highest_within();
    if (!is_last && least <= limit && least + sag(ring_[0]) + rounded() > limit)
        return intervals::INFINITE;
    for (std::size_t m = 1; m < ring_.count(); ++m) measure(m);
    farthest_ = farthest_foot() + grown();
    if (!(farthest_ < ring_.free())) return intervals::INFINITE;
    return highest() * (1.0 + ROUNDING);
}

/// Heights over a member's plane, and distances inside its sides; nothing where it is too far off.
void CellsOverRing::measure(std::size_t m) {
    Neighbour& member = ring_[m];
    const std::size_t count = points_.size();
    double* height = height_.data() + m * count;
    std::array<double, 3>* inside = inside_.data() + m * count;
    std::uint8_t* is_beyond = is_beyond_.data() + m * count;
    double highest = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
        const auto& [r, error] = points_[k];
        const Point3 x = r - member.plane.point;
        const double size = std::abs(x.x) + std::abs(x.y) + std::abs(x.z);
        height[k] = std::abs(dot(member.plane.normal, x)) + 2.0 * error +
                    (member.plane.tilt + ROUNDING) * size;
        highest = std::max(highest, height[k]);
    }
    const double beside =
        2.0 * (scale_ * bounds_->cell_whole + highest + ROUNDING * ring_.longest());
    // no cell reaches farther beside the member, as in height_of
    const double reach = grown() + 2.0 * (highest + sag(member) + rounded()) * member.sine;
    std::fill_n(is_beyond, count, std::uint8_t{0});
    member.is_near = true;
    for (std::size_t s = 0; s < 3; ++s) {
        double most = -intervals::INFINITE;
        for (std::size_t k = 0; k < count; ++k) {
            inside[k][s] = dot(member.inward[s], feet_[k] - member.corners[s]);
            most = std::max(most, inside[k][s]);
            is_beyond[k] |= static_cast<std::uint8_t>((inside[k][s] < -reach ? 1U : 0U) << s);
        }
        if (m > 0 && most < -beside) member.is_near = false;
    }
}

/// The largest height of a point over the triangle itself, whose foot lies in it.
double CellsOverRing::highest_within() const {
    double most = 0.0;
    for (std::size_t k = 0; k < points_.size(); ++k) {
        const auto& [a, b, c] = inside_[k];
        if (std::min({a, b, c}) >= 0.0) most = std::max(most, height_[k]);
    }
    return most;
}

/// How far a foot leaves the triangle itself.
double CellsOverRing::farthest_foot() const {
    double most = 0.0;
    const auto& c = ring_[0].corners;
    for (std::size_t k = 0; k < points_.size(); ++k) {
        const auto& own = inside_[k];
        if (std::min({own[0], own[1], own[2]}) >= 0.0) continue;
        most = std::max(most, std::min({distance_to_segment(feet_[k], c[0], c[1]),
                                        distance_to_segment(feet_[k], c[1], c[2]),
                                        distance_to_segment(feet_[k], c[2], c[0])}));
    }
    return most;
}

/// Over all cells.
double CellsOverRing::highest() const {
    double most = 0.0;
    for (std::size_t i = 0; i < side_; ++i)
        for (std::size_t j = 0; i + j < side_; ++j) {
            const std::size_t a = row(i) + j, b = row(i + 1) + j;
            most = std::max(most, height_of({a, b, a + 1}));
            if (i + j + 1 < side_) most = std::max(most, height_of({b, b + 1, a + 1}));
        }
    return most;
}

/// How far a cell may lie beyond side s of a member, a rim, from that side; 0: it cannot.
double CellsOverRing::beyond_rim(const Neighbour& member, std::size_t m, std::size_t s,
                                 const GridCell& cell, double grown, double beside) const {
    const std::array<double, 3>* inside = inside_.data() + m * points_.size();
    double least = intervals::INFINITE, first = intervals::INFINITE, last = -first;
    const Point2 end = member.corners[(s + 1) % 3] - member.corners[s];
    const double length = norm(end);
    for (const std::size_t k : cell) {
        least = std::min(least, inside[k][s]);
        const double along = dot(end, feet_[k] - member.corners[s]) / length;
        first = std::min(first, along);
        last = std::max(last, along);
    }
    const double reach = farthest_ + beside;
    if (least >= beside || last < -reach || first > length + reach) return 0.0;
    // what lies beyond is so far across the side, and so far along it from its ends
    const double across = std::max(0.0, -least) + grown;
    const double past = std::max({0.0, -first, last - length}) + grown;
    return first >= grown && last <= length - grown ? across
                                                    : std::sqrt(across * across + past * past);
}

/// Of one cell: over the members that it may lie over, and from the rims that it may lie beyond.
double CellsOverRing::height_of(const GridCell& cell) const {
    const std::size_t count = points_.size();
    const double grows = grown();
    const auto& [a, b, c] = cell;
    double most = 0.0, from_rim = intervals::INFINITE, own = 0.0;
    bool leaves = false;
    for (std::size_t m = 0; m < ring_.count(); ++m) {
        const Neighbour& member = ring_[m];
        const std::uint8_t* is_beyond = is_beyond_.data() + m * count;
        const bool has_rim = member.is_rim[0] || member.is_rim[1] || member.is_rim[2];
        const bool is_far = !member.is_near || (is_beyond[a] & is_beyond[b] & is_beyond[c]) != 0;
        if (m > 0 && is_far && !has_rim) continue;
        const double* height = height_.data() + m * count;
        const std::array<double, 3>* inside = inside_.data() + m * count;
        const double high = std::max({height[a], height[b], height[c]}) + sag(member) + rounded();
        if (m == 0) own = high;
        // a foot along this member's normal is off by so much
        const double beside = grows + 2.0 * high * member.sine;
        bool is_over = true;
        for (std::size_t s = 0; s < 3; ++s) {
            if (std::max({inside[a][s], inside[b][s], inside[c][s]}) < -beside) is_over = false;
            if (!member.is_rim[s]) continue;
            const double away = beyond_rim(member, m, s, cell, grows, beside);
            if (away == 0.0) continue;
            leaves = true;
            from_rim = std::min(from_rim, std::sqrt(high * high + away * away) / member.cosine);
        }
        if (!is_over) continue;
        most = std::max(most, std::min(high / member.cosine, over_side(m, own, cell, grows)));
    }
    return leaves ? std::max(most, from_rim) : most;
}

/// Over a neighbour across one of the triangle's own sides: both planes meet in that side, so that
/// the height over the one is that over the other, and how far beyond the side times their slope.
double CellsOverRing::over_side(std::size_t m, double own, const GridCell& cell,
                                double grown) const {
    for (std::size_t s = 0; s < 3; ++s) {
        if (m == 0 || ring_.across(s) != m) continue;
        double least = 0.0;
        for (const std::size_t k : cell) least = std::min(least, inside_[k][s]);
        const Neighbour& member = ring_[m];
        const double slack = 2.0 * own * member.sine;  // along its normal, and not this one
        return own + (grown - least + slack) * member.sine / member.cosine;
    }
    return intervals::INFINITE;
}

double CellsOverRing::farthest_at_rims(const SpaceCorners& p) const {
    double most = 0.0;
    for (std::size_t s = 0; s < 3; ++s) {
        if (!ring_[0].is_rim[s]) continue;
        const Point3 along = p[(s + 1) % 3] - p[s];
        for (std::size_t k = 0; k <= side_; ++k) {
            const std::size_t at = s == 0 ? row(k) : s == 1 ? row(k) + side_ - k : k;
            const Point3 x = points_[at].value - p[s];
            const double away = norm(x - (dot(x, along) / dot(along, along)) * along);
            most = std::max(most, away + 2.0 * points_[at].error);
        }
    }
    return most > 0.0 ? most + grown() + bounds_->corner : 0.0;
}

}  // namespace surfmesh
