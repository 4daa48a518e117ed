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

class Gradation {
  public:
    Gradation(const EdgeNetwork& edges, std::span<const double> sizes, double slope,
              double least_step)
        : edges_(edges), slope_(slope), way_(sizes.size()), step_(sizes.size()) {
        for_each_block(sizes.size(), SAMPLES_TOGETHER, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) way_.data()[i] = sizes[i] / slope;
            for (std::size_t i = begin; i < end && i + 1 < sizes.size(); ++i)
                step_.data()[i] = std::max(norm(edges.points[i + 1] - edges.points[i]), least_step);
        });
    }

    Array<double> sizes() {
        link_vertices();
        for_each_block(edges_.ends.size(), EDGES_TOGETHER, [&](std::size_t from, std::size_t to) {
            for (std::size_t e = from; e < to; ++e) sweep_both_ways(e);
        });
        for (std::size_t e = 0; e < edges_.ends.size(); ++e) lower_vertices(e);
        for (std::size_t v = 0; v < edges_.vertices; ++v) queue_.push({at_vertex_[v], v});
        while (!queue_.empty()) {
            const auto [way, vertex] = queue_.top();
            queue_.pop();
            if (way > at_vertex_[vertex]) continue;  // it was lowered since
            for (std::int64_t k = first_use_[vertex]; k < first_use_[vertex + 1]; ++k)
                grow_from(uses_[k], way);
        }
        for (double& way : way_) way = slope_ * way;
        return std::move(way_);
    }

  private:
    struct End {
        std::size_t edge;
        bool at_start;
    };
    using Entry = std::tuple<double, std::size_t>;  // (way, vertex)

    [[nodiscard]] std::int64_t first(std::size_t e) const { return edges_.first[e]; }
    [[nodiscard]] std::int64_t last(std::size_t e) const { return edges_.first[e + 1] - 1; }
    [[nodiscard]] bool is_empty(std::size_t e) const { return last(e) < first(e); }

    /// The ends of edges at each vertex, in one row.
    void link_vertices() {
        at_vertex_.resize(edges_.vertices, INFINITE);
        first_use_.resize(edges_.vertices + 1, 0);
        const auto count = [&](std::int64_t v) { ++first_use_[v + 1]; };
        for (std::size_t e = 0; e < edges_.ends.size(); ++e)
            if (!is_empty(e)) count(edges_.ends[e].start), count(edges_.ends[e].end);
        for (std::size_t v = 0; v < edges_.vertices; ++v) first_use_[v + 1] += first_use_[v];
        uses_.resize(static_cast<std::size_t>(first_use_.back()));
        Array<std::int64_t> next = first_use_;
        for (std::size_t e = 0; e < edges_.ends.size(); ++e) {
            if (is_empty(e)) continue;
            uses_[next[edges_.ends[e].start]++] = {e, true};
            uses_[next[edges_.ends[e].end]++] = {e, false};
        }
    }

    /// Lower what lies beside along one edge.
    void sweep_both_ways(std::size_t e) {
        if (is_empty(e)) return;
        for (std::int64_t i = first(e); i < last(e); ++i)
            way_[i + 1] = std::min(way_[i + 1], way_[i] + step_[i]);
        for (std::int64_t i = last(e); i > first(e); --i)
            way_[i - 1] = std::min(way_[i - 1], way_[i] + step_[i - 1]);
    }

    /// Lower the vertices of an edge to its ends.
    void lower_vertices(std::size_t e) {
        if (is_empty(e)) return;
        double& start = at_vertex_[edges_.ends[e].start];
        start = std::min(start, way_[first(e)]);
        double& end = at_vertex_[edges_.ends[e].end];
        end = std::min(end, way_[last(e)]);
    }

    /// Lower what lies along an edge from one of its ends on, as far as that is of any use.
    void grow_from(End end, double way) {
        const std::int64_t from = end.at_start ? first(end.edge) : last(end.edge);
        const std::int64_t to = end.at_start ? last(end.edge) : first(end.edge);
        const std::int64_t onward = end.at_start ? 1 : -1;
        way_[from] = std::min(way_[from], way);
        for (std::int64_t i = from; i != to; i += onward) {
            const double found = way_[i] + step_[end.at_start ? i : i - 1];
            if (!(found < way_[i + onward])) return;
            way_[i + onward] = found;
        }
        const SegmentEnds ends = edges_.ends[end.edge];
        const std::int64_t other = end.at_start ? ends.end : ends.start;
        if (way_[to] < at_vertex_[other]) {
            at_vertex_[other] = way_[to];
            queue_.push({way_[to], static_cast<std::size_t>(other)});
        }
    }

    const EdgeNetwork& edges_;
    double slope_;
    Array<double> way_, step_;  // of the samples; step to the next one
    Array<double> at_vertex_;
    Array<std::int64_t> first_use_;
    std::vector<End> uses_;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace

Array<double> graded_along_edges(const EdgeNetwork& edges, std::span<const double> sizes,
                                 double slope, double least_step) {
    return Gradation(edges, sizes, slope, least_step).sizes();
}

}  // namespace surfmesh
