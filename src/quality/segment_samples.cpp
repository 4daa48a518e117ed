#include "quality/segment_samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "surfaces/elementary_curves.hpp"

namespace surfmesh {
namespace {

constexpr double ON_LINE = 1e-9;  // of the length: no point of a line is farther from the segment

class Sampling {
  public:
    Sampling(const EdgeSegments& all, std::span<const double> fractions, double on_curve)
        : all_(all), fractions_(fractions), on_curve_(on_curve) {}

    /// Segments first to end, of one edge.
    void look_along(std::size_t first, std::size_t end) {
        const Curve* curve = all_.curves[all_.edges[first]];
        if (curve == nullptr) return;
        const bool is_straight = dynamic_cast<const Line*>(curve) != nullptr;
        find_near(*curve, first, end, is_straight ? ON_LINE : -1.0);
        add_between(*curve);
        const auto* conic = dynamic_cast<const Conic*>(curve);
        add_arcs(conic != nullptr && conic->kind() == ConicKind::ELLIPSE);
    }
    SegmentSamples found() { return std::move(found_); }

  private:
    [[nodiscard]] double parameter(std::size_t segment, double fraction) const {
        const auto [t0, t1] = all_.limits[all_.edges[segment]];
        const auto [start, end] = all_.ends[segment];
        return t0 + (start + fraction * (end - start)) * (t1 - t0);
    }

    /// The segments whose nodes are near the curve, but not as near as ``nearest``, of the length.
    void find_near(const Curve& curve, std::size_t first, std::size_t end, double nearest) {
        t_.clear();
        for (std::size_t k = first; k < end; ++k)
            for (const double fraction : {0.0, 1.0}) t_.push_back(parameter(k, fraction));
        const CurveValues at(curve, {t_.data(), t_.size()}, 0);
        near_.clear();
        off_.clear();
        for (std::size_t k = first; k < end; ++k) {
            const Point3 a = all_.points[all_.nodes[k][0]], b = all_.points[all_.nodes[k][1]];
            const std::size_t row = 2 * (k - first);
            const double start = norm(at[0][row] - a), finish = norm(at[0][row + 1] - b);
            const double length = norm(b - a);
            const auto are_within = [&](double part) {
                return start <= part * length && finish <= part * length;
            };
            if (!are_within(on_curve_) || are_within(nearest)) continue;
            near_.push_back(static_cast<std::int32_t>(k));
            off_.push_back(std::max(start, finish));
        }
    }

    void add_between(const Curve& curve) {
        t_.clear();
        for (const std::int32_t k : near_) {
            found_.segments.push_back(k);
            for (const double fraction : fractions_) t_.push_back(parameter(k, fraction));
        }
        if (t_.empty()) return;
        const CurveValues between(curve, {t_.data(), t_.size()}, 0);
        for (const Point3& point : between[0]) found_.points.push_back(point);
    }

    void add_arcs(bool is_ellipse) {
        constexpr double INFINITE = std::numeric_limits<double>::infinity();
        for (std::size_t row = 0; row < near_.size(); ++row) {
            const double turn = parameter(near_[row], 1.0) - parameter(near_[row], 0.0);
            const bool is_arc = is_ellipse && std::abs(turn) <= std::numbers::pi;
            found_.off_arc.push_back(is_arc ? off_[row] : INFINITE);
        }
    }

    const EdgeSegments& all_;
    std::span<const double> fractions_;
    double on_curve_;
    Array<double> t_;
    Array<std::int32_t> near_;
    Array<double> off_;  // of these: the larger distance of the two nodes from the curve
    SegmentSamples found_;
};

}  // namespace

SegmentSamples segment_samples(const EdgeSegments& all, std::span<const double> fractions,
                               double on_curve) {
    Sampling sampling(all, fractions, on_curve);
    for (std::size_t first = 0, end = 0; first < all.edges.size(); first = end) {
        while (end < all.edges.size() && all.edges[end] == all.edges[first]) ++end;
        sampling.look_along(first, end);
    }
    return sampling.found();
}

SegmentSamples samples_of_some(const EdgeSegments& all, std::span<const std::int32_t> some,
                               std::span<const double> fractions, double on_curve) {
    Array<std::int32_t> there, edges;
    Array<std::array<double, 2>> ends;
    Array<std::array<Vertex, 2>> nodes;
    for (const std::int32_t k : some) {
        const std::int32_t edge = all.edges[k];
        if (edge < 0 || static_cast<std::size_t>(edge) >= all.curves.size()) continue;
        there.push_back(k);
        edges.push_back(edge);
        ends.push_back(all.ends[k]);
        nodes.push_back(all.nodes[k]);
    }
    SegmentSamples found = segment_samples({all.curves,
                                            all.limits,
                                            {edges.data(), edges.size()},
                                            {ends.data(), ends.size()},
                                            {nodes.data(), nodes.size()},
                                            all.points},
                                           fractions, on_curve);
    for (std::int32_t& k : found.segments) k = there[k];
    return found;
}

}  // namespace surfmesh
