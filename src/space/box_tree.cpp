#include "space/box_tree.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "space/triangle_pairs.hpp"

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
std::int64_t bits_of(float x) {
    return x > 0.0F ? static_cast<std::int64_t>(std::min(x, 0x1p20F - 1.0F)) : 0;
}

struct FramePoint {
    float x, y, z;
};

/// Coordinates in the box of the points, from 0 to 2^20 along its longest side. Rounding keeps the
/// order of any two: boxes with a point in common have one in these coordinates too.
struct Frame {
    Point3 low;
    double scale;  // 0: no sides, or too long ones; then all is at 0

    FramePoint operator()(Point3 p) const {
        if (scale == 0.0) return {0.0F, 0.0F, 0.0F};
        const Point3 q = scale * (p - low) + Point3{0.0, 0.0, 0.0};  // no -0: see ``overlap``
        return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
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
    void add(FramePoint p) { add({{p.x, p.y, p.z, 0.0F}, {p.x, p.y, p.z, 0.0F}}); }
};

/// All comparisons at once, by the signs of differences, of equal ones +0 as none of them is -0:
/// which comparison decides cannot be foretold.
bool overlap(const Bounds& a, const Bounds& b) {
    std::int32_t signs = 0;
    for (int k = 0; k < 4; ++k)
        signs |= std::bit_cast<std::int32_t>(b.high[k] - a.low[k]) |
                 std::bit_cast<std::int32_t>(a.high[k] - b.low[k]);
    return signs >= 0;
}

/// The triangles of a leaf: from the first to before the last; of one patch, or all of none.
struct Leaf {
    std::size_t first, end;
    std::int32_t patch;
};

/// The boxes of a leaf, coordinate by coordinate: all are compared with another at once. Those
/// beyond its triangles have no inside.
struct LeafBoxes {
    float low[3][LEAF], high[3][LEAF];

