#include "space/edge_distances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

constexpr Box3 NO_BOX{{INFINITE, INFINITE, INFINITE}, {-INFINITE, -INFINITE, -INFINITE}};

void widen(Box3& box, Point3 low, Point3 high) {
    box.low = {std::min(box.low.x, low.x), std::min(box.low.y, low.y), std::min(box.low.z, low.z)};
    box.high = {std::max(box.high.x, high.x), std::max(box.high.y, high.y),
                std::max(box.high.z, high.z)};
}

Box3 box_around(std::span<const Point3> points) {
    Box3 box = NO_BOX;
    for (const Point3 p : points) widen(box, p, p);
    return box;
}

double squared_distance_between(const Box3& a, const Box3& b) {
    const auto apart = [](double low_a, double high_a, double low_b, double high_b) {
        const double d = std::max(std::max(low_a - high_b, low_b - high_a), 0.0);
        return d * d;
    };
    return apart(a.low.x, a.high.x, b.low.x, b.high.x) +
           apart(a.low.y, a.high.y, b.low.y, b.high.y) +
           apart(a.low.z, a.high.z, b.low.z, b.high.z);
}

/// Boxes around the edges, and around RUN segments of each in a row.
struct EdgeRuns {
    Array<Box3> boxes;              // of the runs of all edges
    Array<std::int64_t> first_box;  // of each edge
    Array<Box3> of_edges;
};

constexpr std::int64_t RUN = 8;

constexpr std::size_t EDGES_AT_ONCE = 64;  // that a thread takes

EdgeRuns runs_of_edges(const SampledEdges& sampled) {
    const std::size_t count = sampled.first.size() - 1;
    EdgeRuns found{{}, Array<std::int64_t>(count), Array<Box3>(count)};
    std::int64_t boxes = 0;
    for (std::size_t e = 0; e < count; ++e) {
        found.first_box.data()[e] = boxes;
        boxes += (sampled.first[e + 1] - sampled.first[e] - 1 + RUN - 1) / RUN;
    }
    found.boxes.resize(static_cast<std::size_t>(boxes));
    const auto put_boxes = [&](std::size_t e) {
        const std::int64_t first = sampled.first[e], end = sampled.first[e + 1];
        Box3 whole = NO_BOX;
        if (end == first + 1) widen(whole, sampled.points[first], sampled.points[first]);
        Box3* box = found.boxes.data() + found.first_box.data()[e];
        for (std::int64_t p = first; p < end - 1; p += RUN, ++box) {
            const std::int64_t last = std::min(p + RUN, end - 1);
            *box = box_around(sampled.points.subspan(static_cast<std::size_t>(p),
                                                     static_cast<std::size_t>(last - p + 1)));
            widen(whole, box->low, box->high);
        }
        found.of_edges.data()[e] = whole;
    };
    for_each_block(count, EDGES_AT_ONCE, [&](std::size_t begin, std::size_t end) {
        for (std::size_t e = begin; e < end; ++e) put_boxes(e);
    });
    return found;
}

/// Squares of the largest reach of each edge.
Array<double> farthest_of_edges(const SampledEdges& sampled) {
    Array<double> found(sampled.first.size() - 1);
    for_each_block(found.size(), EDGES_AT_ONCE, [&](std::size_t begin, std::size_t end) {
        for (std::size_t e = begin; e < end; ++e) {
            double largest = 0.0;
            for (std::int64_t p = sampled.first[e]; p < sampled.first[e + 1]; ++p)
                largest = std::max(largest, sampled.reach[p]);
            found.data()[e] = largest * largest;
        }
    });
    return found;
}

/// Runs of one edge, of their numbers in a row the first sample and the box.
struct RunOfEdge {
    std::int64_t sample, box;
};

/// Lower the gap of one sample to its distance from some runs of edge b. nearest_run: among them
/// that of the sample before, which is looked at first, since most others lie farther; then its own.
void lower_gap(const SampledEdges& sampled, const EdgeRuns& runs, std::int64_t p, std::int64_t b,
               std::span<const RunOfEdge> near, std::size_t& nearest_run, EdgeGaps& found) {
    const std::int64_t end = sampled.first[b + 1] - 1;
    const Point3 point = sampled.points[p];
    const double reach = std::min(found.gap[p], sampled.reach[p]);
    double nearest = reach * reach;
    if (squared_distance(found.boxes[b], point) >= nearest) return;
    const auto look_at = [&](std::size_t k) {
        const auto [run, box] = near[k];
        if (squared_distance(runs.boxes[box], point) >= nearest) return;
        for (std::int64_t s = run; s < std::min(run + RUN, end); ++s) {
            const double here =
                squared_distance(Segment3{sampled.points[s], sampled.points[s + 1]}, point);
            if (here < nearest) {
                nearest = here;
                nearest_run = k;
            }
        }
    };
    const std::size_t first = nearest_run;
    look_at(first);
    for (std::size_t k = 0; k < near.size(); ++k)
        if (k != first) look_at(k);
    if (nearest < reach * reach) found.gap[p] = std::sqrt(nearest);
}

