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

// boxes in a group: a test of all of them costs little more than one of a single box
constexpr std::size_t WIDTH = 8;

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
        const Point3 q = scale * (p - low) + Point3{0.0, 0.0, 0.0};  // no -0: see ``overlapping``
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

/// The triangles of a leaf: from the first to before the last; of one patch, or all of none.
struct Leaf {
    std::size_t first, end;
    std::int32_t patch;
};

/// A group of boxes, coordinate by coordinate: all are compared with another at once. Those
/// that are not set have no inside.
struct BoxGroup {
    float low[3][WIDTH], high[3][WIDTH];

    BoxGroup() {
        constexpr float INFINITE = std::numeric_limits<float>::infinity();
        for (std::size_t k = 0; k < 3; ++k) {
            std::fill_n(low[k], WIDTH, INFINITE);
            std::fill_n(high[k], WIDTH, -INFINITE);
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

/// Bit k: has the k-th box of a group a point in common with another? All comparisons at once, by the
/// signs of differences, of equal ones +0 as none of them is -0: which comparison decides cannot be
/// foretold.
std::uint32_t overlapping(const BoxGroup& group, const Bounds& box) {
    const auto sign = [](float x) { return std::bit_cast<std::int32_t>(x); };
    const float low_x = box.low[0], low_y = box.low[1], low_z = box.low[2];
    const float high_x = box.high[0], high_y = box.high[1], high_z = box.high[2];
    constexpr std::int32_t BIT[WIDTH] = {1, 2, 4, 8, 16, 32, 64, 128};
    std::int32_t found[WIDTH];  // four by four, as the processor does
    for (std::size_t k = 0; k < WIDTH; ++k) {
        const std::int32_t signs = sign(group.high[0][k] - low_x) | sign(high_x - group.low[0][k]) |
                                   sign(group.high[1][k] - low_y) | sign(high_y - group.low[1][k]) |
                                   sign(group.high[2][k] - low_z) | sign(high_z - group.low[2][k]);
        found[k] = ~(signs >> 31) & BIT[k];
    }
    std::int32_t both[WIDTH / 2];
    for (std::size_t k = 0; k < WIDTH / 2; ++k) both[k] = found[k] | found[k + WIDTH / 2];
    return static_cast<std::uint32_t>(both[0] | both[1] | both[2] | both[3]);
}

/// A patch of all of several things: ANY of none, NIL where it is not one.
constexpr std::int32_t ANY = -2;
std::int32_t common_patch(std::int32_t a, std::int32_t b) {
    return a == ANY ? b : b == ANY || a == b ? a : NIL;
}

/// Groups of eight boxes, those of the triangles of a leaf or of groups of the level below: group k
/// holds the boxes of the groups 8 k to 8 k + 7.
struct Level {
    std::vector<BoxGroup> groups;
    std::vector<Bounds> around;   // each group
    Array<std::int32_t> patches;  // of all triangles below each group; NIL: not of one
};

/// The triangles in the order of the tree, and the levels over them, the lowest first: each of its
/// groups is a leaf. The highest is one group.
struct BoxTree {
    Array<std::int32_t> order;  // numbers of the triangles
    Array<Leaf> leaves;
    std::vector<Level> levels;
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

/// The numbers of places in their order, a digit after the other: as far as twelve bits of each
/// coordinate tell them apart, others as they are.
Array<std::int32_t> sorted_numbers(const Array<std::int64_t>& places) {
    constexpr int BITS = 12, IGNORED_BITS = 24, ALL_BITS = 60;
    constexpr std::int64_t DIGITS = 1 << BITS;
    Array<std::int32_t> order(places.size()), next(places.size());
    std::iota(order.begin(), order.end(), 0);
    for (int shift = IGNORED_BITS; shift < ALL_BITS; shift += BITS) {
        const auto digit = [&](std::int64_t place) { return place >> shift & (DIGITS - 1); };
        Array<std::size_t> first(DIGITS + 1, 0);
        for (const std::int64_t place : places) ++first[digit(place) + 1];
        for (std::int64_t d = 0; d < DIGITS; ++d) first[d + 1] += first[d];
        for (const std::int32_t i : order) next[first[digit(places[i])]++] = i;
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
        while (leaf.end < std::min(k + WIDTH, order.size()) && patch_of(leaf.end) == leaf.patch)
            ++leaf.end;
        leaves.push_back(leaf);
        k = leaf.end;
    }
    return leaves;
}

/// The leaves as groups of boxes.
Level leaf_level(const BoxTree& tree, const Array<FramePoint>& points,
                 std::span<const TriangleCorners> triangles) {
    Level level;
    level.groups.resize(tree.leaves.size());
    level.around.reserve(tree.leaves.size());
    for (std::size_t k = 0; k < tree.leaves.size(); ++k) {
        const Leaf& leaf = tree.leaves[k];
        Bounds all = Bounds::nothing();
        for (std::size_t t = leaf.first; t < leaf.end; ++t) {
            const TriangleCorners& corners = triangles[tree.order[t]];
            Bounds box = Bounds::nothing();
            for (const Vertex corner : {corners.a, corners.b, corners.c}) box.add(points[corner]);
            level.groups[k].set(t - leaf.first, box);
            all.add(box);
        }
        level.around.push_back(all);
        level.patches.push_back(leaf.patch);
    }
    return level;
}

/// Groups over those of a level.
Level level_over(const Level& below) {
    Level level;
    level.groups.resize((below.groups.size() + WIDTH - 1) / WIDTH);
    level.around.resize(level.groups.size(), Bounds::nothing());
    level.patches.resize(level.groups.size(), ANY);
    for (std::size_t k = 0; k < below.groups.size(); ++k) {
        level.groups[k / WIDTH].set(k % WIDTH, below.around[k]);
        level.around[k / WIDTH].add(below.around[k]);
        level.patches[k / WIDTH] = common_patch(level.patches[k / WIDTH], below.patches[k]);
    }
    return level;
}

BoxTree tree_over(std::span<const Point3> points, std::span<const TriangleCorners> triangles,
                  std::span<const std::int32_t> patches) {
    BoxTree tree;
    const Array<FramePoint> framed = in_frame(points);
    tree.order = patch_by_patch(sorted_numbers(curve_places(framed, triangles)), patches);
    tree.leaves = leaves_over(tree.order, patches);
    tree.levels.push_back(leaf_level(tree, framed, triangles));
    while (tree.levels.back().groups.size() > 1)
        tree.levels.push_back(level_over(tree.levels.back()));
    return tree;
}

/// Do all triangles belong to one patch? Most surfaces given by formulas do.
bool are_one_patch(std::span<const std::int32_t> patches) {
    if (patches.empty() || patches[0] == NIL) return false;
    return std::all_of(patches.begin(), patches.end(),
                       [&](std::int32_t patch) { return patch == patches[0]; });
}

/// Looks for pairs below two groups of a level.
class Search {
  public:
    Search(std::span<const Point3> points, std::span<const TriangleCorners> triangles,
           std::span<const std::int32_t> patches, std::span<const SupportingPatches> support,
           std::size_t most)
        : points_(points),
          triangles_(triangles),
          support_(support),
          tree_(tree_over(points, triangles, patches)),
          most_(most) {}

    Array<MeetingTriangles> run() {
        if (most_ > 0 && !triangles_.empty()) within(tree_.levels.size() - 1, 0);
        return std::move(found_);
    }

  private:
    [[nodiscard]] bool is_done() const { return found_.size() >= most_; }
    /// Do all triangles below each of two groups of a level belong to one patch, and these patches,
    /// or this one, surely not meet?
    [[nodiscard]] bool are_apart(std::size_t level, std::size_t a, std::size_t b) const {
        const std::int32_t own = tree_.levels[level].patches[a];
        const std::int32_t other = tree_.levels[level].patches[b];
        if (own == NIL || other == NIL) return false;
        return own == other || supports(own, other) || supports(other, own);
    }
    [[nodiscard]] bool supports(std::int32_t flat, std::int32_t patch) const {
        if (support_.empty()) return false;
        const SupportingPatches& there = support_[patch];
        return std::find(there.begin(), there.end(), flat) != there.end();
    }

    /// What lies below a group, with itself.
    void within(std::size_t level, std::size_t group) {
        if (are_apart(level, group, group)) return;
        if (level > 0)
            for (std::size_t k = 0; k < WIDTH; ++k)
                if (const std::size_t child = WIDTH * group + k; child < groups_below(level))
                    within(level - 1, child);
        between(level, group, group);
    }
    [[nodiscard]] std::size_t groups_below(std::size_t level) const {
        return tree_.levels[level - 1].groups.size();
    }

    /// What lies below one group with what lies below another that may meet it: pairs of their boxes
    /// that have a point in common; of a group with itself each pair of two boxes once.
    void between(std::size_t level, std::size_t own, std::size_t other) {
        const Level& here = tree_.levels[level];
        const BoxGroup &a = here.groups[own], &b = here.groups[other];
        const std::uint32_t near = overlapping(b, here.around[own]);
        if (near == 0) return;
        for (std::uint32_t left = overlapping(a, here.around[other]); left != 0; left &= left - 1) {
            if (is_done()) return;
            const auto place = static_cast<std::size_t>(std::countr_zero(left));
            const std::uint32_t later = own == other ? ~1U << place : ~0U;
            const std::uint32_t found = near & later & overlapping(b, a[place]);
            if (found == 0) continue;
            if (level == 0)
                look_at(tree_.leaves[own].first + place, tree_.leaves[other].first, found);
            else
                go_down(level - 1, WIDTH * own + place, WIDTH * other, found);
        }
    }

    /// One group with those at some places of a group of the level above: bits of ``places``.
    void go_down(std::size_t level, std::size_t one, std::size_t first, std::uint32_t places) {
        for (; places != 0; places &= places - 1) {
            const std::size_t other = first + static_cast<std::size_t>(std::countr_zero(places));
            if (!are_apart(level, one, other)) between(level, one, other);
        }
    }

    /// One triangle with those at some places of a leaf: bits of ``places``.
    void look_at(std::size_t s, std::size_t first, std::uint32_t places) {
        const std::int32_t a = tree_.order[s];
        const TriangleCorners own = triangles_[a];
        for (; places != 0; places &= places - 1) {
            const auto place = static_cast<std::size_t>(std::countr_zero(places));
            const std::int32_t b = tree_.order[first + place];
            if (are_parted_neighbours(points_, own, triangles_[b])) continue;
            if (triangles_meet(in_space(own), in_space(triangles_[b])))
                found_.push_back({std::min(a, b), std::max(a, b)});
        }
    }

    [[nodiscard]] Triangle3 in_space(const TriangleCorners& t) const {
        return {points_[t.a], points_[t.b], points_[t.c]};
    }

    std::span<const Point3> points_;
    std::span<const TriangleCorners> triangles_;
    std::span<const SupportingPatches> support_;
    BoxTree tree_;
    std::size_t most_;
    Array<MeetingTriangles> found_;
};

}  // namespace

Array<MeetingTriangles> meeting_triangles(std::span<const Point3> points,
                                          std::span<const TriangleCorners> triangles,
                                          std::span<const std::int32_t> patches,
                                          std::span<const SupportingPatches> support,
                                          std::size_t most) {
    if (are_one_patch(patches)) return {};
    return Search(points, triangles, patches, support, most).run();
}

}  // namespace surfmesh
