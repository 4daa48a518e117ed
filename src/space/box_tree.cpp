#include "space/box_tree.hpp"

#include <algorithm>
#include <limits>

namespace surfmesh {
namespace {

// triangles in a leaf: a test of four boxes costs what a level of the tree does
constexpr std::size_t LEAF = 4;

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

/// A box in space, borders included; without an inside where it holds nothing.
struct Bounds {
    double low[3], high[3];

    static Bounds nothing() {
        constexpr double INFINITE = std::numeric_limits<double>::infinity();
        return {{INFINITE, INFINITE, INFINITE}, {-INFINITE, -INFINITE, -INFINITE}};
    }
    void add(const Bounds& other) {
        for (int k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], other.low[k]);
            high[k] = std::max(high[k], other.high[k]);
        }
    }
    void add(Point3 p) { add({{p.x, p.y, p.z}, {p.x, p.y, p.z}}); }
};

/// All six comparisons, without a branch: which of them decides cannot be foretold.
bool overlap(const Bounds& a, const Bounds& b) {
    bool all = true;
    for (int k = 0; k < 3; ++k)
        all &= static_cast<int>(a.low[k] <= b.high[k]) & static_cast<int>(b.low[k] <= a.high[k]);
    return all;
}

/// The boxes around triangles, and around what lies below each node of the tree over them.
struct BoxTree {
    Array<Bounds> boxes;
    Array<Bounds> nodes;
    std::size_t leaves = 1;
    int depth = 0;
};

BoxTree tree_over(std::span<const Triangle3> triangles) {
    BoxTree tree;
    while (tree.leaves * LEAF < triangles.size()) {
        tree.leaves *= 2;
        ++tree.depth;
    }
    tree.boxes.resize(triangles.size(), Bounds::nothing());
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (const Point3 corner : triangles[t]) tree.boxes[t].add(corner);
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

/// Add the pairs of two leaves that meet; of one leaf with itself each pair once.
void add_meetings_of(std::span<const Triangle3> triangles, const BoxTree& tree, std::size_t own,
                     std::size_t other, Array<MeetingTriangles>& found) {
    const Leaf here = leaf_of(own, triangles.size()), there = leaf_of(other, triangles.size());
    const Bounds& around = tree.nodes[tree.leaves - 1 + other];
    for (std::size_t s = here.first; s < here.end; ++s) {
        if (!overlap(tree.boxes[s], around)) continue;
        for (std::size_t t = std::max(there.first, s + 1); t < there.end; ++t)
            if (overlap(tree.boxes[s], tree.boxes[t]) && triangles_meet(triangles[s], triangles[t]))
                found.push_back({static_cast<std::int32_t>(s), static_cast<std::int32_t>(t)});
    }
}

/// Add the pairs of a leaf's triangles and those after them that meet.
void add_meetings(std::span<const Triangle3> triangles, const BoxTree& tree, std::size_t leaf,
                  Array<MeetingTriangles>& found) {
    const std::size_t own = tree.leaves + leaf;  // by one more than its node, as is ``node``
    const Bounds box = tree.nodes[own - 1];
    std::size_t node = 1;
    int above = tree.depth;  // levels down to the leaves
    while (true) {
        // what ends before the own leaf has met it already
        const bool near = node >= own >> above && overlap(box, tree.nodes[node - 1]);
        if (near && above > 0) {
            node *= 2;
            --above;
            continue;
        }
        if (near) add_meetings_of(triangles, tree, leaf, node - tree.leaves, found);
        while (node % 2 == 1 && node > 1) {  // done with a right child: up
            node /= 2;
            ++above;
        }
        if (node == 1) return;
        ++node;
    }
}

}  // namespace

Array<std::int64_t> curve_places(std::span<const Point3> points,
                                 std::span<const TriangleCorners> triangles, Point3 low,
                                 double scale) {
    Array<std::int64_t> places;
    places.reserve(triangles.size());
    for (const TriangleCorners& t : triangles) {
        Point3 sum{0.0, 0.0, 0.0};
        for (const Vertex v : {t.a, t.b, t.c}) sum = sum + scale * (points[v] - low);
        std::int64_t place = 0;
        int bit = 0;
        for (const double s : {sum.x, sum.y, sum.z}) place |= spread(bits_of(s / 3.0)) << bit++;
        places.push_back(place);
    }
    return places;
}

Array<MeetingTriangles> meeting_triangles(std::span<const Triangle3> triangles, std::size_t most) {
    const BoxTree tree = tree_over(triangles);
    Array<MeetingTriangles> found;
    for (std::size_t leaf = 0; leaf * LEAF < triangles.size() && found.size() < most; ++leaf)
        add_meetings(triangles, tree, leaf, found);
    return found;
}

}  // namespace surfmesh
