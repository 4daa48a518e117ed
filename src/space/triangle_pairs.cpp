#include "space/triangle_pairs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "space/orient_space.hpp"
#include "triangulation/predicates.hpp"

namespace surfmesh {
namespace {

// of the sum of |w_i d_i|: what rounding can do to w . (p - q)
constexpr double MARGIN = 16.0 * EPSILON;

constexpr std::size_t next(std::size_t k) { return (k + 1) % 3; }

/// Side of a plane through ``origin`` with the normal w: 1, -1, or 0 when too near to tell.
int side_of_plane(Point3 origin, Point3 p, Point3 w) {
    const double x = w.x * (p.x - origin.x), y = w.y * (p.y - origin.y), z = w.z * (p.z - origin.z);
    const double along = x + y + z;
    const double margin = MARGIN * (std::abs(x) + std::abs(y) + std::abs(z)) + UNDERFLOW_BOUND;
    if (along > margin) return 1;
    return along < -margin ? -1 : 0;
}

double largest(Point3 p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

/// Has a plane through 0, that between the two middles, surely b and c on one side and d and e on
/// the other? The four are differences, rounded once.
bool are_parted_between(Point3 b, Point3 c, Point3 d, Point3 e) {
    const Point3 w = b + c - d - e;
    const double longest =
        std::max(std::max(largest(b), largest(c)), std::max(largest(d), largest(e)));
    const double margin = MARGIN * longest * norm_1(w) + UNDERFLOW_BOUND;
    return std::min(dot(w, b), dot(w, c)) > margin && std::max(dot(w, d), dot(w, e)) < -margin;
}

/// Unit vector from a to b; zero where they coincide.
Point3 direction(Point3 a, Point3 b) {
    const Point3 d = b - a;
    const double length = norm(d);
    if (!(length > 0.0)) return {0.0, 0.0, 0.0};
    return {d.x / length, d.y / length, d.z / length};
}

/// Has a plane through a with the normal w surely bc on one side and de on the other?
bool are_parted_at(Point3 a, Point3 b, Point3 c, Point3 d, Point3 e, Point3 w) {
    const int side = side_of_plane(a, b, w);
    return side != 0 && side_of_plane(a, c, w) == side && side_of_plane(a, d, w) == -side &&
           side_of_plane(a, e, w) == -side;
}

/// Is there surely a plane through a with bc on one side and de on the other?
///
///      b   d         tried: the plane between the two middles, by the sides as they are long, which
///       \ : /        suffices for most; then that half-way between the two nearest of the rays
///    c - a - e       from a, then between the middles of the rays
///        :
bool are_parted_at_vertex(Point3 a, Point3 b, Point3 c, Point3 d, Point3 e) {
    if (are_parted_at(a, b, c, d, e, b + c - d - e)) return true;
    const Point3 rb = direction(a, b), rc = direction(a, c), rd = direction(a, d),
                 re = direction(a, e);
    const double bd = dot(rb, rd), be = dot(rb, re), cd = dot(rc, rd), ce = dot(rc, re);
    const double nearest = std::max(std::max(std::max(bd, be), cd), ce);
    const Point3 half_way = nearest == bd   ? rb - rd
                            : nearest == be ? rb - re
                            : nearest == cd ? rc - rd
                                            : rc - re;
    return are_parted_at(a, b, c, d, e, half_way) ||
           are_parted_at(a, b, c, d, e, rb + rc - rd - re);
}

/// Are all corners of t surely farther along w than all of s?
bool are_all_beyond(const Triangle3& s, const Triangle3& t, Point3 w) {
    for (const Point3 a : s)
        for (const Point3 b : t)
            if (side_of_plane(a, b, w) <= 0) return false;
    return true;
}

/// Is t surely beyond a side of s in the plane of s, or off that plane?
bool are_parted_by(const Triangle3& s, const Triangle3& t) {
    const Point3 n = cross(s[1] - s[0], s[2] - s[0]);
    for (std::size_t k = 0; k < 3; ++k)
        if (are_all_beyond(s, t, cross(s[next(k)] - s[k], n))) return true;
    return are_all_beyond(s, t, n) || are_all_beyond(s, t, {-n.x, -n.y, -n.z});
}

/// What is left of p seen along an axis.
Point2 seen_along(int axis, Point3 p) {
    if (axis == 0) return {p.y, p.z};
    return axis == 1 ? Point2{p.z, p.x} : Point2{p.x, p.y};
}

/// Orientation of abc seen along an axis; exact sign.
double orient_along(int axis, Point3 a, Point3 b, Point3 c) {
    return orient(seen_along(axis, a), seen_along(axis, b), seen_along(axis, c));
}

/// The axis along which a triangle seems to be seen best.
int steepest_axis(const Triangle3& s) {
    const Point3 n = cross(s[1] - s[0], s[2] - s[0]);
    const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

/// The axis along which a triangle is seen best, or -1 when it has no area; exact.
int flattest_axis(const Triangle3& s) {
    const int best = steepest_axis(s);
    for (int k = 0; k < 3; ++k) {
        const int axis = (best + k) % 3;
        if (orient_along(axis, s[0], s[1], s[2]) != 0.0) return axis;
    }
    return -1;
}

bool are_apart(double a, double b, double c, double d) {
    return std::max(a, b) < std::min(c, d) || std::min(a, b) > std::max(c, d);
}

/// Have ab and cd, ends included, a point in common? All in one plane, seen along an axis.
bool segments_meet(int axis, Point3 a, Point3 b, Point3 c, Point3 d) {
    const double abc = orient_along(axis, a, b, c), abd = orient_along(axis, a, b, d);
    const double cda = orient_along(axis, c, d, a), cdb = orient_along(axis, c, d, b);
    if (abc == 0.0 && abd == 0.0 && cda == 0.0 && cdb == 0.0)  // on one line
        return !are_apart(a.x, b.x, c.x, d.x) && !are_apart(a.y, b.y, c.y, d.y) &&
               !are_apart(a.z, b.z, c.z, d.z);
    // by signs, as products of small areas underflow
    return !((abc > 0.0 && abd > 0.0) || (abc < 0.0 && abd < 0.0) || (cda > 0.0 && cdb > 0.0) ||
             (cda < 0.0 && cdb < 0.0));
}

bool have_one_sign(double s, double t, double r) {
    return (s >= 0.0 && t >= 0.0 && r >= 0.0) || (s <= 0.0 && t <= 0.0 && r <= 0.0);
}

/// Is p, in the plane of a triangle, within it or on its border? Seen along an axis.
bool is_within(int axis, const Triangle3& s, Point3 p) {
    return have_one_sign(orient_along(axis, s[0], s[1], p), orient_along(axis, s[1], s[2], p),
                         orient_along(axis, s[2], s[0], p));
}

/// Has the segment ab, ends included, a point in common with a triangle, border included?
bool pierces(Point3 a, Point3 b, const Triangle3& s, int axis) {
    const double at_a = orient_space(s[0], s[1], s[2], a);
    const double at_b = orient_space(s[0], s[1], s[2], b);
    if ((at_a > 0.0 && at_b > 0.0) || (at_a < 0.0 && at_b < 0.0)) return false;
    if (at_a == 0.0 && at_b == 0.0) {
        if (is_within(axis, s, a) || is_within(axis, s, b)) return true;
        for (std::size_t k = 0; k < 3; ++k)
            if (segments_meet(axis, a, b, s[k], s[next(k)])) return true;
        return false;
    }
    return have_one_sign(orient_space(a, b, s[0], s[1]), orient_space(a, b, s[1], s[2]),
                         orient_space(a, b, s[2], s[0]));
}

bool are_same(Point3 a, Point3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/// The corners that two triangles share: how many, the last two of them, in each triangle.
struct SharedCorners {
    int count = 0;
    std::size_t before[2] = {0, 0}, last[2] = {0, 0};
};

SharedCorners shared_corners(const Triangle3& s, const Triangle3& t) {
    SharedCorners shared;
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t n = 0; n < 3; ++n) {
            if (!are_same(s[k], t[n])) continue;
            ++shared.count;
            std::copy(shared.last, shared.last + 2, shared.before);
            shared.last[0] = k;
            shared.last[1] = n;
            break;
        }
    return shared;
}

/// What two triangles with two corners in common have: the ends of their side, and a third each.
struct CommonSide {
    Point3 start, end, third_s, third_t;
};

CommonSide common_side(const Triangle3& s, const Triangle3& t, const SharedCorners& shared) {
    return {s[shared.before[0]], s[shared.last[0]], s[3 - shared.before[0] - shared.last[0]],
            t[3 - shared.before[1] - shared.last[1]]};
}

/// Do the third corners lie on opposite sides of the common one, seen along an axis? Then they are
/// no fold, whatever the axis: in a plane along it neither would lie on any side.
bool are_opposite(const CommonSide& side, int axis) {
    const double here = orient_along(axis, side.start, side.end, side.third_s);
    const double there = orient_along(axis, side.start, side.end, side.third_t);
    return (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0);
}

/// Do two triangles with two corners in common lie in one plane, on the same side of their edge?
bool are_folded(const CommonSide& side, int axis) {
    const double here = orient_along(axis, side.start, side.end, side.third_s);
    const double there = orient_along(axis, side.start, side.end, side.third_t);
    if ((here > 0.0) != (there > 0.0) || there == 0.0)
        return false;  // in one plane they would lie on opposite sides
    return orient_space(side.start, side.end, side.third_s, side.third_t) == 0.0;
}

}  // namespace

bool are_parted_neighbours(std::span<const Point3> points, const TriangleCorners& s,
                           const TriangleCorners& t) {
    const std::array<Vertex, 5> of_s = {s.a, s.b, s.c, s.a, s.b}, of_t = {t.a, t.b, t.c, t.a, t.b};
    unsigned alike = 0;  // bit 3 k + n: corner k of s is corner n of t
    for (unsigned k = 0; k < 3; ++k)
        for (unsigned n = 0; n < 3; ++n)
            alike |= static_cast<unsigned>(of_s[k] == of_t[n]) << (3 * k + n);
    if (alike == 0 || (alike & (alike - 1)) != 0) return false;
    const auto bit = static_cast<unsigned>(std::countr_zero(alike));
    const unsigned k = bit / 3, n = bit % 3;
    const Point3 a = points[of_s[k]];
    return are_parted_between(points[of_s[k + 1]] - a, points[of_s[k + 2]] - a,
                              points[of_t[n + 1]] - a, points[of_t[n + 2]] - a);
}

bool triangles_meet(const Triangle3& s, const Triangle3& t) {
    const SharedCorners shared = shared_corners(s, t);
    // two corners of s in one place, that of a corner of t: it has no area
    if (shared.count > 1 && shared.before[1] == shared.last[1]) return false;
    const std::size_t a = shared.last[0], d = shared.last[1];
    const Point3 b = s[next(a)], c = s[(a + 2) % 3], e = t[next(d)], f = t[(d + 2) % 3];
    if (shared.count == 0 && (are_parted_by(s, t) || are_parted_by(t, s))) return false;
    if (shared.count == 1 && are_parted_at_vertex(s[a], b, c, e, f)) return false;
    if (shared.count == 2 && are_opposite(common_side(s, t, shared), steepest_axis(s)))
        return false;
    const int axis_s = flattest_axis(s), axis_t = flattest_axis(t);
    if (axis_s < 0 || axis_t < 0) return false;
    if (shared.count == 0) {
        for (std::size_t k = 0; k < 3; ++k)
            if (pierces(s[k], s[next(k)], t, axis_t) || pierces(t[k], t[next(k)], s, axis_s))
                return true;
        return false;
    }
    // where they part beyond the common vertex, one of them ends at the side that is opposite it
    if (shared.count == 1) return pierces(b, c, t, axis_t) || pierces(e, f, s, axis_s);
    return shared.count > 2 || are_folded(common_side(s, t, shared), axis_s);
}

}  // namespace surfmesh
