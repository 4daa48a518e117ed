#include "insertion/boundary_arguments.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh::binding {
namespace {

/// Each number 0 .. the largest has to occur; returns how many there are.
std::size_t require_all_segments(const Numbers& segment) {
    const std::span<const std::int32_t> numbers = rows<std::int32_t>(segment);
    require_indices(numbers, numbers.size(), "segment");
    std::size_t count = 0, seen = 0;
    Array<std::uint8_t> occurs(numbers.size(), 0);
    for (const std::int32_t number : numbers) {
        count = std::max(count, static_cast<std::size_t>(number) + 1);
        seen += occurs[number] == 0;
        occurs[number] = 1;
    }
    if (seen != count) throw nb::value_error("segment leaves out a number");
    return count;
}

}  // namespace

void require_finite(const Points2& points, const char* what) {
    for (const Point2 p : rows<Point2>(points))
        if (!std::isfinite(p.x) || !std::isfinite(p.y))
            throw nb::value_error((std::string(what) + " has a place that is not finite").c_str());
}

void require_pairs(const Pairs& pairs, std::size_t count, const char* what) {
    require_indices(std::span<const std::int32_t>(pairs.data(), pairs.size()), count, what);
}

void require_column(const Pairs& pairs, std::size_t k, std::size_t count, const char* what) {
    for (std::size_t i = 0; i < pairs.shape(0); ++i)
        require_indices(std::span<const std::int32_t>(&pairs(i, k), 1), count, what);
}

void require_lengths(const Numbers& lengths, std::size_t total) {
    std::size_t sum = 0;
    for (const std::int32_t length : rows<std::int32_t>(lengths)) {
        if (length < 0) throw nb::value_error("lengths has a negative one");
        sum += static_cast<std::size_t>(length);
    }
    if (sum != total) throw nb::value_error("lengths do not add up to the number of nodes");
}

LoopBoundary loop_boundary(const Points2& nodes, const Pairs& segments, const Pairs& inner,
                           const Vector<std::int64_t>& identity,
                           const std::optional<Points3>& points) {
    require_finite(nodes, "nodes");
    require_pairs(segments, nodes.shape(0), "segments");
    require_pairs(inner, nodes.shape(0), "inner");
    require_rows(identity.shape(0), nodes.shape(0), "identity");
    require_indices(rows<std::int64_t>(identity), nodes.shape(0), "identity");
    if (points) require_rows(points->shape(0), nodes.shape(0), "points");
    LoopBoundary boundary{rows<Point2>(nodes),
                          rows<Segment>(segments),
                          rows<Segment>(inner),
                          rows<std::int64_t>(identity),
                          {}};
    if (points) boundary.points = rows<Point3>(*points);
    return boundary;
}

PlanarBoundary planar_boundary(const Points2& nodes, const Pairs& pieces, const Numbers& segment,
                               const Pairs& loop_segments, const Bytes& is_hole) {
    require_finite(nodes, "nodes");
    require_pairs(pieces, nodes.shape(0), "pieces");
    require_rows(segment.shape(0), pieces.shape(0), "segment");
    require_column(loop_segments, 0, require_all_segments(segment), "loop_segments");
    require_column(loop_segments, 1, is_hole.shape(0), "loop_segments");
    return {rows<Point2>(nodes), rows<Segment>(pieces), rows<std::int32_t>(segment),
            rows<LoopSegment>(loop_segments), rows<std::uint8_t>(is_hole)};
}

}  // namespace surfmesh::binding
