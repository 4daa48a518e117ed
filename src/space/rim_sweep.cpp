#include "space/rim_sweep.hpp"

#include <algorithm>
#include <vector>

#include "triangulation/predicates.hpp"

namespace surfmesh {
namespace {

bool is_swept_before(Point2 p, Point2 q) { return p.x < q.x || (p.x == q.x && p.y < q.y); }

/// A rim edge from where the sweep meets it first.
struct SweptEdge {
    Point2 first, last;
    Vertex first_vertex, last_vertex;
    bool with_sweep;  // the patch is above
};

SweptEdge swept(const RimEdge& e) {
    if (is_swept_before(e.from, e.to)) return {e.from, e.to, e.start, e.end, true};
    return {e.to, e.from, e.end, e.start, false};
}

/// An end of an edge.
struct SweepEvent {
    Point2 place;
    Vertex vertex;
    std::int32_t edge;
    bool starts;
};

/// The edges that the sweep line crosses, from below.
class RimSweep {
  public:
    explicit RimSweep(std::span<const RimEdge> edges) {
        edges_.reserve(edges.size());
        for (const RimEdge& e : edges) edges_.push_back(swept(e));
    }

    bool is_simple() {
        const Array<SweepEvent> events = sorted_events();
        for (std::size_t k = 0; k < events.size();) {
            std::size_t end = k + 1;
            while (end < events.size() && events[end].vertex == events[k].vertex) ++end;
            if (end < events.size() && !is_swept_before(events[k].place, events[end].place))
                return false;  // two vertices at one place
            if (!passes({&events[k], end - k})) return false;
            k = end;
        }
        return line_.empty();
    }

  private:
    [[nodiscard]] Array<SweepEvent> sorted_events() const {
        Array<SweepEvent> events;
        events.reserve(2 * edges_.size());
        for (std::size_t k = 0; k < edges_.size(); ++k) {
            const auto edge = static_cast<std::int32_t>(k);
            events.push_back({edges_[k].first, edges_[k].first_vertex, edge, true});
            events.push_back({edges_[k].last, edges_[k].last_vertex, edge, false});
        }
        std::sort(events.begin(), events.end(), [](const SweepEvent& a, const SweepEvent& b) {
            if (a.place.x != b.place.x) return a.place.x < b.place.x;
            if (a.place.y != b.place.y) return a.place.y < b.place.y;
            return a.vertex < b.vertex;
        });
        return events;
    }

    /// > 0 where p is above the edge, on the sweep line.
    [[nodiscard]] double above(std::int32_t edge, Point2 p) const {
        return orient(edges_[edge].first, edges_[edge].last, p);
    }

    /// Take the sweep across a vertex, whose edges these are.
    bool passes(std::span<const SweepEvent> ends) {
        const Point2 place = ends[0].place;
        const Vertex vertex = ends[0].vertex;
        const auto low = std::partition_point(line_.begin(), line_.end(), [&](std::int32_t e) {
            return edges_[e].last_vertex != vertex && above(e, place) > 0.0;
        });
        auto high = low;
        while (high != line_.end() && edges_[*high].last_vertex == vertex) ++high;
        starting_.clear();
        for (const SweepEvent& end : ends)
            if (end.starts) starting_.push_back(end.edge);
        if (static_cast<std::size_t>(high - low) + starting_.size() != ends.size()) return false;
        if (high != line_.end() && !(above(*high, place) < 0.0)) return false;
        if (!are_sorted_by_angle()) return false;
        const auto at = static_cast<std::size_t>(low - line_.begin());
        replace(at, static_cast<std::size_t>(high - low));
        return is_in_order(at);
    }

    /// Those that start at a vertex, from below; false where two of them lie along each other.
    bool are_sorted_by_angle() {
        const auto is_below = [&](std::int32_t a, std::int32_t b) {
            return above(a, edges_[b].last) > 0.0;
        };
        std::sort(starting_.begin(), starting_.end(), is_below);
        for (std::size_t k = 1; k < starting_.size(); ++k)
            if (!is_below(starting_[k - 1], starting_[k])) return false;
        return true;
    }

    /// Put those that start in the place of ``ended`` edges of the line.
    void replace(std::size_t at, std::size_t ended) {
        const std::size_t kept = std::min(ended, starting_.size());
        std::copy_n(starting_.begin(), kept, line_.begin() + static_cast<std::ptrdiff_t>(at));
        const auto next = line_.begin() + static_cast<std::ptrdiff_t>(at + kept);
        if (ended > kept)
            line_.erase(next, next + static_cast<std::ptrdiff_t>(ended - kept));
        else
            line_.insert(next, starting_.begin() + static_cast<std::ptrdiff_t>(kept),
                         starting_.end());
    }

    /// Do the new neighbours on the line, from ``at`` on, stay apart and take turns?
    [[nodiscard]] bool is_in_order(std::size_t at) const {
        const std::size_t end = at + starting_.size();
        for (std::size_t k = at; k < end; ++k)
            if (edges_[line_[k]].with_sweep != (k % 2 == 0)) return false;
        if (at > 0 && at < line_.size() && !stay_apart(line_[at - 1], line_[at])) return false;
        if (end == at) return true;
        return end == line_.size() || stay_apart(line_[end - 1], line_[end]);
    }

    /// Two edges, one below the other now: still where the first of them ends?
    [[nodiscard]] bool stay_apart(std::int32_t lower, std::int32_t upper) const {
        const SweptEdge &a = edges_[lower], &b = edges_[upper];
        if (a.last_vertex == b.last_vertex) return true;
        return is_swept_before(a.last, b.last) ? above(upper, a.last) < 0.0
                                               : above(lower, b.last) > 0.0;
    }

    std::vector<SweptEdge> edges_;
    std::vector<std::int32_t> line_, starting_;
};

}  // namespace

bool is_simple_rim(std::span<const RimEdge> edges) { return RimSweep(edges).is_simple(); }

}  // namespace surfmesh
