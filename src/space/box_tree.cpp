#include "space/box_tree.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace surfmesh {
namespace {

// triangles in a leaf: a test of eight boxes costs what a level or two of the tree do
constexpr std::size_t LEAF = 8;

/// The 20 bits of x, two zeros after each.
std::int64_t spread(std::int64_t x) {
    x = (x | (x << 32)) & 0x1F00000000FFFF;
    x = (x | (x << 16)) & 0x1F0000FF0000FF;
    x = (x | (x << 8)) & 0x100F00F00F00F00F;
    x = (x | (x << 4)) & 0x10C30C30C30C30C3;
    return (x | (x << 2)) & 0x1249249249249249;
}

/// A coordinate along the curve as an integer of 20 bits.
std::int64_t bits_of(double x) {
    return x > 0.0 ? static_cast<std::int64_t>(std::min(x, 0x1p20 - 1.0)) : 0;
}

/// Coordinates in the box of the points, from 0 to 2^20 along its longest side. Rounding keeps the
/// order of any two: boxes with a point in common have one in these coordinates too.
struct Frame {
    Point3 low;
    double scale;  // 0: no sides, or too long ones; then all is at 0

    Point3 operator()(Point3 p) const {
        if (scale == 0.0) return {0.0, 0.0, 0.0};
        return scale * (p - low);
    }
};

Frame frame_around(std::span<const Point3> points) {
    constexpr double INFINITE = std::numeric_limits<double>::infinity();
    Point3 low{INFINITE, INFINITE, INFINITE}, high{-INFINITE, -INFINITE, -INFINITE};
    for (const Point3 p : points) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Point3 sides = high - low;
    const double extent = std::max(std::max(sides.x, sides.y), sides.z);
    const bool has_scale = extent > 0.0 && extent < INFINITE;
    return {low, has_scale ? (0x1p20 - 1.0) / extent : 0.0};
}

/// A box, borders included; without an inside where it holds nothing. The fourth numbers make it
/// two of the processor's vectors.
struct Bounds {
    float low[4], high[4];

    static Bounds nothing() {
        constexpr float INFINITE = std::numeric_limits<float>::infinity();
        return {{INFINITE, INFINITE, INFINITE, 0.0F}, {-INFINITE, -INFINITE, -INFINITE, 0.0F}};
    }
    void add(const Bounds& other) {
        for (int k = 0; k < 4; ++k) {
            low[k] = std::min(low[k], other.low[k]);
            high[k] = std::max(high[k], other.high[k]);
        }
    }
    void add(Point3 p) {
        const auto x = static_cast<float>(p.x), y = static_cast<float>(p.y),
                   z = static_cast<float>(p.z);
        add({{x, y, z, 0.0F}, {x, y, z, 0.0F}});
    }
};

/// All comparisons, without a branch: which of them decides cannot be foretold.
bool overlap(const Bounds& a, const Bounds& b) {
    int apart = 0;
    for (int k = 0; k < 4; ++k)
        apart |= static_cast<int>(a.low[k] > b.high[k]) | static_cast<int>(b.low[k] > a.high[k]);
    return apart == 0;
}

/// The triangles in the order of the tree and their boxes, and those around what lies below each
/// node over them.
struct BoxTree {
    Array<std::int32_t> order;  // numbers of the triangles
    std::vector<KeyedTriangle> triangles;
    Array<Bounds> boxes;
    Array<Bounds> nodes;
    std::size_t leaves = 1;
};

/// Place of each triangle's centroid along the Z-order curve through the box of the points.
Array<std::int64_t> curve_places(std::span<const Point3> points,
                                 std::span<const TriangleCorners> triangles, const Frame& frame) {
    Array<std::int64_t> places;
    places.reserve(triangles.size());
    for (const TriangleCorners& t : triangles) {
        const Point3 sum = frame(points[t.a]) + frame(points[t.b]) + frame(points[t.c]);
        std::int64_t place = 0;
        int bit = 0;
        for (const double s : {sum.x, sum.y, sum.z}) place |= spread(bits_of(s / 3.0)) << bit++;
        places.push_back(place);
    }
    return places;
}

/// The numbers of places in their order, equal ones as they are: a digit after the other.
Array<std::int32_t> sorted_numbers(const Array<std::int64_t>& places) {
    constexpr int BITS = 12, ALL_BITS = 60;
    constexpr std::int64_t DIGITS = 1 << BITS;
    Array<std::int32_t> order(places.size()), next(places.size());
    std::iota(order.begin(), order.end(), 0);
    for (int shift = 0; shift < ALL_BITS; shift += BITS) {
        const auto digit = [&](std::int32_t i) { return places[i] >> shift & (DIGITS - 1); };
        Array<std::size_t> first(DIGITS + 1, 0);
        for (const std::int32_t i : order) ++first[digit(i) + 1];
        for (std::int64_t d = 0; d < DIGITS; ++d) first[d + 1] += first[d];
        for (const std::int32_t i : order) next[first[digit(i)]++] = i;
        std::swap(order, next);
    }
    return order;
}

BoxTree tree_over(std::span<const Point3> points, std::span<const TriangleCorners> triangles) {
    BoxTree tree;
    while (tree.leaves * LEAF < triangles.size()) tree.leaves *= 2;
    const Frame frame = frame_around(points);
    tree.order = sorted_numbers(curve_places(points, triangles, frame));
    tree.triangles.reserve(triangles.size());
    tree.boxes.resize(triangles.size(), Bounds::nothing());
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        const TriangleCorners& t = triangles[tree.order[k]];
        tree.triangles.emplace_back(Triangle3{points[t.a], points[t.b], points[t.c]});
        for (const Point3 corner : tree.triangles[k].corners) tree.boxes[k].add(frame(corner));
    }
    tree.nodes.resize(2 * tree.leaves - 1, Bounds::nothing());
    for (std::size_t node = tree.nodes.size(); node-- > 0;) {
        if (node + 1 >= tree.leaves) {
            const std::size_t first = (node + 1 - tree.leaves) * LEAF;
            for (std::size_t t = first; t < std::min(first + LEAF, triangles.size()); ++t)
                tree.nodes[node].add(tree.boxes[t]);
        } else {
            tree.nodes[node].add(tree.nodes[2 * node + 1]);
            tree.nodes[node].add(tree.nodes[2 * node + 2]);
        }
    }
    return tree;
}

