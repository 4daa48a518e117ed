#include "quality/mesh_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "elementary_functions/inverse_trigonometric.hpp"
#include "optimisation/dihedral.hpp"

namespace surfmesh {
namespace {

/// Corner e % 3 of triangle e / 3.
Vertex corner_of_half_edge(std::span<const TriangleCorners> triangles, HalfEdge e) {
    return corners_in_a_row(triangles)[e];
}

/// Angles, degrees, in the order of their turns. Arc tangents are gathered: many at once take half
/// the time.
class AnglesOfTurns {
  public:
    explicit AnglesOfTurns(std::size_t most) { degrees_.reserve(most); }

    /// Of most edges, which are all but flat, by the series: x - x^3 / 3 is off by x^5 / 5.
    void add(const DihedralTurn& turn) {
        constexpr double FLAT = 1e-4;
        if (turn.across <= FLAT * turn.along) {
            const double x = turn.across == 0.0 ? 0.0 : turn.across / turn.along;
            degrees_.push_back((x - x * x * x / 3.0) * DEGREES);
            return;
        }
        across_[count_] = turn.across;
        along_[count_] = turn.along;
        place_[count_++] = degrees_.size();
        degrees_.push_back(0.0);
        if (count_ == GATHERED) take_angles();
    }

    Array<double> done() {
        take_angles();
        return std::move(degrees_);
    }

  private:
    static constexpr std::size_t GATHERED = 256;
    static constexpr double DEGREES = 180.0 / std::numbers::pi;

    void take_angles() {
        std::array<double, GATHERED> angles;
        elementary::atan2({across_.data(), count_}, {along_.data(), count_},
                          {angles.data(), count_});
        for (std::size_t k = 0; k < count_; ++k)
            degrees_[static_cast<std::ptrdiff_t>(place_[k])] = angles[k] * DEGREES;
        count_ = 0;
    }

    Array<double> degrees_;
    std::array<double, GATHERED> across_, along_;
    std::array<std::size_t, GATHERED> place_;
    std::size_t count_ = 0;
};

}  // namespace

Array<double> edge_lengths(std::span<const Point3> points, std::span<const EdgeTable::Ends> edges) {
    Array<double> lengths;
    lengths.reserve(edges.size());
    for (const auto& [a, b] : edges) lengths.push_back(norm(points[b] - points[a]));
    return lengths;
}

EdgeSizes edge_sizes(std::span<const EdgeTable::Ends> edges, std::span<const double> sizes) {
    EdgeSizes found;
    found.mean.reserve(edges.size());
    found.apart.reserve(edges.size());
    for (const auto& [a, b] : edges) {
        found.mean.push_back(0.5 * (sizes[a] + sizes[b]));
        found.apart.push_back(std::abs(sizes[a] - sizes[b]));
    }
    return found;
}

EdgeExtremes edge_extremes(std::span<const EdgeTable::Ends> edges, std::span<const double> lengths,
                           std::size_t vertices) {
    EdgeExtremes found{Array<double>(vertices, 0.0),
                       Array<double>(vertices, std::numeric_limits<double>::infinity())};
    bool is_number = true;
    for (std::size_t k = 0; k < edges.size(); ++k) {
        const double length = lengths[k];
        is_number &= length == length;
        for (const Vertex v : {edges[k].lower, edges[k].higher}) {
            found.longest[v] = std::max(found.longest[v], length);    // no branch: nobody could
            found.shortest[v] = std::min(found.shortest[v], length);  // foretell it
        }
    }
    if (is_number) return found;
    for (std::size_t k = 0; k < edges.size(); ++k)
        if (std::isnan(lengths[k]))
            for (const Vertex v : {edges[k].lower, edges[k].higher})
                found.longest[v] = found.shortest[v] = lengths[k];
    return found;
}

SizeChanges size_changes(std::span<const double> apart, std::span<const double> lengths,
                         double slope, double most) {
    SizeChanges found{NIL, -1.0, 0};
    bool have_length = false;
    for (std::size_t k = 0; k < lengths.size(); ++k) {
        have_length |= lengths[k] > 0.0;
        const double quotient = apart[k] / (slope * lengths[k]);
        const double change = std::isfinite(quotient) ? quotient : 0.0;
        found.above += change > most ? 1 : 0;
        if (!(change > found.largest)) continue;
        found.largest = change;
        found.steepest = static_cast<std::int64_t>(k);
    }
    return have_length ? found : SizeChanges{NIL, 0.0, 0};
}

AnglesWithinFaces angles_within_faces(std::span<const Point3> points,
                                      std::span<const TriangleCorners> triangles,
                                      std::span<const std::int32_t> faces,
                                      std::span<const EdgeTable::Sides> half_edges,
                                      std::span<const std::int32_t> uses) {
    AnglesWithinFaces found;
    found.edges.reserve(half_edges.size());
    found.faces.reserve(half_edges.size());
    AnglesOfTurns degrees(half_edges.size());
    for (std::size_t k = 0; k < half_edges.size(); ++k) {
        const auto [e, f] = half_edges[k];
        if (uses[k] != 2 || f == NIL || faces[e / 3] != faces[f / 3]) continue;
        const auto at = [&](HalfEdge h) { return points[corner_of_half_edge(triangles, h)]; };
        degrees.add(dihedral_turn(at(e), at(next_half_edge(e)), at(prev_half_edge(e)),
                                  at(prev_half_edge(f))));
        found.edges.push_back(static_cast<std::int64_t>(k));
        found.faces.push_back(faces[e / 3]);
    }
    found.degrees = degrees.done();
    return found;
}

}  // namespace surfmesh