    LeafBoxes() {
        constexpr float INFINITE = std::numeric_limits<float>::infinity();
        for (std::size_t k = 0; k < 3; ++k) {
            std::fill_n(low[k], LEAF, INFINITE);
            std::fill_n(high[k], LEAF, -INFINITE);
        }
    }
    void set(std::size_t place, const Bounds& box) {
        for (std::size_t k = 0; k < 3; ++k) {
            low[k][place] = box.low[k];
            high[k][place] = box.high[k];
        }
    }
    [[nodiscard]] Bounds operator[](std::size_t place) const {
        return {{low[0][place], low[1][place], low[2][place], 0.0F},
                {high[0][place], high[1][place], high[2][place], 0.0F}};
    }
};

/// Bit k: has the k-th box of a leaf a point in common with another? By signs, as ``overlap``.
std::uint32_t overlapping(const LeafBoxes& leaf, const Bounds& box) {
    const auto sign = [](float x) { return std::bit_cast<std::int32_t>(x); };
    const float low_x = box.low[0], low_y = box.low[1], low_z = box.low[2];
    const float high_x = box.high[0], high_y = box.high[1], high_z = box.high[2];
    constexpr std::int32_t BIT[LEAF] = {1, 2, 4, 8, 16, 32, 64, 128};
    std::int32_t found[LEAF];  // four by four, as the processor does
    for (std::size_t k = 0; k < LEAF; ++k) {
        const std::int32_t signs = sign(leaf.high[0][k] - low_x) | sign(high_x - leaf.low[0][k]) |
                                   sign(leaf.high[1][k] - low_y) | sign(high_y - leaf.low[1][k]) |
                                   sign(leaf.high[2][k] - low_z) | sign(high_z - leaf.low[2][k]);
        found[k] = ~(signs >> 31) & BIT[k];
    }
    std::int32_t both[LEAF / 2];
    for (std::size_t k = 0; k < LEAF / 2; ++k) both[k] = found[k] | found[k + LEAF / 2];
    return static_cast<std::uint32_t>(both[0] | both[1] | both[2] | both[3]);
}

/// A patch of all of several things: ANY of none, NIL where it is not one.
constexpr std::int32_t ANY = -2;
std::int32_t common_patch(std::int32_t a, std::int32_t b) {
    return a == ANY ? b : b == ANY || a == b ? a : NIL;
}

/// What lies below a node.
struct Node {
    Bounds box = Bounds::nothing();
    std::int32_t patch = ANY;  // of all triangles; NIL: not of one
};

/// The triangles in the order of the tree and their boxes, and the nodes over them.
struct BoxTree {
    Array<std::int32_t> order;  // numbers of the triangles
    Array<Leaf> leaves;
    std::vector<LeafBoxes> boxes;  // of each leaf
    std::vector<Node> nodes;
    std::size_t first_leaf = 1;  // number of its node; as many leaves have room
};

Array<FramePoint> in_frame(std::span<const Point3> points) {
    const Frame frame = frame_around(points);
    Array<FramePoint> framed;
    framed.reserve(points.size());
    for (const Point3 p : points) framed.push_back(frame(p));
    return framed;
}

/// Place of each triangle's centroid along the Z-order curve through the box of the points.
Array<std::int64_t> curve_places(const Array<FramePoint>& points,
                                 std::span<const TriangleCorners> triangles) {
    Array<std::int64_t> places;
    places.reserve(triangles.size());
    for (const TriangleCorners& t : triangles) {
        const FramePoint &a = points[t.a], &b = points[t.b], &c = points[t.c];
        constexpr float THIRD = 1.0F / 3.0F;
        places.push_back(spread(bits_of((a.x + b.x + c.x) * THIRD)) |
                         spread(bits_of((a.y + b.y + c.y) * THIRD)) << 1 |
                         spread(bits_of((a.z + b.z + c.z) * THIRD)) << 2);
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

/// Gather the triangles of each patch where the first of them is, those of none likewise.
Array<std::int32_t> patch_by_patch(const Array<std::int32_t>& order,
                                   std::span<const std::int32_t> patches) {
    if (patches.empty()) return order;
    const std::int32_t most = *std::max_element(patches.begin(), patches.end());
    Array<std::size_t> count(most + 2, 0), next(most + 2, 0);  // of those of none: first
    for (const std::int32_t patch : patches) ++count[patch + 1];
    Array<std::int32_t> gathered(order.size());
    std::size_t first = 0;
    for (const std::int32_t t : order) {
        const std::int32_t k = patches[t] + 1;
        if (count[k] > 0) {
            next[k] = first;
            first += count[k];
            count[k] = 0;
        }
        gathered[next[k]++] = t;
    }
    return gathered;
}

/// Leaves over the triangles, none of them across the end of a patch.
Array<Leaf> leaves_over(const Array<std::int32_t>& order, std::span<const std::int32_t> patches) {
    const auto patch_of = [&](std::size_t k) { return patches.empty() ? NIL : patches[order[k]]; };
    Array<Leaf> leaves;
    for (std::size_t k = 0; k < order.size();) {
        Leaf leaf{k, k + 1, patch_of(k)};
        while (leaf.end < std::min(k + LEAF, order.size()) && patch_of(leaf.end) == leaf.patch)
            ++leaf.end;
        leaves.push_back(leaf);
        k = leaf.end;
    }
    return leaves;
}

/// The nodes over the leaves, from these up. Node k is that before the k-th: 1 is the root.
void add_nodes(BoxTree& tree) {
    while (tree.first_leaf < tree.leaves.size()) tree.first_leaf *= 2;
    tree.nodes.resize(2 * tree.first_leaf);
    for (std::size_t k = 0; k < tree.leaves.size(); ++k) {
        Node& node = tree.nodes[tree.first_leaf + k];
        node.patch = tree.leaves[k].patch;
        const std::size_t count = tree.leaves[k].end - tree.leaves[k].first;
        for (std::size_t place = 0; place < count; ++place) node.box.add(tree.boxes[k][place]);
    }
    for (std::size_t k = tree.first_leaf; k-- > 1;) {
        const Node &one = tree.nodes[2 * k], &other = tree.nodes[2 * k + 1];
        tree.nodes[k] = one;
        tree.nodes[k].box.add(other.box);
        tree.nodes[k].patch = common_patch(one.patch, other.patch);
    }
}

BoxTree tree_over(std::span<const Point3> points, std::span<const TriangleCorners> triangles,
                  std::span<const std::int32_t> patches) {
    BoxTree tree;
    const Array<FramePoint> framed = in_frame(points);
    tree.order = patch_by_patch(sorted_numbers(curve_places(framed, triangles)), patches);
    tree.leaves = leaves_over(tree.order, patches);
    tree.boxes.resize(tree.leaves.size());
    for (std::size_t k = 0; k < tree.leaves.size(); ++k)
        for (std::size_t t = tree.leaves[k].first; t < tree.leaves[k].end; ++t) {
            const TriangleCorners& corners = triangles[tree.order[t]];
            Bounds box = Bounds::nothing();
            for (const Vertex corner : {corners.a, corners.b, corners.c}) box.add(framed[corner]);
            tree.boxes[k].set(t - tree.leaves[k].first, box);
        }
    add_nodes(tree);
    return tree;
}

/// Do all triangles belong to one patch? Most surfaces given by formulas do.
bool are_one_patch(std::span<const std::int32_t> patches) {
    if (patches.empty() || patches[0] == NIL) return false;
    return std::all_of(patches.begin(), patches.end(),
                       [&](std::int32_t patch) { return patch == patches[0]; });
}

/// Looks for pairs below two nodes: 2 k and 2 k + 1 are the children of k.
class Search {
  public:
    Search(std::span<const Point3> points, std::span<const TriangleCorners> triangles,
           std::span<const std::int32_t> patches, std::size_t most)
        : points_(points),
          triangles_(triangles),
          tree_(tree_over(points, triangles, patches)),
          most_(most) {
        keys_.reserve(points.size());
        for (const Point3 p : points) keys_.push_back(corner_key(p));
    }

    Array<MeetingTriangles> run() {
        if (most_ > 0) below(1);
        return std::move(found_);
    }

  private:
    [[nodiscard]] bool is_done() const { return found_.size() >= most_; }
    [[nodiscard]] const Bounds& box(std::size_t node) const { return tree_.nodes[node].box; }
    /// Do all triangles below two nodes belong to one patch?
    [[nodiscard]] bool are_of_one_patch(std::size_t one, std::size_t other) const {
        const std::int32_t patch = tree_.nodes[one].patch;
        return patch != NIL && patch == tree_.nodes[other].patch;
    }

    /// What lies below a node, with itself.
    void below(std::size_t node) {
        if (are_of_one_patch(node, node)) return;
        if (node >= tree_.first_leaf) return in_leaves(node, node);
        below(2 * node);
        if (may_meet(2 * node, 2 * node + 1)) between(2 * node, 2 * node + 1);
        below(2 * node + 1);
    }

    [[nodiscard]] bool may_meet(std::size_t one, std::size_t other) const {
        return overlap(box(one), box(other)) && !are_of_one_patch(one, other);
    }

    /// What lies below one node with what lies below another, of the same level, that may meet.
    void between(std::size_t one, std::size_t other) {
        if (is_done()) return;
        if (one >= tree_.first_leaf) return in_leaves(one, other);
        for (const std::size_t a : {2 * one, 2 * one + 1})
            for (const std::size_t b : {2 * other, 2 * other + 1})
                if (may_meet(a, b)) between(a, b);
    }

    /// The pairs of two leaves that meet; of one leaf with itself each pair once.
    void in_leaves(std::size_t own, std::size_t other) {
        const std::size_t a = own - tree_.first_leaf, b = other - tree_.first_leaf;
        if (is_done() || std::max(a, b) >= tree_.leaves.size()) return;
        const LeafBoxes &here = tree_.boxes[a], &there = tree_.boxes[b];
        const std::uint32_t near = overlapping(there, box(own));
        if (near == 0) return;
        for (std::uint32_t left = overlapping(here, box(other)); left != 0; left &= left - 1) {
            const auto place = static_cast<std::size_t>(std::countr_zero(left));
            const std::uint32_t later = own == other ? ~1U << place : ~0U;
            const std::uint32_t found = near & later & overlapping(there, here[place]);
            if (found != 0) look_at(tree_.leaves[a].first + place, tree_.leaves[b].first, found);
        }
    }

    /// One triangle with those at some places of a leaf: bits of ``places``.
    void look_at(std::size_t s, std::size_t first, std::uint32_t places) {
        const std::int32_t a = tree_.order[s];
        const KeyedTriangle own = keyed(a);
        for (; places != 0; places &= places - 1) {
            const auto place = static_cast<std::size_t>(std::countr_zero(places));
            const std::int32_t b = tree_.order[first + place];
            if (triangles_meet(own, keyed(b))) found_.push_back({std::min(a, b), std::max(a, b)});
        }
    }

    [[nodiscard]] KeyedTriangle keyed(std::int32_t triangle) const {
        const TriangleCorners& t = triangles_[triangle];
        return {{points_[t.a], points_[t.b], points_[t.c]}, {keys_[t.a], keys_[t.b], keys_[t.c]}};
    }

    std::span<const Point3> points_;
    std::span<const TriangleCorners> triangles_;
    BoxTree tree_;
    Array<std::uint32_t> keys_;  // of the points
    std::size_t most_;
    Array<MeetingTriangles> found_;
};

}  // namespace

Array<MeetingTriangles> meeting_triangles(std::span<const Point3> points,
                                          std::span<const TriangleCorners> triangles,
                                          std::span<const std::int32_t> patches, std::size_t most) {
    if (are_one_patch(patches)) return {};
    return Search(points, triangles, patches, most).run();
}

}  // namespace surfmesh
