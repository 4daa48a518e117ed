#include "triangulation/segments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "triangulation/predicates.hpp"

namespace surfmesh {
namespace {

struct Segment2 {
    std::int64_t a, b;
    Point2 start, end;
};

/// Is p on the segment, exactly or within the tolerance, without being one of its ends?
bool is_near(const Segment2& s, std::int64_t number, Point2 p, double tolerance) {
    if (number == s.a || number == s.b || s.a == s.b) return false;
    const Point2 a = s.start, b = s.end;
    const double left = std::min(a.x, b.x), right = std::max(a.x, b.x);
    const double low = std::min(a.y, b.y), high = std::max(a.y, b.y);
    if (p.x < left - tolerance || p.x > right + tolerance || p.y < low - tolerance ||
        p.y > high + tolerance)
        return false;
    const Point2 d = b - a;
    const double length2 = d.x * d.x + d.y * d.y;
    if (tolerance > 0.0 && length2 > 0.0) {
        const double along = ((p.x - a.x) * d.x + (p.y - a.y) * d.y) / length2;
        const double t = std::min(std::max(along, 0.0), 1.0);
        const double x = p.x - a.x - t * d.x, y = p.y - a.y - t * d.y;
        if (x * x + y * y <= tolerance * tolerance) return true;
    }
    return orient(a, b, p) == 0.0 && left <= p.x && p.x <= right && low <= p.y && p.y <= high;
}

bool have_opposite_signs(double p, double q) {
    return (p > 0.0 && q < 0.0) || (p < 0.0 && q > 0.0);
}

/// The crossing of two segments without a common end: says whether there is one.
bool cross(const Segment2& s, const Segment2& o, Point2& place) {
    const double cda = orient(o.start, o.end, s.start), cdb = orient(o.start, o.end, s.end);
    if (!have_opposite_signs(cda, cdb)) return false;
    const double abc = orient(s.start, s.end, o.start), abd = orient(s.start, s.end, o.end);
    if (!have_opposite_signs(abc, abd)) return false;
    const double t = cda / (cda - cdb);
    place = s.start + t * (s.end - s.start);
    return true;
}

}  // namespace

Meetings find_meetings(std::span<const Point2> points, std::span<const SegmentEnds> segments,
                       std::span<const SegmentPair> pairs, double tolerance) {
    constexpr double NOWHERE = std::numeric_limits<double>::quiet_NaN();
    Meetings found{Array<std::int64_t>(pairs.size(), 0),
                   Array<Point2>(pairs.size(), {NOWHERE, NOWHERE})};
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const auto [a, b] = segments[pairs[k].first];
        const auto [c, d] = segments[pairs[k].second];
        const Segment2 ab{a, b, points[a], points[b]}, cd{c, d, points[c], points[d]};
        std::int64_t flag = 0;
        if (is_near(cd, a, points[a], tolerance)) flag |= A_NEAR_CD;
        if (a != b && is_near(cd, b, points[b], tolerance)) flag |= B_NEAR_CD;
        if (is_near(ab, c, points[c], tolerance)) flag |= C_NEAR_AB;
        if (c != d && is_near(ab, d, points[d], tolerance)) flag |= D_NEAR_AB;
        const bool apart = a != c && a != d && b != c && b != d && a != b && c != d;
        if (flag == 0 && apart && cross(ab, cd, found.places[k])) flag = CROSSING;
        found.flags[k] = flag;
    }
    return found;
}

double squared_distance(const Segment3& segment, Point3 p) {
    const Point3 d = segment.end - segment.start;
    Point3 q = p - segment.start;
    const double length2 = dot(d, d);
    if (length2 > 0.0) {
        const double t = std::min(std::max(dot(q, d) / length2, 0.0), 1.0);
        q = q - t * d;
    }
    return dot(q, q);
}

double squared_distance(const Box3& box, Point3 p) {
    const double x = std::max(std::max(box.low.x - p.x, p.x - box.high.x), 0.0);
    const double y = std::max(std::max(box.low.y - p.y, p.y - box.high.y), 0.0);
    const double z = std::max(std::max(box.low.z - p.z, p.z - box.high.z), 0.0);
    return x * x + y * y + z * z;
}

Array<double> distances(std::span<const Point3> points, std::span<const Segment3> segments,
                        std::span<const Box3> boxes, std::span<const Box3> groups) {
    const auto end_of_block = [](std::size_t block, std::size_t count) {
        return std::min<std::size_t>(SEGMENT_BLOCK * (block + 1), count);
    };
    Array<double> found(points.size());
    std::size_t nearest = 0;  // neighbouring points often have the same nearest segment
    for (std::size_t k = 0; k < points.size(); ++k) {
        const Point3 p = points[k];
        double best = squared_distance(segments[nearest], p);
        for (std::size_t group = 0; group < groups.size(); ++group) {
            if (squared_distance(groups[group], p) >= best) continue;
            for (std::size_t box = SEGMENT_BLOCK * group; box < end_of_block(group, boxes.size());
                 ++box) {
                if (squared_distance(boxes[box], p) >= best) continue;
                for (std::size_t s = SEGMENT_BLOCK * box; s < end_of_block(box, segments.size());
                     ++s) {
                    const double here = squared_distance(segments[s], p);
                    if (here < best) {
                        best = here;
                        nearest = s;
                    }
                }
            }
        }
        found[k] = std::sqrt(best);
    }
    return found;
}

}  // namespace surfmesh
