#include "edges/mated_cuts.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <vector>

#include "edges/metric_lengths.hpp"
#include "edges/rim_sags.hpp"
#include "values/interpolation.hpp"

namespace surfmesh {
namespace {

constexpr int SWEEPS = 6;  // how often feet of new nodes are looked for, and segments halved

// A node that lies off the foot by less than this fraction of the size there is the mate itself;
// on bent edges by less than this part of the gap over the turn of a segment: chords would cross.
constexpr double SAME_SIZE = 0.3, SAME_GAP = 0.5;

constexpr double LEAST_TURN = 1e-3;  // radians: edges that turn less from node to node are straight
constexpr double COINCIDENT = 1e-12;  // of the diagonal: edges nearer all along have no mates
constexpr double NEAREST = 1e-9;      // of a length, or of the diagonal: places that are the same
constexpr double FARTHER = 2.0;       // times the gap of the run: a foot of another part

/// An edge while it is cut.
struct CutEdge {
    std::int64_t edge;
    Array<double> t, length;  // nodes; how far along the polygon each of its samples is
    std::vector<std::size_t> runs;
};

class Mating {
  public:
    Mating(const SampledCurves& samples, const MateRuns& runs, const MatedEdges& edges,
           std::span<const double> sizes)
        : samples_(samples),
          runs_(runs),
          edges_(edges),
          sizes_(sizes),
          row_(edges.ends.size(), NO_ROW),
          seen_(runs.size(), 0) {
        for (std::size_t run = 0; run < runs.size(); ++run) {
            const auto gaps = runs.of(runs.gap, run);
            if (*std::max_element(gaps.begin(), gaps.end()) <= COINCIDENT * edges.diagonal)
                continue;  // feet would be told apart by rounding alone, without end
            own(runs.edge.data()[run]).runs.push_back(run);
            own(runs.mate.data()[run]);
        }
    }

    MatedCuts cuts() {
        spread();  // the feet of vertices
        std::vector<std::uint8_t> is_done(cut_.size(), 0);
        for (const std::size_t start : longest_first()) {
            std::deque<std::size_t> queue{start};
            while (!queue.empty()) {
                const std::size_t k = queue.front();
                queue.pop_front();
                if (is_done[k]) continue;
                is_done[k] = 1;
                subdivide(cut_[k]);
                for (const std::size_t run : cut_[k].runs) {
                    const std::size_t mate = row_[static_cast<std::size_t>(runs_.mate.data()[run])];
                    if (is_done[mate]) continue;
                    add_feet(run);
                    queue.push_back(mate);
                }
            }
        }
        spread();
        return collected();
    }

  private:
    static constexpr std::size_t NO_ROW = std::numeric_limits<std::size_t>::max();

    CutEdge& own(std::int64_t edge) {
        std::size_t& row = row_[static_cast<std::size_t>(edge)];
        if (row == NO_ROW) {
            row = cut_.size();
            CutEdge cut{edge, {}, {}, {}};
            cut.t.push_back(0.0);
            cut.t.push_back(1.0);
            cut.length.push_back(0.0);
            const auto points = samples_.of(samples_.points, edge);
            for (std::size_t i = 0; i + 1 < points.size(); ++i)
                cut.length.push_back(cut.length.back() + norm(points[i + 1] - points[i]));
            cut_.push_back(std::move(cut));
        }
        return cut_[row];
    }

    std::vector<std::size_t> longest_first() const {
        std::vector<std::size_t> order(cut_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            const double one = edges_.length[cut_[a].edge], other = edges_.length[cut_[b].edge];
            return one != other ? one > other : cut_[a].edge < cut_[b].edge;
        });
        return order;
    }

    void spread() {
        for (int sweep = 0; sweep < SWEEPS; ++sweep) {
            std::size_t added = 0;
            for (const CutEdge& cut : cut_)
                for (const std::size_t run : cut.runs) added += add_feet(run);
            if (added == 0) break;
        }
    }

