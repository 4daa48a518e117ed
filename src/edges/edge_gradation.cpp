#include "edges/edge_gradation.hpp"

#include <algorithm>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t EDGES_TOGETHER = 256, SAMPLES_TOGETHER = 1 << 15;
constexpr double INFINITE = std::numeric_limits<double>::infinity();

}  // namespace

EdgeGradation::EdgeGradation(const EdgeNetwork& edges, double slope, double least_step)
    : edges_(edges), slope_(slope), step_(edges.points.size()) {
    const std::size_t count = step_.size();
    for_each_block(count, SAMPLES_TOGETHER, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && i + 1 < count; ++i)
            step_.data()[i] = std::max(norm(edges.points[i + 1] - edges.points[i]), least_step);
    });
    link_vertices();
}

/// The ends of edges at each vertex, in one row.
void EdgeGradation::link_vertices() {
    first_use_.resize(edges_.vertices + 1, 0);
    const auto count = [&](std::int64_t v) { ++first_use_[v + 1]; };
    for (std::size_t e = 0; e < edges_.ends.size(); ++e)
        if (!is_empty(e)) count(edges_.ends[e].start), count(edges_.ends[e].end);
    for (std::size_t v = 0; v < edges_.vertices; ++v)
        first_use_.data()[v + 1] += first_use_.data()[v];
    uses_.resize(static_cast<std::size_t>(first_use_.back()));
    Array<std::int64_t> next = first_use_;
    for (std::size_t e = 0; e < edges_.ends.size(); ++e) {
        if (is_empty(e)) continue;
        uses_[static_cast<std::size_t>(next[edges_.ends[e].start]++)] = {e, true};
        uses_[static_cast<std::size_t>(next[edges_.ends[e].end]++)] = {e, false};
    }
}

/// Sizes as ways from where they would be nothing.
class EdgeGradation::Spreading {
  public:
    Spreading(const EdgeGradation& of, std::span<const double> sizes)
        : of_(of), way_(sizes.size()), at_vertex_(of.edges_.vertices, INFINITE) {
        for_each_sample([&](std::size_t i) { way_.data()[i] = sizes[i] / of.slope_; });
    }

    Array<double> sizes() {
        const std::size_t count = of_.edges_.ends.size();
        for_each_block(count, EDGES_TOGETHER, [&](std::size_t from, std::size_t to) {
            for (std::size_t e = from; e < to; ++e) sweep_both_ways(e);
        });
        for (std::size_t e = 0; e < count; ++e) lower_vertices(e);
        for (std::size_t v = 0; v < at_vertex_.size(); ++v) queue_.push({at_vertex_.data()[v], v});
        while (!queue_.empty()) {
            const auto [way, vertex] = queue_.top();
            queue_.pop();
            if (way > at_vertex_.data()[vertex]) continue;  // it was lowered since
            const Array<std::int64_t>& first = of_.first_use_;
            for (std::int64_t k = first.data()[vertex]; k < first.data()[vertex + 1]; ++k)
                grow_from(of_.uses_[static_cast<std::size_t>(k)], way);
        }
        for_each_sample([&](std::size_t i) { way_.data()[i] = of_.slope_ * way_.data()[i]; });
        return std::move(way_);
    }

  private:
    using Entry = std::tuple<double, std::size_t>;  // (way, vertex)

    template <class Work>
    void for_each_sample(const Work& work) const {
        for_each_block(way_.size(), SAMPLES_TOGETHER, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) work(i);
        });
    }

    /// Lower what lies beside along one edge.
    void sweep_both_ways(std::size_t e) {
        if (of_.is_empty(e)) return;
        const std::int64_t first = of_.first(e), last = of_.last(e);
        for (std::int64_t i = first; i < last; ++i)
            way_[i + 1] = std::min(way_[i + 1], way_[i] + of_.step_[i]);
        for (std::int64_t i = last; i > first; --i)
            way_[i - 1] = std::min(way_[i - 1], way_[i] + of_.step_[i - 1]);
    }

    /// Lower the vertices of an edge to its ends.
    void lower_vertices(std::size_t e) {
        if (of_.is_empty(e)) return;
        double& start = at_vertex_[of_.edges_.ends[e].start];
        start = std::min(start, way_[of_.first(e)]);
        double& end = at_vertex_[of_.edges_.ends[e].end];
        end = std::min(end, way_[of_.last(e)]);
    }

    /// Lower what lies along an edge from one of its ends on, as far as that is of any use.
    void grow_from(End end, double way) {
        const std::int64_t first = of_.first(end.edge), last = of_.last(end.edge);
        const std::int64_t from = end.at_start ? first : last;
        const std::int64_t to = end.at_start ? last : first;
        const std::int64_t onward = end.at_start ? 1 : -1;
        way_[from] = std::min(way_[from], way);
        for (std::int64_t i = from; i != to; i += onward) {
            const double found = way_[i] + of_.step_[end.at_start ? i : i - 1];
            if (!(found < way_[i + onward])) return;
            way_[i + onward] = found;
        }
        const SegmentEnds ends = of_.edges_.ends[end.edge];
        const std::int64_t other = end.at_start ? ends.end : ends.start;
        if (way_[to] < at_vertex_[other]) {
            at_vertex_[other] = way_[to];
            queue_.push({way_[to], static_cast<std::size_t>(other)});
        }
    }

    const EdgeGradation& of_;
    Array<double> way_;  // of the samples
    Array<double> at_vertex_;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

Array<double> EdgeGradation::graded(std::span<const double> sizes) const {
    return Spreading(*this, sizes).sizes();
}

Array<double> graded_along_edges(const EdgeNetwork& edges, std::span<const double> sizes,
                                 double slope, double least_step) {
    return EdgeGradation(edges, slope, least_step).graded(sizes);
}

}  // namespace surfmesh
