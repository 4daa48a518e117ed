// Which nodes of a field are neighbours: the corners of one quarter of a patch, and nodes that meet
// across joined sides.
//
// In: patches of nine nodes (see fields/gradation.hpp) and pairs of nodes across joints. Out: the
// quarters that a node is a corner of, and its joined nodes. Kept are lists of the places of a node
// in patches: each place knows the next.
//
//         s --- r        a quarter as its corner p sees it, counter-clockwise
//         |     |
//         p --- q
#pragma once

#include <span>

#include "fields/gradation.hpp"
#include "values/array.hpp"
#include "values/conventions.hpp"

namespace surfmesh {

struct Quarter {
    Node p, q, r, s;
};

inline constexpr int CORNERS_OF_QUARTERS[4][4] = {
    {0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}, {4, 5, 8, 7}};

class NodeNeighbours {
  public:
    NodeNeighbours(std::span<const Patch> patches, std::span<const JoinedNodes> joined,
                   std::size_t nodes);

    /// Call work(quarter) for the quarters around p.
    template <class Work>
    void for_quarters(Node p, const Work& work) const {
        for (std::int32_t place = first_[p]; place != NIL; place = next_[place]) {
            const Node* const node = patches_[place / 9].node;
            for (const int* c = OTHERS[place % 9]; c[0] >= 0; c += 3)
                work(Quarter{p, node[c[0]], node[c[1]], node[c[2]]});
        }
    }
    /// Call work(node) for those that p is joined with.
    template <class Work>
    void for_joined(Node p, const Work& work) const {
        if (first_joined_.empty()) return;
        for (std::int32_t k = first_joined_[p]; k != NIL; k = next_joined_[k])
            work(k % 2 == 0 ? joined_[k / 2].b : joined_[k / 2].a);
    }
    /// All neighbours of p.
    void collect(Node p, Array<Node>& found) const;

  private:
    /// Of each place in a patch: q, r, s of the quarters that it is a corner of.
    static constexpr int OTHERS[9][13] = {{1, 4, 3, -1},
                                          {2, 5, 4, 4, 3, 0, -1},
                                          {5, 4, 1, -1},
                                          {4, 7, 6, 0, 1, 4, -1},
                                          {5, 8, 7, 7, 6, 3, 3, 0, 1, 1, 2, 5, -1},
                                          {8, 7, 4, 4, 1, 2, -1},
                                          {3, 4, 7, -1},
                                          {6, 3, 4, 4, 5, 8, -1},
                                          {7, 4, 5, -1}};

    std::span<const Patch> patches_;
    std::span<const JoinedNodes> joined_;
    Array<std::int32_t> first_, next_;                // places: 9 patch + node of the patch
    Array<std::int32_t> first_joined_, next_joined_;  // likewise: 2 pair + end
};

}  // namespace surfmesh