    /// Is a node of an edge a vertex that the mate has too? It is its own foot, however far from
    /// the vertex its curves end.
    bool is_node_of_mate(std::size_t run, double t) const {
        const SegmentEnds one = edges_.ends[runs_.edge.data()[run]],
                          other = edges_.ends[runs_.mate.data()[run]];
        const auto has = [&](std::int64_t vertex) {
            return vertex == other.start || vertex == other.end;
        };
        return (t == 0.0 && has(one.start)) || (t == 1.0 && has(one.end));
    }

    /// The nodes of the edge of a run that may have feet on its mate.
    void find_nodes_beside(std::size_t run, const CutEdge& cut) {
        const auto t = runs_.of(runs_.t, run);
        double reach = 0.0;
        for (std::size_t i = 0; i + 1 < t.size(); ++i) reach = std::max(reach, t[i + 1] - t[i]);
        reach *= 0.5;
        nodes_.clear();
        for (const double node : cut.t)
            if (node >= t.front() - reach && node <= t.back() + reach &&
                !is_node_of_mate(run, node))
                nodes_.push_back(node);
    }

    void find_points(std::int64_t edge) {
        const CurvePieces& curves = samples_.curves;
        const double t0 = curves.t0[edge], range = curves.t1[edge] - t0;
        parameters_.clear();
        for (const double t : nodes_) parameters_.push_back(t0 + t * range);
        points_.resize(nodes_.size());
        curves.curves[static_cast<std::size_t>(edge)]->evaluate(parameters_, 0, points_);
        const SegmentEnds ends = edges_.vertices[edge];
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            if (nodes_.data()[i] == 0.0) points_.data()[i] = edges_.corners[ends.start];
            if (nodes_.data()[i] == 1.0) points_.data()[i] = edges_.corners[ends.end];
        }
    }

