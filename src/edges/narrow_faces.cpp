#include "edges/narrow_faces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "values/pairwise_sum.hpp"
#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t MOST_COEDGES = 40;      // of a face: pairs of ends are many
constexpr std::size_t MOST_CANDIDATES = 200;  // ways to take a loop apart that are tried
constexpr std::size_t FEW = 9;                // points of a side that are looked at before all are
constexpr std::size_t ACROSS = 9;             // points on the way from one side to the other
constexpr double EMPTY = 1e-10;  // of the diagonal: the mean width of a face that encloses nothing
constexpr double ALIKE = 0.3;    // of the longer side: sides differ by no more, but for the ends
constexpr double OF_LOOP = 0.8;  // of its length: ends are no longer
constexpr std::size_t FACES_AT_ONCE = 4;

/// One face, and whether it is narrow.
class NarrowSearch {
  public:
    NarrowSearch(const SampledEdges& edges, const FaceLoops& loops, const NarrowRequest& asked,
                 std::size_t row)
        : edges_(edges), asked_(asked), surface_(*asked.surfaces[row]), width_(asked.width[row]) {
        const auto face = static_cast<std::size_t>(asked.faces[row]);
        coedge_ = static_cast<std::size_t>(loops.first_of_face[face]);
        const auto end = static_cast<std::size_t>(loops.first_of_face[face + 1]);
        for (std::size_t c = coedge_; c < end; ++c) {
            const std::int64_t edge = loops.edge[c];
            uses_.push_back({edge, loops.is_reversed[c] != 0});
            length_.push_back(edges.count(edge) > 0 ? loops.length[edge] : 0.0);
        }
        around_ = pairwise_sum({length_.data(), length_.size()});
        const auto first = std::lower_bound(loops.first_of_loop.begin(), loops.first_of_loop.end(),
                                            loops.first_of_face[face]);
        const auto last =
            std::lower_bound(first, loops.first_of_loop.end(), loops.first_of_face[face + 1]);
        loops_ = static_cast<std::size_t>(last - first);
        if (loops_ == 2) first_loop_ = static_cast<std::size_t>(*(first + 1)) - coedge_;
        area_ = loops.area[face];
        diagonal_ = loops.diagonal;
    }

    NarrowFace found() {
        NarrowFace none;
        none.width = -1.0;
        if (uses_.empty() || uses_.size() > MOST_COEDGES || !(width_ > 0.0)) return none;
        if (2.0 * area_ > ROUND_A_TUBE * width_ * around_ || area_ <= EMPTY * diagonal_ * around_)
            return none;
        if (loops_ == 2) {
            const auto one = static_cast<std::int64_t>(first_loop_);
            const auto count = static_cast<std::int64_t>(uses_.size());
            NarrowFace ring{{{{0, one}, {one, count - one}}}, {}, true};
            return is_narrow(ring) ? ring : none;
        }
        if (loops_ != 1) return none;
        for (NarrowFace& candidate : candidates())
            if (is_narrow(candidate)) return candidate;
        return none;
    }

  private:
    /// A chain that is short enough to be an end.
    struct End {
        CoedgeRun run;
        double length;
    };

    std::vector<End> ends() const {
        const std::size_t count = uses_.size();
        std::vector<End> found;
        for (std::size_t start = 0; start < count; ++start) {
            double total = 0.0;
            for (std::size_t number = 0; number + 1 < count; ++number) {
                if (total <= ROUND_A_TUBE * width_)
                    found.push_back(
                        {{static_cast<std::int64_t>(start), static_cast<std::int64_t>(number)},
                         total});
                total += length_.data()[(start + number) % count];
            }
        }
        return found;
    }

    double length_of(CoedgeRun run) const {
        std::array<double, MOST_COEDGES> own;
        const auto count = static_cast<std::size_t>(run.count);
        for (std::size_t k = 0; k < count; ++k)
            own[k] = length_.data()[(static_cast<std::size_t>(run.start) + k) % uses_.size()];
        return pairwise_sum({own.data(), count});
    }

    std::int64_t poles_of(CoedgeRun run) const {
        std::int64_t found = 0;
        for (std::int64_t k = 0; k < run.count; ++k)
            found += length_.data()[static_cast<std::size_t>(run.start + k) % uses_.size()] == 0.0;
        return found;
    }

    /// Ways to take the loop apart in two sides and two ends, the longest ends first.
    std::vector<NarrowFace> candidates() const {
        const auto count = static_cast<std::int64_t>(uses_.size());
        const auto within = [&](std::int64_t place) { return (place % count + count) % count; };
        struct Ranked {
            std::tuple<double, std::int64_t, double> order;
            NarrowFace face;
        };
        std::vector<Ranked> found;
        const std::vector<End> all = ends();
        for (std::size_t i = 0; i < all.size(); ++i)
            for (std::size_t k = i + 1; k < all.size(); ++k) {
                const CoedgeRun one = all[i].run, other = all[k].run;
                const std::int64_t first = within(other.start - one.start - one.count);
                const std::int64_t second = within(one.start - other.start - other.count);
                if (first < 1 || second < 1 || first + second + one.count + other.count != count)
                    continue;
                const double of_ends = all[i].length + all[k].length;
                if (of_ends > OF_LOOP * around_) continue;
                const CoedgeRun a{within(one.start + one.count), first};
                const CoedgeRun b{within(other.start + other.count), second};
                const double own = length_of(a), opposite = length_of(b);
                if (!(std::min(own, opposite) > 0.0) ||
                    std::abs(own - opposite) >
                        ALIKE * std::max(own, opposite) + ROUND_A_TUBE * width_)
                    continue;
                const std::int64_t poles = poles_of(one) + poles_of(other);
                found.push_back(
                    {{-of_ends, -poles, std::abs(own - opposite)}, {{a, b}, {other, one}}});
            }
        std::stable_sort(found.begin(), found.end(),
                         [](const Ranked& a, const Ranked& b) { return a.order < b.order; });
        std::vector<NarrowFace> best;
        for (std::size_t i = 0; i < std::min(found.size(), MOST_CANDIDATES); ++i)
            best.push_back(found[i].face);
        return best;
    }

