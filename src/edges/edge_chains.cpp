#include "edges/edge_chains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace surfmesh {
namespace {

constexpr double TIE = 1e-6;   // relative difference of squared distances that is none
constexpr int FOOT_STEPS = 4;  // of Newton's method, to the closest point of a curve
constexpr double LEAST = std::numeric_limits<double>::min();  // of a squared length

}  // namespace

EdgeChain chain_of(const SampledCurves& edges, std::span<const DirectedEdge> which) {
    EdgeChain chain;
    Point3 last{};
    std::int64_t place = 0;
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
            const Point3 way = points[at(i + 1)] - points[at(i)];
            chain.way.push_back(way);
            chain.square.push_back(std::max(dot(way, way), LEAST));
        }
        if (count > 0) last = points[at(count - 1)];
        ++place;
    }
    if (chain.points.empty()) return chain;
    chain.points.push_back(last);
    return chain;
}

FootFinder::FootFinder(const CurvePieces& curves, const ChainPart& part)
    : curves_(curves),
      part_(part),
      ratio_(part.segments()),
      near_(part.segments()),
      longest_(*std::max_element(part.chain.square.begin() + part.first,
                                 part.chain.square.begin() + part.last)) {}

/// The place on the polygon of the samples that is closest to a point.
FootFinder::Place FootFinder::on_polygon(Point3 p, double about) {
    const EdgeChain& chain = part_.chain;
    const std::size_t count = part_.segments();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t k = part_.first + i;
        const Point3 way = chain.way.data()[k], off = p - chain.points.data()[k];
        const double t = std::clamp(dot(off, way) / chain.square.data()[k], 0.0, 1.0);
        const Point3 rest = off - t * way;
        ratio_.data()[i] = t;
        near_.data()[i] = dot(rest, rest);
        least = std::min(least, near_.data()[i]);
    }
    const double most = least * (1.0 + TIE) + TIE * TIE * longest_;
    std::size_t found = 0;
    double apart = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count; ++i) {
        if (!(near_.data()[i] <= most)) continue;
        const double middle = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
        const double away = std::abs(middle - about);
        if (away < apart) {
            apart = away;
            found = i;
        }
    }
    const double along = ratio_.data()[found];
    const std::size_t k = part_.first + found;
    return {static_cast<std::int64_t>(k),
            (1.0 - along) * chain.t.data()[k] + along * chain.t_end.data()[k]};
}

double FootFinder::distance(Point3 p, double about) {
    Place place = on_polygon(p, about);
    double found = 0.0;
    feet_on_edge(curves_, part_.chain.edge[place.segment], {&p, 1}, {&place.t, 1}, {&found, 1});
    return found;
}

void FootFinder::feet(std::span<const Point3> points, ChainFeet& found) {
    const std::size_t count = points.size();
    found.segment.resize(count);
    found.t.resize(count);
    found.distance.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Place place = on_polygon(points[i], place_along(i, count));
        found.segment.data()[i] = place.segment;
        found.t.data()[i] = place.t;
    }
    const auto edge_of = [&](std::size_t i) { return part_.chain.edge[found.segment.data()[i]]; };
    for (std::size_t from = 0, to = 0; from < count; from = to) {  // points of the same edge
        while (to < count && edge_of(to) == edge_of(from)) ++to;
        feet_on_edge(curves_, edge_of(from), points.subspan(from, to - from),
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
        curve.evaluate({parameter.data(), count}, 1, out);
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