/// The triangles of a leaf: from the first to before the last.
struct Leaf {
    std::size_t first, end;
};

Leaf leaf_of(std::size_t number, std::size_t triangles) {
    const std::size_t first = std::min(number * LEAF, triangles);
    return {first, std::min(first + LEAF, triangles)};
}

/// Looks for pairs below two nodes, numbered by one more than in the heap: 2 k and 2 k + 1 are the
/// children of k.
class Search {
  public:
    Search(const BoxTree& tree, std::size_t most) : tree_(tree), most_(most) {}

    Array<MeetingTriangles> run() {
        if (most_ > 0) below(1);
        return std::move(found_);
    }

  private:
    [[nodiscard]] bool is_done() const { return found_.size() >= most_; }
    [[nodiscard]] const Bounds& box(std::size_t node) const { return tree_.nodes[node - 1]; }

    /// What lies below a node, with itself.
    void below(std::size_t node) {
        if (node >= tree_.leaves) return in_leaves(node, node);
        below(2 * node);
        between(2 * node, 2 * node + 1);
        below(2 * node + 1);
    }

    /// What lies below one node with what lies below another, of the same level.
    void between(std::size_t one, std::size_t other) {
        if (is_done() || !overlap(box(one), box(other))) return;
        if (one >= tree_.leaves) return in_leaves(one, other);
        for (const std::size_t a : {2 * one, 2 * one + 1})
            for (const std::size_t b : {2 * other, 2 * other + 1}) between(a, b);
    }

    /// The pairs of two leaves that meet; of one leaf with itself each pair once.
    void in_leaves(std::size_t own, std::size_t other) {
        if (is_done()) return;
        const Leaf here = leaf_of(own - tree_.leaves, tree_.triangles.size());
        const Leaf there = leaf_of(other - tree_.leaves, tree_.triangles.size());
        for (std::size_t s = here.first; s < here.end; ++s) {
            if (!overlap(tree_.boxes[s], box(other))) continue;
            for (std::size_t t = std::max(there.first, s + 1); t < there.end; ++t)
                if (overlap(tree_.boxes[s], tree_.boxes[t]) &&
                    triangles_meet(tree_.triangles[s], tree_.triangles[t]))
                    found_.push_back({std::min(tree_.order[s], tree_.order[t]),
                                      std::max(tree_.order[s], tree_.order[t])});
        }
    }

    const BoxTree& tree_;
    std::size_t most_;
    Array<MeetingTriangles> found_;
};

}  // namespace

Array<MeetingTriangles> meeting_triangles(std::span<const Point3> points,
                                          std::span<const TriangleCorners> triangles,
                                          std::size_t most) {
    const BoxTree tree = tree_over(points, triangles);
    return Search(tree, most).run();
}

}  // namespace surfmesh
