#include "proof/isotopy.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "proof/vertex_star.hpp"
#include "surfaces/interval.hpp"
#include "values/conventions.hpp"

namespace surfmesh {
namespace {

constexpr double APART_ROUNDING = 0x1p-40;  // of coordinates, more than that of any difference
constexpr double LESS_THAN_ONE = 1.0 - 1e-6;

using SpaceTriangle = std::array<Point3, 3>;

struct MovedBox {
    Point3 low, high;
};

bool overlap(const MovedBox& a, const MovedBox& b) {
    return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y &&
           b.low.y <= a.high.y && a.low.z <= b.high.z && b.low.z <= a.high.z;
}

/// How far two triangles are apart along a direction.
double gap_along(const SpaceTriangle& s, const SpaceTriangle& t, Point3 direction) {
    const double length = norm(direction);
    if (!(length > 0.0 && length < intervals::INFINITE)) return 0.0;
    std::array<double, 3> a{}, b{};
    for (std::size_t k = 0; k < 3; ++k) {
        a[k] = dot(direction, s[k] - s[0]);
        b[k] = dot(direction, t[k] - s[0]);
    }
    const auto [a_low, a_high] = std::minmax_element(a.begin(), a.end());
    const auto [b_low, b_high] = std::minmax_element(b.begin(), b.end());
    return std::max(*b_low - *a_high, *a_low - *b_high) / length;
}

/// From the nearest point of one segment to that of another, about.
Point3 between_segments(Point3 p, Point3 p_end, Point3 q, Point3 q_end) {
    const Point3 d = p_end - p, e = q_end - q, w = p - q;
    const double a = dot(d, d), b = dot(d, e), c = dot(e, e), x = dot(d, w), y = dot(e, w);
    const double area = a * c - b * b;
    double s = area > 0.0 ? std::clamp((b * y - c * x) / area, 0.0, 1.0) : 0.0;
    const double t = c > 0.0 ? std::clamp((b * s + y) / c, 0.0, 1.0) : 0.0;
    if (a > 0.0) s = std::clamp((b * t - x) / a, 0.0, 1.0);
    return w + s * d - t * e;
}

/// Is there a plane between them so far from both? Along normals, those of sides within the planes,
/// and from side to side: the nearest points of two triangles lie along one of these.
bool are_apart(const SpaceTriangle& s, const SpaceTriangle& t, double least) {
    const Point3 n = cross(s[1] - s[0], s[2] - s[0]), m = cross(t[1] - t[0], t[2] - t[0]);
    if (gap_along(s, t, n) >= least || gap_along(s, t, m) >= least) return true;
    for (std::size_t k = 0; k < 3; ++k) {
        if (gap_along(s, t, cross(n, s[(k + 1) % 3] - s[k])) >= least) return true;
        if (gap_along(s, t, cross(m, t[(k + 1) % 3] - t[k])) >= least) return true;
    }
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t l = 0; l < 3; ++l)
            if (gap_along(s, t, between_segments(s[k], s[(k + 1) % 3], t[l], t[(l + 1) % 3])) >=
                least)
                return true;
    return false;
}

/// Pairs of triangles that share no vertex, by a binary tree of boxes that hold where they move.
class NearPairs {
  public:
    explicit NearPairs(const MovedMesh& mesh) : mesh_(mesh) {
        const std::size_t count = mesh.away.size();
        order_.resize(count);
        boxes_.resize(count);
        for (std::size_t t = 0; t < count; ++t) {
            order_[t] = static_cast<std::int32_t>(t);
            boxes_[t] = box_of(t);
        }
        nodes_.resize(4 * count);
        if (count > 0) build(0, 0, count);
    }
    /// The first pair that is not known to stay apart.
    IsotopyProof search() {
        if (!order_.empty()) below(0, 0, order_.size());
        return found_;
    }

  private:
    static constexpr std::size_t LEAF = 4;

    [[nodiscard]] SpaceTriangle corners(std::size_t t) const {
        SpaceTriangle found;
        for (std::size_t k = 0; k < 3; ++k)
            found[k] = mesh_.points[static_cast<std::size_t>(mesh_.vertices[3 * t + k])];
        return found;
    }
    [[nodiscard]] MovedBox box_of(std::size_t t) const {
        const auto [a, b, c] = corners(t);
        const double size = norm(a) + norm(b) + norm(c);
        const double more = mesh_.away[t] * (1.0 + APART_ROUNDING) + APART_ROUNDING * size;
        const Point3 wide{more, more, more};
        const Point3 low{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}),
                         std::min({a.z, b.z, c.z})};
        const Point3 high{std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}),
                          std::max({a.z, b.z, c.z})};
        return {low - wide, high + wide};
    }
    void build(std::size_t node, std::size_t first, std::size_t end);
    void below(std::size_t node, std::size_t first, std::size_t end);
    void between(std::size_t node, std::size_t first, std::size_t end, std::size_t other,
                 std::size_t other_first, std::size_t other_end);
    void compare(std::int32_t s, std::int32_t t);

    MovedMesh mesh_;
    Array<std::int32_t> order_;
    Array<MovedBox> boxes_, nodes_;
    IsotopyProof found_{IsotopyFault::NONE, NIL, NIL};
};

