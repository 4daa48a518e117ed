#include "quality/edge_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "quality/largest_values.hpp"
#include "triangulation/triangulation.hpp"

namespace surfmesh {
namespace {

/// The target sizes along an edge.
struct SizesAlong {
    double mean;       // at its ends, whatever their direction
    double in_metric;  // the length of the edge, in those along it
    double apart;      // by how much those along it differ at its ends
};

/// Sums over the edges of a face: those of which it is the first, and the others.
struct FaceSums {
    double first_length = 0.0, second_length = 0.0, first_size = 0.0, second_size = 0.0;
    std::int64_t edges = 0;
};

/// The longest and the shortest of the edges at a vertex.
struct LengthRange {
    double longest = 0.0, shortest = std::numeric_limits<double>::infinity();
};

class EdgePass {
  public:
    EdgePass(const JoinedTriangles& mesh, const TargetSizes& sizes, const GrowthLimit& growth)
        : mesh_(mesh),
          sizes_(sizes),
          growth_(growth),
          ranges_(mesh.points.size()),
          sums_(mesh.faces_in_all) {}

    EdgeFigures run() {
        const std::size_t count = mesh_.edges.size();
        found_.lengths = Array<double>::unfilled(count);
        found_.metric_lengths = Array<double>::unfilled(has_sizes() ? count : 0);
        found_.changes = {NIL, -1.0, 0};
        for (std::size_t k = 0; k < count; ++k) add(k);
        if (!has_length_ || found_.changes.steepest == NIL) found_.changes = {NIL, 0.0, 0};
        found_.length = spread_of({found_.lengths.data(), count});
        found_.metric_length =
            spread_of({found_.metric_lengths.data(), found_.metric_lengths.size()});
        found_.ratios = ratios();
        take_means();
        return std::move(found_);
    }

  private:
    [[nodiscard]] bool has_sizes() const { return !sizes_.at_vertices.empty(); }
    [[nodiscard]] bool is_stretched() const { return has_sizes() && !sizes_.roots.empty(); }

    void add(std::size_t k) {
        const auto [a, b] = mesh_.edges[k];
        const double length = norm(mesh_.points[b] - mesh_.points[a]);
        has_length_ |= length > 0.0;
        found_.lengths[k] = length;
        SizesAlong along{};
        if (has_sizes()) {
            along = sizes_along(k, length);
            found_.metric_lengths[k] = along.in_metric;
            note_change(k, along.apart / (growth_.slope * length));
        }
        note_range(k, is_stretched() ? along.in_metric : length);
        add_to_faces(k, length, along.mean);
    }

    [[nodiscard]] SizesAlong sizes_along(std::size_t k, double length) const {
        const auto [a, b] = mesh_.edges[k];
        const double at_a = sizes_.at_vertices[a], at_b = sizes_.at_vertices[b];
        const double mean = 0.5 * (at_a + at_b);
        if (!is_stretched()) return {mean, length / mean, std::abs(at_a - at_b)};
        const Point3 step = mesh_.points[b] - mesh_.points[a];
        const HalfEdge e = mesh_.half_edges[k].first;
        const std::span<const Vertex> corners = corners_in_a_row(sizes_.root_triangles);
        const double first = norm(apply(sizes_.roots[corners[e]], step)),
                     second = norm(apply(sizes_.roots[corners[next_half_edge(e)]], step)),
                     total = first + second;
        return {mean, 2.0 * first * second / (total > 0.0 ? total : 1.0),
                std::abs(length / first - length / second)};
    }

    void note_change(std::size_t k, double quotient) {
        if (!(growth_.slope > 0.0)) return;
        const double change = std::isfinite(quotient) ? quotient : 0.0;
        found_.changes.above += change > growth_.most ? 1 : 0;
        if (!(change > found_.changes.largest)) return;
        found_.changes.largest = change;
        found_.changes.steepest = static_cast<std::int64_t>(k);
    }

    /// Where an edge has no length in numbers, ``ratios`` sees to its vertices.
    void note_range(std::size_t k, double length) {
        is_number_ &= length == length;
        for (const Vertex v : {mesh_.edges[k].lower, mesh_.edges[k].higher}) {
            ranges_[v].longest = std::max(ranges_[v].longest, length);    // no branch: nobody could
            ranges_[v].shortest = std::min(ranges_[v].shortest, length);  // foretell it
        }
    }

    void add_to_faces(std::size_t k, double length, double size) {
        const auto [first, second] = mesh_.half_edges[k];
        FaceSums& own = sums_[mesh_.faces[first / 3]];
        own.first_length += length;
        own.first_size += size;
        ++own.edges;
        if (second == NIL || mesh_.faces[second / 3] == mesh_.faces[first / 3]) return;
        FaceSums& other = sums_[mesh_.faces[second / 3]];
        other.second_length += length;
        other.second_size += size;
        ++other.edges;
    }

    LengthRatios ratios() {
        const Array<double>& lengths = is_stretched() ? found_.metric_lengths : found_.lengths;
        if (!is_number_)
            for (std::size_t k = 0; k < lengths.size(); ++k)
                if (std::isnan(lengths[k]))
                    for (const Vertex v : {mesh_.edges[k].lower, mesh_.edges[k].higher})
                        ranges_[v].longest = ranges_[v].shortest = lengths[k];
        Array<double> over;
        over.reserve(ranges_.size());
        double largest = 0.0;
        for (const auto& [longest, shortest] : ranges_) {
            if (!(shortest > 0.0 && longest > 0.0 &&
                  longest < std::numeric_limits<double>::infinity()))
                continue;
            over.push_back(longest / shortest);
            largest = std::max(largest, longest / shortest);
        }
        constexpr double UNKNOWN = std::numeric_limits<double>::quiet_NaN();
        if (over.empty()) return {UNKNOWN, UNKNOWN};
        return {largest, quantile({over.data(), over.size()}, 0.99)};
    }

    void take_means() {
        for (const FaceSums& sums : sums_) {
            const auto edges = static_cast<double>(std::max<std::int64_t>(sums.edges, 1));
            found_.face_lengths.push_back((sums.first_length + sums.second_length) / edges);
            found_.face_sizes.push_back((sums.first_size + sums.second_size) / edges);
        }
    }

    const JoinedTriangles& mesh_;
    const TargetSizes& sizes_;
    const GrowthLimit& growth_;
    Array<LengthRange> ranges_;  // at each vertex
    Array<FaceSums> sums_;
    bool has_length_ = false, is_number_ = true;
    EdgeFigures found_;
};

}  // namespace

EdgeFigures edge_figures(const JoinedTriangles& mesh, const TargetSizes& sizes,
                         const GrowthLimit& growth) {
    return EdgePass(mesh, sizes, growth).run();
}

}  // namespace surfmesh
