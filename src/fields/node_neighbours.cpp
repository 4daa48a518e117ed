#include "fields/node_neighbours.hpp"

namespace surfmesh {

NodeNeighbours::NodeNeighbours(std::span<const Patch> patches, std::span<const JoinedNodes> joined,
                               std::size_t nodes)
    : patches_(patches), joined_(joined), first_(nodes, NIL) {
    next_.reserve(9 * patches.size());
    for (const Patch& patch : patches)
        for (const Node n : patch.node) {
            const auto place = static_cast<std::int32_t>(next_.size());
            next_.push_back(first_[n]);
            first_[n] = place;
        }
    if (joined.empty()) return;
    first_joined_.resize(nodes, NIL);
    next_joined_.reserve(2 * joined.size());
    for (const auto [a, b] : joined)
        for (const Node n : {a, b}) {
            const auto place = static_cast<std::int32_t>(next_joined_.size());
            next_joined_.push_back(first_joined_[n]);
            first_joined_[n] = place;
        }
}

void NodeNeighbours::collect(Node p, Array<Node>& found) const {
    found.clear();
    for_quarters(p, [&](const Quarter& k) {
        found.push_back(k.q);
        found.push_back(k.r);
    });
    const std::size_t count = found.size();
    for_quarters(p, [&](const Quarter& k) {  // the first corner of another quarter, as a rule
        for (std::size_t i = 0; i < count; i += 2)
            if (found[i] == k.s) return;
        found.push_back(k.s);
    });
    for_joined(p, [&](Node n) {
        if (n != p) found.push_back(n);
    });
}

}  // namespace surfmesh