    EdgeChain side(CoedgeRun run) const {
        EdgeChain chain;
        std::vector<DirectedEdge> which;
        for (std::int64_t k = 0; k < run.count; ++k)
            which.push_back(uses_[static_cast<std::size_t>(run.start + k) % uses_.size()]);
        return chain_of(edges_, which, run.start);
    }

    /// Are the sides nowhere farther apart than the width? Fills in the largest way across.
    bool is_narrow(NarrowFace& face) {
        const EdgeChain first = side(face.sides[0]), second = side(face.sides[1]);
        if (first.segments() == 0 || second.segments() == 0) return false;
        if (!is_near_in_few(first, second) || !is_near_in_few(second, first)) return false;
        double largest = 0.0;
        for (const auto& [own, other] : {std::pair(&first, &second), std::pair(&second, &first)}) {
            feet_on_chain(edges_.curves, {own->points.data(), own->points.size()}, *other, feet_);
            if (!is_near(feet_)) return false;
            const double way = longest_way_across(*own, *other);
            if (!(way <= ROUND_A_TUBE * width_)) return false;
            largest = std::max(largest, way);
        }
        face.width = largest;
        return true;
    }

    bool is_near(const ChainFeet& feet) const {
        return std::all_of(feet.distance.begin(), feet.distance.end(),
                           [&](double away) { return away <= width_; });
    }

    /// A few points tell most sides that are too far apart.
    bool is_near_in_few(const EdgeChain& own, const EdgeChain& other) {
        const std::size_t last = own.points.size() - 1, few = std::min(FEW, last + 1);
        Array<Point3> points;
        const double step = static_cast<double>(last) / static_cast<double>(few - 1);
        for (std::size_t i = 0; i < few; ++i) {
            const auto at = static_cast<std::size_t>(static_cast<double>(i) * step);
            points.push_back(own.points.data()[i + 1 == few ? last : at]);
        }
        feet_on_chain(edges_.curves, {points.data(), few}, other, feet_);
        return is_near(feet_);
    }

    /// Parameters (u, v) of a place on a coedge; place: round the row of coedges.
    Point2 uv_of(std::int64_t place, double t) const {
        const auto c =
            static_cast<std::int64_t>(coedge_ + static_cast<std::size_t>(place) % uses_.size());
        const CurvePieces& pieces = asked_.pcurves;
        const double parameter = pieces.t0[c] + t * (pieces.t1[c] - pieces.t0[c]);
        Point3 found{};
        pieces.curves[static_cast<std::size_t>(c)]->evaluate({&parameter, 1}, 0, {&found, 1});
        return {found.x, found.y};
    }

    /// The longest way in space, straight in (u, v), from a sample of one side to its foot.
    double longest_way_across(const EdgeChain& own, const EdgeChain& other) {
        const std::size_t count = own.segments();
        uv_.resize(ACROSS * count);
        const double step = 1.0 / static_cast<double>(ACROSS - 1);
        for (std::size_t i = 0; i < count; ++i) {
            const Point2 here = uv_of(own.place.data()[i], own.t.data()[i]);
            const Point2 there = uv_of(other.place[feet_.segment.data()[i]], feet_.t.data()[i]);
            for (std::size_t k = 0; k < ACROSS; ++k) {
                const double t = k + 1 == ACROSS ? 1.0 : static_cast<double>(k) * step;
                uv_.data()[k * count + i] = (1.0 - t) * here + t * there;
            }
        }
        SurfaceValues values;
        if (values.evaluate(surface_, {uv_.data(), uv_.size()}, 0) != SurfaceStatus::DONE)
            return std::numeric_limits<double>::infinity();
        const std::span<const Point3> points = values[0];
        double longest = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            double way = 0.0;
            for (std::size_t k = 0; k + 1 < ACROSS; ++k)
                way += norm(points[(k + 1) * count + i] - points[k * count + i]);
            if (std::isnan(way)) return way;
            longest = std::max(longest, way);
        }
        return longest;
    }

    const SampledEdges& edges_;
    const NarrowRequest& asked_;
    const Surface& surface_;
    double width_, around_ = 0.0, area_ = 0.0, diagonal_ = 0.0;
    std::size_t coedge_ = 0, loops_ = 0, first_loop_ = 0;  // the face's first coedge in the model
    std::vector<DirectedEdge> uses_;
    Array<double> length_;  // of the coedges
    ChainFeet feet_;
    Array<Point2> uv_;
};

}  // namespace

std::vector<NarrowFace> narrow_faces(const SampledEdges& edges, const FaceLoops& loops,
                                     const NarrowRequest& asked) {
    std::vector<NarrowFace> found(asked.faces.size());
    for_each_block(found.size(), FACES_AT_ONCE, [&](std::size_t from, std::size_t to) {
        for (std::size_t row = from; row < to; ++row)
            found[row] = NarrowSearch(edges, loops, asked, row).found();
    });
    return found;
}

}  // namespace surfmesh
