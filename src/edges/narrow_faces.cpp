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
    NarrowSearch(const SampledCurves& edges, const FaceLoops& loops, const NarrowRequest& asked,
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
        around_ = pairwise_sum(length_);
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
        if (loops_ != 1 && loops_ != 2) return none;
        chain_loops();
        if (loops_ == 2) {
            const auto one = static_cast<std::int64_t>(first_loop_);
            const auto count = static_cast<std::int64_t>(uses_.size());
            NarrowFace ring{{{{0, one}, {one, count - one}}}, {}, true};
            return is_narrow(ring) ? ring : none;
        }
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
        struct Ranked {
            std::tuple<double, std::int64_t, double> order;
            NarrowFace face;
        };
        std::vector<Ranked> found;
        const std::vector<End> all = ends();
        for (std::size_t i = 0; i < all.size(); ++i)
            for (std::size_t k = i + 1; k < all.size(); ++k) {
                const CoedgeRun one = all[i].run, other = all[k].run;
                const std::int64_t first = other.start - one.start - one.count;
                const std::int64_t second = count - (other.start - one.start) - other.count;
                if (first < 1 || second < 1) continue;
                const double of_ends = all[i].length + all[k].length;
                if (of_ends > OF_LOOP * around_) continue;
                const CoedgeRun a{(one.start + one.count) % count, first};
                const CoedgeRun b{(other.start + other.count) % count, second};
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

    ChainPart side(CoedgeRun run) const {
        const auto place = static_cast<std::size_t>(run.start);
        const std::size_t first = place < first_loop_ ? place : place + first_loop_;
        return {chain_, first_segment_[first],
                first_segment_[first + static_cast<std::size_t>(run.count)]};
    }

    /// Each loop twice over, so that every side is a part of it.
    void chain_loops() {
        std::vector<DirectedEdge> twice;
        for (const auto& [from, to] :
             {std::pair(std::size_t{0}, first_loop_), std::pair(first_loop_, uses_.size())})
            for (int time = 0; time < 2; ++time)
                for (std::size_t k = from; k < to; ++k) {
                    twice.push_back(uses_[k]);
                    coedge_of_.push_back(coedge_ + k);
                }
        chain_ = chain_of(edges_, twice);
        for (std::size_t k = 0; k <= twice.size(); ++k)
            first_segment_.push_back(
                static_cast<std::size_t>(std::lower_bound(chain_.place.begin(), chain_.place.end(),
                                                          static_cast<std::int64_t>(k)) -
                                         chain_.place.begin()));
    }

    /// Are the sides nowhere farther apart than the width? Fills in the largest way across.
    bool is_narrow(NarrowFace& face) {
        const ChainPart first = side(face.sides[0]), second = side(face.sides[1]);
        if (first.segments() == 0 || second.segments() == 0) return false;
        FootFinder on_first(edges_.curves, first), on_second(edges_.curves, second);
        if (!is_near_in_few(first, on_second) || !is_near_in_few(second, on_first)) return false;
        double largest = 0.0;
        for (const bool is_first : {true, false}) {
            const ChainPart& own = is_first ? first : second;
            (is_first ? on_second : on_first).feet(own.points(), feet_);
            if (!std::all_of(feet_.distance.begin(), feet_.distance.end(),
                             [&](double away) { return away <= width_; }))
                return false;
            const double way = longest_way_across(own);
            if (!(way <= ROUND_A_TUBE * width_)) return false;
            largest = std::max(largest, way);
        }
        face.width = largest;
        return true;
    }

    /// A few points, from the middle on, tell most sides that are too far apart.
    bool is_near_in_few(const ChainPart& own, FootFinder& on_other) const {
        const std::size_t last = own.segments(), few = std::min(FEW, last + 1);
        const double step = static_cast<double>(last) / static_cast<double>(few - 1);
        for (std::size_t k = 0; k < few; ++k) {
            const std::size_t i = (few / 2 + k) % few;
            const auto at =
                i + 1 == few ? last : static_cast<std::size_t>(static_cast<double>(i) * step);
            if (!(on_other.distance(own.points()[at], place_along(i, few)) <= width_)) return false;
        }
        return true;
    }

    /// Parameters (u, v) of a place on the coedge of a segment.
    Point2 uv_of(std::size_t segment, double t) const {
        const auto c = static_cast<std::int64_t>(
            coedge_of_[static_cast<std::size_t>(chain_.place.data()[segment])]);
        const CurvePieces& pieces = asked_.pcurves;
        const double parameter = pieces.t0[c] + t * (pieces.t1[c] - pieces.t0[c]);
        Point3 found{};
        pieces.curves[static_cast<std::size_t>(c)]->evaluate({&parameter, 1}, 0, {&found, 1});
        return {found.x, found.y};
    }

    /// The longest way in space, straight in (u, v), from a sample of one side to its foot.
    double longest_way_across(const ChainPart& own) {
        const std::size_t count = own.segments();
        uv_.resize(ACROSS * count);
        const double step = 1.0 / static_cast<double>(ACROSS - 1);
        for (std::size_t i = 0; i < count; ++i) {
            const Point2 here = uv_of(own.first + i, chain_.t.data()[own.first + i]);
            const Point2 there =
                uv_of(static_cast<std::size_t>(feet_.segment.data()[i]), feet_.t.data()[i]);
            for (std::size_t k = 0; k < ACROSS; ++k) {
                const double t = k + 1 == ACROSS ? 1.0 : static_cast<double>(k) * step;
                uv_.data()[k * count + i] = (1.0 - t) * here + t * there;
            }
        }
        SurfaceValues values;
        if (values.evaluate(surface_, uv_, 0) != SurfaceStatus::DONE)
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

    const SampledCurves& edges_;
    const NarrowRequest& asked_;
    const Surface& surface_;
    double width_, around_ = 0.0, area_ = 0.0, diagonal_ = 0.0;
    std::size_t coedge_ = 0;                  // the face's first one in the model
    std::size_t loops_ = 0, first_loop_ = 0;  // first_loop_: coedges of the first of two, or 0
    std::vector<DirectedEdge> uses_;
    Array<double> length_;  // of the coedges
    EdgeChain chain_;       // of all coedges, loop by loop, each loop twice over
    std::vector<std::size_t> coedge_of_, first_segment_;  // of the places of the chain
    ChainFeet feet_;
    Array<Point2> uv_;
};

}  // namespace

std::vector<NarrowFace> narrow_faces(const SampledCurves& edges, const FaceLoops& loops,
                                     const NarrowRequest& asked) {
    std::vector<NarrowFace> found(asked.faces.size());
    for_each_block(found.size(), FACES_AT_ONCE, [&](std::size_t from, std::size_t to) {
        for (std::size_t row = from; row < to; ++row)
            found[row] = NarrowSearch(edges, loops, asked, row).found();
    });
    return found;
}

}  // namespace surfmesh
