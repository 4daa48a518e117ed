// The nodes of a field under construction: which a cell has, and which meet across joined sides.
#include <algorithm>

#include "fields/field_builder.hpp"
#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t NODES_AT_ONCE = 250'000;  // whose sizes are asked for at a time
constexpr std::size_t NODES_TO_CONVERT = 4096;
constexpr double SAME_PLACE = 1e-9;  // along a side, of its length
constexpr int MIDDLE = 4;            // of a patch

/// A node that does not exist yet.
struct AskedNode {
    std::int64_t key;
    Turn turn;
};

bool has_smaller_key(const AskedNode& a, const AskedNode& b) { return a.key < b.key; }

/// What a patch has in place of a node that waits for its number; and the turn, given that.
constexpr std::int32_t waiting_for(std::int32_t turn) { return -2 - turn; }

}  // namespace

std::int64_t FieldBuilder::stride() const {
    return (std::int64_t{plan_.grid.ny} << (GRID_DEPTH + 1)) + 1;
}

/// The far sides of the domain are met exactly.
Point2 FieldBuilder::place_of(std::int64_t x, std::int64_t y) const {
    const auto across = static_cast<double>(std::int64_t{plan_.grid.nx} << (GRID_DEPTH + 1));
    const auto up = static_cast<double>(std::int64_t{plan_.grid.ny} << (GRID_DEPTH + 1));
    return {static_cast<double>(x) / across * plan_.extent.x,
            static_cast<double>(y) / up * plan_.extent.y};
}

Array<Point2> FieldBuilder::plane() const {
    Array<Point2> found;
    for (const std::int64_t key : key_) found.push_back(place_of(key / stride(), key % stride()));
    return found;
}

/// The nodes that the patches of the leaves from `first` on lack, creating those that do not exist
/// yet, which are numbered by their keys.
bool FieldBuilder::make_patches(std::size_t first, NodeLaw& law) {
    const auto leaves = cells_.leaves();
    const std::int64_t step = stride();
    Array<AskedNode> asked;
    for (std::size_t k = first; k < leaves.size(); ++k) {
        const FieldCell& cell = leaves[k];
        for (int i = 0; i < 9; ++i) {
            Node& node = patches_[k].node[i];
            if (node != NIL) continue;
            const std::int64_t key =
                (cell.x + cell.half() * (i % 3)) * step + cell.y + cell.half() * (i / 3);
            Turn alone = NIL;  // nobody else asks for the node in the middle
            Turn& turn = i == MIDDLE ? alone : turn_[key];
            if (turn == NIL) {
                turn = static_cast<Turn>(number_in_turn_.size());
                number_in_turn_.push_back(NIL);
                asked.push_back({key, turn});
            }
            node = waiting_for(turn);
        }
    }
    std::sort(asked.begin(), asked.end(), has_smaller_key);
    Array<std::int64_t> keys;
    for (const AskedNode& one : asked) {
        number_in_turn_[one.turn] = static_cast<Node>(key_.size() + keys.size());
        keys.push_back(one.key);
    }
    if (!create(keys, law)) return false;
    for (std::size_t k = first; k < leaves.size(); ++k)
        for (Node& node : patches_[k].node)
            if (node < 0) node = number_in_turn_[waiting_for(node)];
    return true;
}

bool FieldBuilder::create(std::span<const std::int64_t> keys, NodeLaw& law) {
    Array<Point2> xy;
    for (const std::int64_t key : keys) xy.push_back(place_of(key / stride(), key % stride()));
    for (std::size_t first = 0; first < keys.size(); first += NODES_AT_ONCE) {
        const std::size_t some = std::min(NODES_AT_ONCE, keys.size() - first);
        FieldNodes fresh;
        if (!law.ask({xy.data() + first, some}, fresh)) return false;
        if (fresh.count() != some || !fresh.is_complete()) return false;
        if (nodes.count() > 0 && nodes.is_anisotropic() != fresh.is_anisotropic()) return false;
        nodes.append(fresh);
    }
    const std::int64_t end_x = std::int64_t{plan_.grid.nx} << (GRID_DEPTH + 1);
    const std::int64_t end_y = std::int64_t{plan_.grid.ny} << (GRID_DEPTH + 1);
    for (const std::int64_t key : keys) {
        const auto node = static_cast<Node>(key_.size());
        key_.push_back(key);
        const std::int64_t x = key / stride(), y = key % stride();
        const double tx = static_cast<double>(x) / static_cast<double>(end_x);
        const double ty = static_cast<double>(y) / static_cast<double>(end_y);
        if (y == 0) side_[0].push_back({tx, node});
        if (x == end_x) side_[1].push_back({ty, node});
        if (y == end_y) side_[2].push_back({tx, node});
        if (x == 0) side_[3].push_back({ty, node});
    }
    find_joined();
    return true;
}

/// Pairs of nodes next to each other, or one point in space, across joined sides.
void FieldBuilder::find_joined() {
    joined_.clear();
    for (int a = 0; a < 4; ++a) {
        const int b = plan_.partner[a];
        if (b >= a) join_sides(a, b);  // else there is none, or it is seen from the other side
    }
}

void FieldBuilder::join_sides(int a, int b) {
    const auto along = [](const SideNode& p, const SideNode& q) { return p.t < q.t; };
    for (const int side : {a, b}) std::sort(side_[side].begin(), side_[side].end(), along);
    const Array<SideNode> one = side_[a];
    Array<SideNode> other = side_[b];
    if (plan_.reversed[a])
        for (SideNode& node : other) node.t = 1.0 - node.t;
    const auto join = [&](const Array<SideNode>& from, Array<SideNode> to) {
        std::sort(to.begin(), to.end(), along);
        const auto last = static_cast<std::ptrdiff_t>(to.size()) - 1;
        for (const std::ptrdiff_t which : {-1, 0})  // the two nodes across, or the same point
            for (const SideNode& node : from) {
                const SideNode least{node.t - SAME_PLACE, NIL};
                const auto after = std::lower_bound(to.begin(), to.end(), least, along);
                const std::ptrdiff_t k =
                    std::clamp<std::ptrdiff_t>(after - to.begin() + which, 0, last);
                joined_.push_back({node.node, to[k].node});
            }
    };
    join(one, other);
    join(other, one);
}

Background FieldBuilder::background() {
    const std::size_t leaves = cells_.leaves().size();
    nodes.put_in_order();
    cells_.split_all();
    Background made;
    made.box = {0.0, 0.0, 1.0 / plan_.root_step.x, 1.0 / plan_.root_step.y, plan_.largest};
    made.grid = plan_.grid;
    made.child = cells_.child();
    made.corner.resize(made.child.size(), CellCorners{});
    const std::size_t first = made.child.size() - 4 * leaves;
    for (std::size_t k = 0; k < leaves; ++k)
        for (std::size_t q = 0; q < 4; ++q)
            for (std::size_t c = 0; c < 4; ++c)
                made.corner[first + 4 * k + q].node[c] =
                    patches_[k].node[CORNERS_OF_CHILDREN[q][c]];
    made.metric_root.resize(nodes.count());
    for_each_block(nodes.count(), NODES_TO_CONVERT, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
            made.metric_root[n] = {nodes.metric_root(n), 1.0 / nodes.size[n]};
    });
    made.metric_root_3d = nodes.metric_roots_3d();
    return made;
}

}  // namespace surfmesh
