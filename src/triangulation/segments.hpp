// How two segments of the plane meet, decided exactly; and distances to many segments in space.
//
// The segment of a point is degenerate: both its ends are that point.
#pragma once

#include <cstdint>
#include <span>

#include "values/array.hpp"
#include "values/point.hpp"

namespace surfmesh {

struct SegmentEnds {
    std::int64_t start, end;
};

struct SegmentPair {
    std::int64_t first, second;
};

// How the segments of a pair ab, cd meet: which ends are near the other one, or a proper crossing.
inline constexpr std::int64_t A_NEAR_CD = 1, B_NEAR_CD = 2, C_NEAR_AB = 4, D_NEAR_AB = 8,
                              CROSSING = 16;

struct Meetings {
    Array<std::int64_t> flags;  // of the pairs
    Array<Point2> places;       // of the pairs: nan where they do not cross
};

/// How the segments of each pair meet, and the place of each proper crossing.
///
///          c                      place = a + t (b - a),  t = [cda] / ([cda] - [cdb])
///          |                      with [pqr] twice the signed area of pqr
///    a ----+---- b
///          |
///          d
///
/// An end is near a segment exactly on it or within ``tolerance``, without being one of its ends.
/// With a tolerance of zero all flags are exact.
Meetings find_meetings(std::span<const Point2> points, std::span<const SegmentEnds> segments,
                       std::span<const SegmentPair> pairs, double tolerance);

struct Segment3 {
    Point3 start, end;
};

struct Box3 {
    Point3 low, high;
};

/// Segments that share a bounding box in ``distances``, and boxes that share a larger one.
inline constexpr std::int64_t SEGMENT_BLOCK = 16;

double squared_distance(const Segment3& segment, Point3 p);
double squared_distance(const Box3& box, Point3 p);

/// Distance of each point to the nearest segment.
///
/// boxes: each bounds SEGMENT_BLOCK segments in a row. groups: each bounds SEGMENT_BLOCK boxes in a row.
Array<double> distances(std::span<const Point3> points, std::span<const Segment3> segments,
                        std::span<const Box3> boxes, std::span<const Box3> groups);

}  // namespace surfmesh