    /// Cut the mate of a run where nodes of the edge have their feet; how many are new.
    std::size_t add_feet(std::size_t run) {
        const CutEdge& cut = own(runs_.edge.data()[run]);
        if (seen_[run] == cut.t.size()) return 0;
        seen_[run] = cut.t.size();
        find_nodes_beside(run, cut);
        if (nodes_.empty()) return 0;
        find_points(cut.edge);
        const Interpolation foot_at(runs_.of(runs_.t, run), runs_.of(runs_.foot, run));
        const Interpolation gap_at(runs_.of(runs_.t, run), runs_.of(runs_.gap, run));
        foot_.clear();
        for (const double node : nodes_) foot_.push_back(foot_at(node));
        away_.resize(nodes_.size());
        CutEdge& mate = own(runs_.mate.data()[run]);
        feet_on_edge(samples_.curves, mate.edge, points_, foot_, away_);
        const auto t = samples_.of(samples_.t, mate.edge);
        const Interpolation along(t, mate.length);
        added_.clear();
        const std::size_t before = mate.t.size();
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const double foot = foot_.data()[i], away = away_.data()[i];
            if (!(away <= FARTHER * gap_at(nodes_.data()[i]) + NEAREST * edges_.diagonal)) continue;
            const auto after = std::lower_bound(mate.t.begin(), mate.t.begin() + before, foot);
            const std::size_t right = std::clamp<std::size_t>(
                static_cast<std::size_t>(after - mate.t.begin()), 1, before - 1);
            const double place = along(foot), same = same_within(mate, foot, away);
            const double near = std::min(std::abs(place - along(mate.t.data()[right - 1])),
                                         std::abs(place - along(mate.t.data()[right])));
            if (!(near > same) || std::any_of(added_.begin(), added_.end(), [&](double other) {
                    return !(std::abs(place - other) > same);
                }))
                continue;
            added_.push_back(place);
            mate.t.push_back(foot);
        }
        make_rising(mate.t);
        return added_.size();
    }

    /// How near to its foot a node is the mate itself, where the gap is ``away``.
    double same_within(const CutEdge& mate, double foot, double away) const {
        const Interpolation size_at(samples_.of(samples_.t, mate.edge),
                                    samples_.of(sizes_, mate.edge));
        const double size = size_at(foot);
        const double length =
            std::max(edges_.length[mate.edge], std::numeric_limits<double>::min());
        const double turn =
            std::max(edges_.total_curvature[mate.edge] * std::min(size / length, 1.0), LEAST_TURN);
        return std::max(std::min(SAME_SIZE * size, SAME_GAP * away / turn), NEAREST * length);
    }

    static void make_rising(Array<double>& t) {
        std::sort(t.begin(), t.end());
        t.resize(static_cast<std::size_t>(std::unique(t.begin(), t.end()) - t.begin()));
    }

    /// More nodes between those that there are, in pieces of metric length near 1.
    void subdivide(CutEdge& cut) {
        metric_lengths(samples_.of(samples_.points, cut.edge), samples_.of(sizes_, cut.edge),
                       metric_);
        const std::span<const double> metric(metric_.data(), metric_.size());
        const auto t = samples_.of(samples_.t, cut.edge);
        const Interpolation metric_at(t, metric), t_at(metric, t);
        const std::size_t gaps = cut.t.size() - 1;
        std::vector<double> ends, pieces;
        for (const double node : cut.t) ends.push_back(metric_at(node));
        double all = 0.0;
        const double most = edges_.most + 1.0;
        for (std::size_t i = 0; i < gaps; ++i) {
            pieces.push_back(std::clamp(std::nearbyint(ends[i + 1] - ends[i]), 1.0, most));
            all += pieces.back();
        }
        for (; all < static_cast<double>(edges_.fewest[cut.edge]); all += 1.0) {
            std::size_t longest = 0;
            for (std::size_t i = 1; i < gaps; ++i)
                if ((ends[i + 1] - ends[i]) / pieces[i] >
                    (ends[longest + 1] - ends[longest]) / pieces[longest])
                    longest = i;
            pieces[longest] += 1.0;
        }
        for (std::size_t i = 0; i < gaps; ++i)
            for (double k = 1.0; k < pieces[i]; k += 1.0)
                cut.t.push_back(t_at(ends[i] + (ends[i + 1] - ends[i]) * k / pieces[i]));
        make_rising(cut.t);
        keep_to_chord(cut);
    }

    /// One more node in the middle of each segment that sags by more than the chord: feet divide
    /// an edge at will, so that some segments are half as long again as wanted.
    void keep_to_chord(CutEdge& cut) {
        const double chord = edges_.chord[cut.edge], shortest = edges_.shortest[cut.edge];
        if (!std::isfinite(chord)) return;
        RimSags sags;
        for (int sweep = 0; sweep < SWEEPS; ++sweep) {
            const std::size_t before = cut.t.size();
            rim_sags(samples_.curves, cut.edge, {cut.t.data(), before}, sags);
            for (std::size_t i = 0; i + 1 < before; ++i)
                if (sags.sag.data()[i] > chord && sags.length.data()[i] > shortest)
                    cut.t.push_back(0.5 * (cut.t.data()[i] + cut.t.data()[i + 1]));
            if (cut.t.size() == before) break;
            std::sort(cut.t.begin(), cut.t.end());
        }
    }

    MatedCuts collected() const {
        MatedCuts found;
        found.first.push_back(0);
        for (const CutEdge& cut : cut_) {
            found.edge.push_back(cut.edge);
            for (const double t : cut.t) found.t.push_back(t);
            found.first.push_back(static_cast<std::int64_t>(found.t.size()));
        }
        return found;
    }

    const SampledCurves& samples_;
    const MateRuns& runs_;
    const MatedEdges& edges_;
    std::span<const double> sizes_;
    std::deque<CutEdge> cut_;        // in the order in which runs name them
    std::vector<std::size_t> row_;   // of each edge of the model, if it is cut here
    std::vector<std::size_t> seen_;  // nodes of the edge when feet of a run were looked for
    Array<double> nodes_, parameters_, foot_, away_, added_, metric_;
    Array<Point3> points_;
};

}  // namespace

MatedCuts mated_cuts(const SampledCurves& samples, const MateRuns& runs, const MatedEdges& edges,
                     std::span<const double> sizes) {
    return Mating(samples, runs, edges, sizes).cuts();
}

}  // namespace surfmesh