/// The runs of edge b that are not surely farther from a box than ``farthest``, squared.
void near_runs(const SampledEdges& sampled, const EdgeRuns& runs, std::int64_t b, const Box3& from,
               double farthest, Array<RunOfEdge>& near) {
    constexpr double SURELY = 1.0 + 1e-9;  // round-off decides nothing
    near.clear();
    std::int64_t box = runs.first_box[b];
    for (std::int64_t run = sampled.first[b]; run < sampled.first[b + 1] - 1; run += RUN, ++box)
        if (!(squared_distance_between(runs.boxes[box], from) > SURELY * farthest))
            near.push_back({run, box});
}

/// Lower the gaps of the samples of edge a, run by run; farthest: square of their largest reach.
void lower_gaps(const SampledEdges& sampled, const EdgeRuns& runs, std::int64_t a, std::int64_t b,
                double farthest, EdgeGaps& found) {
    Array<RunOfEdge> near;
    std::size_t nearest_run = 0;
    const auto lower = [&](std::int64_t p) {
        lower_gap(sampled, runs, p, b, near, nearest_run, found);
    };
    const std::int64_t end = sampled.first[a + 1] - 1;
    std::int64_t box = runs.first_box[a];
    for (std::int64_t run = sampled.first[a]; run < end; run += RUN, ++box) {
        if (squared_distance_between(runs.boxes[box], found.boxes[b]) >= farthest) continue;
        near_runs(sampled, runs, b, runs.boxes[box], farthest, near);
        if (near.empty()) continue;
        nearest_run = 0;
        const std::int64_t last = run + RUN < end ? run + RUN - 1 : end;
        for (std::int64_t p = run; p <= last; ++p) lower(p);
    }
    if (sampled.first[a] != end) return;
    near_runs(sampled, runs, b, found.boxes[a], farthest, near);
    nearest_run = 0;
    if (!near.empty()) lower(end);
}

/// Of each edge the faces that use it, in their order.
struct FacesOfEdges {
    Array<std::int64_t> first;  // of the edges, and how many there are
    Array<std::int64_t> faces;
};

FacesOfEdges faces_of_edges(const SampledEdges& sampled) {
    FacesOfEdges found{Array<std::int64_t>(sampled.first.size(), 0),
                       Array<std::int64_t>(sampled.edges.size(), 0)};
    for (const std::int64_t edge : sampled.edges) ++found.first[edge + 1];
    for (std::size_t e = 1; e < found.first.size(); ++e) found.first[e] += found.first[e - 1];
    Array<std::int64_t> place = found.first;
    for (std::size_t face = 0; face + 1 < sampled.first_of_face.size(); ++face)
        for (std::int64_t k = sampled.first_of_face[face]; k < sampled.first_of_face[face + 1]; ++k)
            found.faces[place[sampled.edges[k]]++] = static_cast<std::int64_t>(face);
    return found;
}

/// Which edges of a face may be near one of them: those whose boxes begin within a band along the
/// longest axis of the face, and those that are long themselves.
class NearEdges {
  public:
    NearEdges(const SampledEdges& sampled, const Array<Box3>& boxes, std::int64_t face)
        : first_(sampled.first_of_face[face]), end_(sampled.first_of_face[face + 1]) {
        if (end_ - first_ < FEW || !choose_axis(sampled, boxes)) return;
        for (std::int64_t k = first_; k < end_; ++k) {
            const Box3& box = boxes[sampled.edges[k]];
            const double low = along(box.low), length = along(box.high) - low;
            if (!(length < LONG * extent_)) {  // a box of no samples has no length
                long_.push_back(k);
                continue;
            }
            longest_ = std::max(longest_, length);
            begins_.push_back({low, k});
        }
        std::sort(begins_.begin(), begins_.end(), [](const Begin& one, const Begin& other) {
            return one.at < other.at || (one.at == other.at && one.row < other.row);
        });
    }

