#include "edges/edge_mates.hpp"

#include <algorithm>
#include <numeric>

#include "values/interpolation.hpp"
#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t PAIRS_AT_ONCE = 8;

/// The runs along one chain, for one chain after the other.
class RunSearch {
  public:
    RunSearch(const CurvePieces& curves, const EdgeChain& other, double width, std::size_t fewest,
              MateRuns& found)
        : other_(other),
          on_other_(curves, {other, 0, other.segments()}),
          width_(width),
          fewest_(fewest),
          found_(found) {}

    /// Of one edge of a chain, the segments from ``from`` to ``to``.
    void add(const EdgeChain& own, std::size_t from, std::size_t to) {
        const std::int64_t edge = own.edge.data()[from];
        const std::size_t count = to - from + 1;
        on_other_.feet({own.points.data() + from, count}, feet_);
        t_.clear();
        mate_.clear();
        is_near_.clear();
        for (std::size_t i = 0; i < count; ++i) {
            t_.push_back(i + 1 < count ? own.t.data()[from + i] : own.t_end.data()[to - 1]);
            mate_.push_back(other_.edge[feet_.segment.data()[i]]);
            is_near_.push_back(feet_.distance.data()[i] <= width_ && mate_.back() != edge);
        }
        for (std::size_t first = 0, last = 0; first < count; first = last) {
            while (last < count && mate_.data()[last] == mate_.data()[first] &&
                   is_near_.data()[last] == is_near_.data()[first])
                ++last;
            if (is_near_.data()[first] && last - first >= fewest_) keep(edge, first, last);
        }
    }

  private:
    /// A run, its samples in the order of the edge's parameter.
    void keep(std::int64_t edge, std::size_t first, std::size_t last) {
        order_.resize(last - first);
        std::iota(order_.begin(), order_.end(), first);
        std::stable_sort(order_.begin(), order_.end(),
                         [&](std::size_t a, std::size_t b) { return t_.data()[a] < t_.data()[b]; });
        for (const std::size_t i : order_) {
            found_.t.push_back(t_.data()[i]);
            found_.foot.push_back(feet_.t.data()[i]);
            found_.gap.push_back(feet_.distance.data()[i]);
        }
        found_.edge.push_back(edge);
        found_.mate.push_back(mate_.data()[first]);
        found_.first.push_back(static_cast<std::int64_t>(found_.t.size()));
    }

    const EdgeChain& other_;
    FootFinder on_other_;
    double width_;
    std::size_t fewest_;
    MateRuns& found_;
    ChainFeet feet_;
    Array<double> t_;
    Array<std::int64_t> mate_;
    Array<std::uint8_t> is_near_;
    std::vector<std::size_t> order_;
};

MateRuns runs_of_pair(const SampledCurves& edges, const SideBySide& pairs, std::size_t pair) {
    MateRuns found;
    const auto chain = [&](std::int64_t k) {
        const auto start = static_cast<std::size_t>(pairs.first[k]);
        return chain_of(
            edges, pairs.uses.subspan(start, static_cast<std::size_t>(pairs.first[k + 1]) - start));
    };
    const EdgeChain own = chain(pairs.own[pair]), other = chain(pairs.other[pair]);
    if (own.segments() == 0 || other.segments() == 0) return found;
    RunSearch search(edges.curves, other, pairs.width[pair], pairs.fewest, found);
    for (std::size_t from = 0, to = 0; from < own.segments(); from = to) {
        while (to < own.segments() && own.place.data()[to] == own.place.data()[from]) ++to;
        search.add(own, from, to);
    }
    return found;
}

template <class T>
void append(Array<T>& all, const Array<T>& some) {
    for (const T value : some) all.push_back(value);
}

}  // namespace

MateRuns mate_runs(const SampledCurves& edges, const SideBySide& pairs) {
    std::vector<MateRuns> of_pair(pairs.own.size());
    for_each_block(of_pair.size(), PAIRS_AT_ONCE, [&](std::size_t from, std::size_t to) {
        for (std::size_t pair = from; pair < to; ++pair)
            of_pair[pair] = runs_of_pair(edges, pairs, pair);
    });
    MateRuns all;
    all.first.push_back(0);
    for (const MateRuns& some : of_pair) {
        const auto before = static_cast<std::int64_t>(all.t.size());
        append(all.edge, some.edge);
        append(all.mate, some.mate);
        for (const std::int64_t end : some.first) all.first.push_back(before + end);
        append(all.t, some.t);
        append(all.foot, some.foot);
        append(all.gap, some.gap);
    }
    return all;
}

Array<double> lowered_to_mates(const SampleRows& samples, const MateRuns& runs,
                               std::span<const double> sizes) {
    Array<double> lowered(sizes), found;
    const std::span<double> all(lowered.data(), lowered.size());
    for (std::size_t run = 0; run < runs.size(); ++run) {
        const std::int64_t edge = runs.edge.data()[run], mate = runs.mate.data()[run];
        const Interpolation size(samples.of(samples.t, mate), samples.of(all, mate));
        found.clear();
        for (const double foot : runs.of(runs.foot, run)) found.push_back(size(foot));
        const std::span<const double> own = samples.of(samples.t, edge);
        const std::span<double> of_edge = samples.of(all, edge);
        std::size_t i = 0;
        for (const double t : runs.of(runs.t, run)) {
            const auto at = std::lower_bound(own.begin(), own.end(), t) - own.begin();
            const auto row = std::min(static_cast<std::size_t>(at), own.size() - 1);
            of_edge[row] = std::min(of_edge[row], found.data()[i++]);
        }
    }
    return lowered;
}

}  // namespace surfmesh
