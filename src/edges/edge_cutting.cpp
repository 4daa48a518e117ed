#include "edges/edge_cutting.hpp"

#include <algorithm>
#include <cmath>

#include "edges/metric_lengths.hpp"
#include "edges/rim_sags.hpp"
#include "values/interpolation.hpp"

namespace surfmesh {
namespace {

constexpr int RIM_ROUNDS = 8;            // how often an edge is cut anew
constexpr double RIM_MARGIN = 0.98;      // what is aimed at, as a fraction of the chord
constexpr std::size_t MANY_PIECES = 64;  // from so many on those that sag too much are halved
constexpr double LARGEST_FACTOR = 2.0;   // of the number of pieces, in one round

class Cutting {
  public:
    Cutting(const CurvePieces& curves, const EdgeNetwork& edges, std::span<const double> fraction,
            std::span<const double> sizes, const CutRequests& asked)
        : curves_(curves), edges_(edges), fraction_(fraction), sizes_(sizes), asked_(asked) {
        found_.first.push_back(0);
    }

    /// The parameters and sizes of the nodes of all edges, as far as none has too many pieces.
    CutEdges nodes() {
        for (std::size_t k = 0; k < asked_.which.size(); ++k)
            if (!cut(k)) break;
        return std::move(found_);
    }

  private:
    template <class T>
    std::span<const T> of(std::span<const T> values, std::int64_t edge) const {
        const auto start = static_cast<std::size_t>(edges_.first[edge]);
        return values.subspan(start, static_cast<std::size_t>(edges_.first[edge + 1]) - start);
    }

    /// Add the nodes of one row; false where there are too many pieces.
    bool cut(std::size_t k) {
        const std::int64_t edge = asked_.which[k];
        metric_lengths(of(edges_.points, edge), of(sizes_, edge), metric_);
        const std::int64_t given = asked_.first_given[k + 1] - asked_.first_given[k];
        const double pieces = given > 0 ? static_cast<double>(given - 1)
                                        : std::max(static_cast<double>(asked_.fewest[k]),
                                                   std::nearbyint(metric_.back()));
        if (!(pieces <= asked_.most)) return refuse(k, pieces);
        const std::size_t start = found_.t.size();
        if (given > 0) {
            for (std::int64_t i = asked_.first_given[k]; i < asked_.first_given[k + 1]; ++i)
                found_.t.push_back(asked_.given[i]);
        } else {
            divide(edge, static_cast<std::size_t>(pieces));
            if (!keep_to_chord(k, start)) return false;
        }
        const Interpolation size(of(fraction_, edge), of(sizes_, edge));
        for (std::size_t i = found_.sizes.size(); i < found_.t.size(); ++i)
            found_.sizes.push_back(size(found_.t.data()[i]));
        found_.first.push_back(static_cast<std::int64_t>(found_.t.size()));
        return true;
    }

    bool refuse(std::size_t k, double pieces) {
        found_.refused = static_cast<std::int64_t>(k);
        found_.pieces = pieces;
        return false;
    }

    /// Cut the row whose nodes begin at ``start`` into more pieces while one of them sags by more
    /// than is allowed; false where there are too many then.
    bool keep_to_chord(std::size_t k, std::size_t start) {
        if (!std::isfinite(asked_.chord[k])) return true;
        const double most = RIM_MARGIN * asked_.chord[k];
        for (int round = 0; round < RIM_ROUNDS; ++round) {
            rim_sags(curves_, asked_.which[k], {found_.t.data() + start, found_.t.size() - start},
                     sags_);
            const std::size_t pieces = sags_.sag.size();
            double largest = 0.0;
            std::size_t far = 0;
            for (std::size_t i = 0; i < pieces; ++i) {
                if (!is_far(k, i)) continue;
                largest = std::max(largest, sags_.sag[i]);
                ++far;
            }
            if (far == 0) return true;
            if (4 * far > pieces && pieces < MANY_PIECES) {
                const double factor = std::min(std::sqrt(largest / most), LARGEST_FACTOR);
                found_.t.resize(start);
                divide(asked_.which[k],
                       static_cast<std::size_t>(std::ceil(factor * static_cast<double>(pieces))));
            } else {
                halve(k, start);
            }
            const auto now = static_cast<double>(found_.t.size() - start - 1);
            if (!(now <= asked_.most)) return refuse(k, now);
        }
        return true;
    }

    bool is_far(std::size_t k, std::size_t piece) const {
        return sags_.sag.data()[piece] > RIM_MARGIN * asked_.chord[k] &&
               sags_.length.data()[piece] > asked_.shortest[k];
    }

    /// A node in the middle of each piece that sags too much.
    void halve(std::size_t k, std::size_t start) {
        before_.clear();
        for (std::size_t i = start; i < found_.t.size(); ++i) before_.push_back(found_.t[i]);
        found_.t.resize(start);
        for (std::size_t i = 0; i + 1 < before_.size(); ++i) {
            found_.t.push_back(before_[i]);
            if (is_far(k, i)) found_.t.push_back(0.5 * (before_[i] + before_[i + 1]));
        }
        found_.t.push_back(before_.back());
    }

    /// Add the nodes of so many pieces of equal metric length.
    void divide(std::int64_t edge, std::size_t pieces) {
        const Interpolation parameter(metric_, of(fraction_, edge));
        const double length = metric_.back();
        for (std::size_t i = 0; i <= pieces; ++i) {
            const double t = static_cast<double>(i) / static_cast<double>(pieces);
            const bool is_end = i == 0 || i == pieces;
            found_.t.push_back(is_end || !(length > 0.0) ? t : parameter(t * length));
        }
    }

    const CurvePieces& curves_;
    const EdgeNetwork& edges_;
    std::span<const double> fraction_, sizes_;
    const CutRequests& asked_;
    Array<double> metric_, before_;
    RimSags sags_;
    CutEdges found_;
};

}  // namespace

CutEdges cut_to_metric_length(const CurvePieces& curves, const EdgeNetwork& edges,
                              std::span<const double> fraction, std::span<const double> sizes,
                              std::span<const Point3> corners, const CutRequests& asked) {
    CutEdges found = Cutting(curves, edges, fraction, sizes, asked).nodes();
    if (found.refused >= 0) return found;
    found.points = points_on(curves, {asked.which, found.first, found.t});
    for (std::size_t k = 0; k < asked.which.size(); ++k) {
        const SegmentEnds ends = edges.ends[asked.which[k]];
        found.points[found.first[k]] = corners[ends.start];
        found.points[found.first[k + 1] - 1] = corners[ends.end];
    }
    return found;
}

}  // namespace surfmesh
