#include "space/edge_distances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace surfmesh {
namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();

/// Each sample with the next one of its edge; the last one is a point.
Array<Segment3> segments_between(const SampledEdges& sampled) {
    Array<Segment3> segments;
    segments.reserve(sampled.points.size());
    for (std::size_t e = 0; e + 1 < sampled.first.size(); ++e)
        for (std::int64_t p = sampled.first[e]; p < sampled.first[e + 1]; ++p)
            segments.push_back(
                {sampled.points[p], sampled.points[std::min(p + 1, sampled.first[e + 1] - 1)]});
    return segments;
}

Box3 box_around(std::span<const Point3> points) {
    Box3 box{{INFINITE, INFINITE, INFINITE}, {-INFINITE, -INFINITE, -INFINITE}};
    for (const Point3 p : points) {
        box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
        box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y),
                    std::max(box.high.z, p.z)};
    }
    return box;
}

bool have_common_vertex(SegmentEnds a, SegmentEnds b) {
    return a.start == b.start || a.start == b.end || a.end == b.start || a.end == b.end;
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

/// Segments of all edges, and boxes around RUN of them in a row.
struct Segments {
    Array<Segment3> segments;
    Array<Box3> boxes;              // of the runs of all edges
    Array<std::int64_t> first_box;  // of each edge
};

constexpr std::int64_t RUN = 8;

Segments runs_of_segments(const SampledEdges& sampled) {
    Segments found{segments_between(sampled), {}, {}};
    for (std::size_t e = 0; e + 1 < sampled.first.size(); ++e) {
        found.first_box.push_back(static_cast<std::int64_t>(found.boxes.size()));
        for (std::int64_t p = sampled.first[e]; p < sampled.first[e + 1] - 1; p += RUN) {
            const std::int64_t last = std::min(p + RUN, sampled.first[e + 1] - 1);
            found.boxes.push_back(box_around(sampled.points.subspan(
                static_cast<std::size_t>(p), static_cast<std::size_t>(last - p + 1))));
        }
    }
    return found;
}

/// Lower the gaps of the samples of edge a to their distances from edge b.
void lower_gaps(const SampledEdges& sampled, const Segments& runs, std::int64_t a, std::int64_t b,
                EdgeGaps& found) {
    const std::int64_t end = sampled.first[b + 1] - 1;
    for (std::int64_t p = sampled.first[a]; p < sampled.first[a + 1]; ++p) {
        const Point3 point = sampled.points[p];
        const double reach = std::min(found.gap[p], sampled.reach[p]);
        double nearest = reach * reach;
        if (squared_distance(found.boxes[b], point) >= nearest) continue;
        std::int64_t box = runs.first_box[b];
        for (std::int64_t run = sampled.first[b]; run < end; run += RUN, ++box) {
            if (squared_distance(runs.boxes[box], point) >= nearest) continue;
            for (std::int64_t s = run; s < std::min(run + RUN, end); ++s) {
                const double here = squared_distance(runs.segments[s], point);
                if (here < nearest) {
                    nearest = here;
                    found.gap[p] = std::sqrt(here);
                }
            }
        }
    }
}

}  // namespace

EdgeGaps edge_gaps(const SampledEdges& sampled) {
    const Segments runs = runs_of_segments(sampled);
    EdgeGaps found{Array<double>(sampled.points.size(), INFINITE), {}};
    Array<double> farthest;  // squares of the largest reach of each edge
    for (std::size_t e = 0; e + 1 < sampled.first.size(); ++e) {
        const auto start = static_cast<std::size_t>(sampled.first[e]);
        const auto count = static_cast<std::size_t>(sampled.first[e + 1]) - start;
        found.boxes.push_back(box_around(sampled.points.subspan(start, count)));
        double largest = 0.0;
        for (const double reach : sampled.reach.subspan(start, count))
            largest = std::max(largest, reach);
        farthest.push_back(largest * largest);
    }
    for (std::size_t face = 0; face + 1 < sampled.first_of_face.size(); ++face) {
        const auto start = static_cast<std::size_t>(sampled.first_of_face[face]);
        const auto count = static_cast<std::size_t>(sampled.first_of_face[face + 1]) - start;
        const std::span<const std::int64_t> own = sampled.edges.subspan(start, count);
        for (const std::int64_t a : own)
            for (const std::int64_t b : own)
                if (a != b && !have_common_vertex(sampled.ends[a], sampled.ends[b]) &&
                    squared_distance_between(found.boxes[a], found.boxes[b]) < farthest[a])
                    lower_gaps(sampled, runs, a, b, found);
    }
    return found;
}

}  // namespace surfmesh