/// Node k over the triangles from first to before end; its halves are 2 k + 1 and 2 k + 2.
void NearPairs::build(std::size_t node, std::size_t first, std::size_t end) {
    MovedBox box = boxes_[order_[static_cast<std::ptrdiff_t>(first)]];
    for (std::size_t i = first; i < end; ++i) {
        const MovedBox& own = boxes_[order_[static_cast<std::ptrdiff_t>(i)]];
        box.low = {std::min(box.low.x, own.low.x), std::min(box.low.y, own.low.y),
                   std::min(box.low.z, own.low.z)};
        box.high = {std::max(box.high.x, own.high.x), std::max(box.high.y, own.high.y),
                    std::max(box.high.z, own.high.z)};
    }
    nodes_[static_cast<std::ptrdiff_t>(node)] = box;
    if (end - first <= LEAF) return;
    const Point3 size = box.high - box.low;
    const auto place = [&](std::int32_t t) {
        const MovedBox& own = boxes_[t];
        if (size.x >= size.y && size.x >= size.z) return own.low.x + own.high.x;
        return size.y >= size.z ? own.low.y + own.high.y : own.low.z + own.high.z;
    };
    const std::size_t middle = first + (end - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + end,
                     [&](std::int32_t a, std::int32_t b) {
                         const double x = place(a), y = place(b);
                         return x < y || (x == y && a < b);
                     });
    build(2 * node + 1, first, middle);
    build(2 * node + 2, middle, end);
}

void NearPairs::below(std::size_t node, std::size_t first, std::size_t end) {
    if (found_.fault != IsotopyFault::NONE) return;
    if (end - first <= LEAF) {
        for (std::size_t i = first; i < end; ++i)
            for (std::size_t j = i + 1; j < end; ++j)
                compare(order_[static_cast<std::ptrdiff_t>(i)],
                        order_[static_cast<std::ptrdiff_t>(j)]);
        return;
    }
    const std::size_t middle = first + (end - first) / 2;
    below(2 * node + 1, first, middle);
    below(2 * node + 2, middle, end);
    between(2 * node + 1, first, middle, 2 * node + 2, middle, end);
}

void NearPairs::between(std::size_t node, std::size_t first, std::size_t end, std::size_t other,
                        std::size_t other_first, std::size_t other_end) {
    if (found_.fault != IsotopyFault::NONE) return;
    if (!overlap(nodes_[static_cast<std::ptrdiff_t>(node)],
                 nodes_[static_cast<std::ptrdiff_t>(other)]))
        return;
    const std::size_t size = end - first, other_size = other_end - other_first;
    if (size <= LEAF && other_size <= LEAF) {
        for (std::size_t i = first; i < end; ++i)
            for (std::size_t j = other_first; j < other_end; ++j)
                compare(order_[static_cast<std::ptrdiff_t>(i)],
                        order_[static_cast<std::ptrdiff_t>(j)]);
        return;
    }
    if (size >= other_size) {
        const std::size_t middle = first + size / 2;
        between(2 * node + 1, first, middle, other, other_first, other_end);
        between(2 * node + 2, middle, end, other, other_first, other_end);
    } else {
        const std::size_t middle = other_first + other_size / 2;
        between(node, first, end, 2 * other + 1, other_first, middle);
        between(node, first, end, 2 * other + 2, middle, other_end);
    }
}

void NearPairs::compare(std::int32_t s, std::int32_t t) {
    if (found_.fault != IsotopyFault::NONE || !overlap(boxes_[s], boxes_[t])) return;
    const auto one = static_cast<std::size_t>(s), other = static_cast<std::size_t>(t);
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t l = 0; l < 3; ++l)
            if (mesh_.vertices[3 * one + k] == mesh_.vertices[3 * other + l]) return;
    const SpaceTriangle a = corners(one), b = corners(other);
    double size = 0.0;
    for (std::size_t k = 0; k < 3; ++k) size += norm(a[k]) + norm(b[k]);
    const double moved = mesh_.away[one] + mesh_.away[other];
    if (!are_apart(a, b, moved / LESS_THAN_ONE + APART_ROUNDING * size))
        found_ = {IsotopyFault::NEAR, std::min(s, t), std::max(s, t)};
}

}  // namespace

Array<std::int32_t> bent_stars(const MovedMesh& mesh) {
    VertexStars stars(mesh);
    Array<std::int32_t> found;
    for (std::int32_t v = 0; v < stars.count(); ++v)
        if (!(stars.change(v) < LESS_THAN_ONE)) found.push_back(v);
    return found;
}

IsotopyProof prove_isotopy(const MovedMesh& mesh) {
    VertexStars stars(mesh);
    for (std::int32_t v = 0; v < stars.count(); ++v)
        if (!(stars.change(v) < LESS_THAN_ONE)) return {IsotopyFault::BENT, v, NIL};
    return NearPairs(mesh).search();
}

}  // namespace surfmesh
