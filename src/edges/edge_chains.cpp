#include "edges/edge_chains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace surfmesh {
namespace {

constexpr double TIE = 1e-6;   // relative difference of squared distances that is none
constexpr int FOOT_STEPS = 4;  // of Newton's method, to the closest point of a curve
constexpr double LEAST = std::numeric_limits<double>::min();  // of a squared length

/// The closest segments of a chain to points, and how far along these, 0 to 1, the points are.
class PolygonFeet {
  public:
    explicit PolygonFeet(const EdgeChain& chain)
        : chain_(chain),
          way_(chain.segments()),
          square_(chain.segments()),
          ratio_(way_.size()),
          near_(way_.size()) {
        for (std::size_t i = 0; i < chain.segments(); ++i) {
            way_.data()[i] = chain.points.data()[i + 1] - chain.points.data()[i];
            square_.data()[i] = std::max(dot(way_.data()[i], way_.data()[i]), LEAST);
        }
        longest_ = *std::max_element(square_.begin(), square_.end());
    }

    /// about: where on the chain, 0 to 1, the closest of several segments is to be.
    std::size_t closest(Point3 p, double about, double& along) {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < way_.size(); ++i) {
            const Point3 way = way_.data()[i], off = p - chain_.points.data()[i];
            const double t = std::clamp(dot(off, way) / square_.data()[i], 0.0, 1.0);
            const Point3 rest = off - t * way;
            ratio_.data()[i] = t;
            near_.data()[i] = dot(rest, rest);
            least = std::min(least, near_.data()[i]);
        }
        const double most = least * (1.0 + TIE) + TIE * TIE * longest_;
        std::size_t found = 0;
        double apart = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < way_.size(); ++i) {
            if (!(near_.data()[i] <= most)) continue;
            const double middle = (static_cast<double>(i) + 0.5) / static_cast<double>(way_.size());
            const double away = std::abs(middle - about);
            if (away < apart) {
                apart = away;
                found = i;
            }
        }
        along = ratio_.data()[found];
        return found;
    }

  private:
    const EdgeChain& chain_;
    Array<Point3> way_;
    Array<double> square_, ratio_, near_;
    double longest_;
};

}  // namespace

EdgeChain chain_of(const SampledEdges& edges, std::span<const DirectedEdge> which,
                   std::int64_t place) {
    EdgeChain chain;
    Point3 last{};
    for (const auto [edge, is_reversed] : which) {
        const std::size_t count = edges.count(edge);
        const auto points = edges.of(edges.points, edge);
        const auto t = edges.of(edges.t, edge);
        const auto at = [&](std::size_t i) { return is_reversed ? count - 1 - i : i; };
        for (std::size_t i = 0; i + 1 < count; ++i) {
            chain.points.push_back(points[at(i)]);
            chain.place.push_back(place);
            chain.edge.push_back(edge);
            chain.t.push_back(t[at(i)]);
            chain.t_end.push_back(t[at(i + 1)]);
        }
        if (count > 0) last = points[at(count - 1)];
        ++place;
    }
    if (!chain.points.empty()) chain.points.push_back(last);
    return chain;
}

void feet_on_chain(const CurvePieces& curves, std::span<const Point3> points,
                   const EdgeChain& chain, ChainFeet& found) {
    const std::size_t count = points.size();
    PolygonFeet polygon(chain);
    found.segment.resize(count);
    found.t.resize(count);
    found.distance.resize(count);
    const double step = count > 1 ? -1.0 / static_cast<double>(count - 1) : 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double about = i > 0 && i + 1 == count ? 0.0 : static_cast<double>(i) * step + 1.0;
        double along = 0.0;
        const std::size_t k = polygon.closest(points[i], about, along);
        found.segment.data()[i] = static_cast<std::int64_t>(k);
        found.t.data()[i] = (1.0 - along) * chain.t.data()[k] + along * chain.t_end.data()[k];
    }
    const auto edge_of = [&](std::size_t i) { return chain.edge[found.segment.data()[i]]; };
    for (std::size_t from = 0, to = 0; from < count; from = to) {  // points of the same edge
        while (to < count && edge_of(to) == edge_of(from)) ++to;
        feet_on_edge(curves, edge_of(from), points.subspan(from, to - from),
                     {found.t.data() + from, to - from}, {found.distance.data() + from, to - from});
    }
}

void feet_on_edge(const CurvePieces& curves, std::int64_t edge, std::span<const Point3> points,
                  std::span<double> t, std::span<double> distance) {
    const Curve& curve = *curves.curves[static_cast<std::size_t>(edge)];
    const double t0 = curves.t0[edge], range = curves.t1[edge] - t0;
    const std::size_t count = points.size();
    Array<double> parameter(count), trial(count);
    Array<Point3> here(2 * count), there(2 * count);
    const auto evaluate = [&](std::span<const double> fraction, Array<Point3>& out) {
        for (std::size_t i = 0; i < count; ++i) parameter.data()[i] = t0 + fraction[i] * range;
        curve.evaluate({parameter.data(), count}, 1, {out.data(), out.size()});
    };
    for (double& guess : t) guess = std::clamp(guess, 0.0, 1.0);
    evaluate(t, here);
    for (std::size_t i = 0; i < count; ++i) distance[i] = norm(here.data()[i] - points[i]);
    for (int round = 0; round < FOOT_STEPS; ++round) {
        for (std::size_t i = 0; i < count; ++i) {
            const Point3 speed = range * here.data()[count + i];
            const double square = std::max(dot(speed, speed), LEAST);
            const double step = dot(points[i] - here.data()[i], speed) / square;
            trial.data()[i] = std::clamp(t[i] + step, 0.0, 1.0);
        }
        evaluate({trial.data(), count}, there);
        bool is_better = false;
        for (std::size_t i = 0; i < count; ++i) {
            const double now = norm(there.data()[i] - points[i]);
            if (!(now < distance[i])) continue;
            is_better = true;
            t[i] = trial.data()[i];
            distance[i] = now;
            here.data()[i] = there.data()[i];
            here.data()[count + i] = there.data()[count + i];
        }
        if (!is_better) break;
    }
}

}  // namespace surfmesh