    /// Rows of the face's edges, rising: all that may be nearer to the box than ``reach``.
    void of(const Box3& box, double reach, Array<std::int64_t>& rows) const {
        rows.clear();
        if (begins_.empty()) {
            for (std::int64_t k = first_; k < end_; ++k) rows.push_back(k);
            return;
        }
        const double away = SURELY * (reach + longest_) + ROUNDING * extent_;
        const double from = along(box.low) - away, to = along(box.high) + away;
        auto begin = std::lower_bound(begins_.begin(), begins_.end(), from,
                                      [](const Begin& b, double at) { return b.at < at; });
        for (; begin != begins_.end() && begin->at <= to; ++begin) rows.push_back(begin->row);
        for (const std::int64_t k : long_) rows.push_back(k);
        std::sort(rows.begin(), rows.end());
    }

  private:
    static constexpr std::int64_t FEW = 48;  // edges that are looked at one by one
    static constexpr double LONG = 0.05;     // of the face: longer edges widen no band
    static constexpr double SURELY = 1.0 + 1e-9, ROUNDING = 1e-9;

    struct Begin {
        double at;
        std::int64_t row;
    };

    [[nodiscard]] double along(Point3 p) const { return axis_ == 0 ? p.x : axis_ == 1 ? p.y : p.z; }

    /// The longest axis of the face; whether it has any length.
    bool choose_axis(const SampledEdges& sampled, const Array<Box3>& boxes) {
        Box3 whole{{INFINITE, INFINITE, INFINITE}, {-INFINITE, -INFINITE, -INFINITE}};
        for (std::int64_t k = first_; k < end_; ++k) {
            const Box3& box = boxes[sampled.edges[k]];
            whole.low = {std::min(whole.low.x, box.low.x), std::min(whole.low.y, box.low.y),
                         std::min(whole.low.z, box.low.z)};
            whole.high = {std::max(whole.high.x, box.high.x), std::max(whole.high.y, box.high.y),
                          std::max(whole.high.z, box.high.z)};
        }
        const Point3 size = whole.high - whole.low;
        axis_ = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        extent_ = along(size);
        return extent_ > 0.0 && std::isfinite(extent_);
    }

    std::int64_t first_, end_;
    int axis_ = 0;
    double extent_ = 0.0, longest_ = 0.0;
    Array<Begin> begins_;       // in their order along the axis
    Array<std::int64_t> long_;  // rows
};

/// Lower the gaps of the samples of edge a to their distances from the other edges of a face.
void lower_gaps_in_face(const SampledEdges& sampled, const EdgeRuns& runs, std::int64_t a,
                        std::span<const std::int64_t> rows, double farthest, EdgeGaps& found) {
    for (const std::int64_t k : rows) {
        const std::int64_t b = sampled.edges[k];
        if (a != b && !have_common_vertex(sampled.ends[a], sampled.ends[b]) &&
            squared_distance_between(found.boxes[a], found.boxes[b]) < farthest)
            lower_gaps(sampled, runs, a, b, farthest, found);
    }
}

}  // namespace

EdgeGaps edge_gaps(const SampledEdges& sampled) {
    const EdgeRuns runs = runs_of_edges(sampled);
    EdgeGaps found{Array<double>(sampled.points.size(), INFINITE), runs.of_edges};
    const Array<double> farthest = farthest_of_edges(sampled);
    const FacesOfEdges uses = faces_of_edges(sampled);
    std::vector<NearEdges> near;
    near.reserve(sampled.first_of_face.size());
    for (std::size_t face = 0; face + 1 < sampled.first_of_face.size(); ++face)
        near.emplace_back(sampled, found.boxes, static_cast<std::int64_t>(face));
    for_each_block(farthest.size(), EDGES_AT_ONCE, [&](std::size_t begin, std::size_t end) {
        Array<std::int64_t> rows;
        for (std::size_t a = begin; a < end; ++a)
            for (std::int64_t k = uses.first[a]; k < uses.first[a + 1]; ++k) {
                near[static_cast<std::size_t>(uses.faces[k])].of(found.boxes[a],
                                                                 std::sqrt(farthest[a]), rows);
                lower_gaps_in_face(sampled, runs, static_cast<std::int64_t>(a), rows, farthest[a],
                                   found);
            }
    });
    return found;
}

Array<double> sags(std::span<const Point3> points, std::span<const std::int64_t> first) {
    Array<double> found(first.size() - 1);
    for_each_block(found.size(), EDGES_AT_ONCE, [&](std::size_t begin, std::size_t end) {
        for (std::size_t e = begin; e < end; ++e) {
            double largest = 0.0;
            for (std::int64_t p = first[e] + 1; p < first[e + 1] - 1; ++p)
                largest = std::max(largest, norm(points[p + 1] - 2.0 * points[p] + points[p - 1]));
            found.data()[e] = largest / 8.0;
        }
    });
    return found;
}

}  // namespace surfmesh
