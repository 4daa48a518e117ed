// Gradation of sizes that depend on the direction: from one node to those around it.
//
// In: sizes of nodes along and across a unit tangent (see GradedSizes). A visit to a node lowers
// the sizes of its neighbours until their metrics contain that of the node, grown over the way:
// metrics are carried from one tangent plane to another, grow, and are intersected with those that
// are there (Alauzet 2010, section 3). Directions stay what they are.
#pragma once

#include <algorithm>

#include "fields/gradation.hpp"
#include "fields/node_neighbours.hpp"
#include "fields/size_queue.hpp"
#include "values/array.hpp"

namespace surfmesh {

/// A node with its sizes along and at right angles, the other axis of its tangent plane being left.
struct StretchedNode {
    Point3 point, normal, along, left;
    double longer, size;
    double by_longer, by_shorter;  // 1 / longer^2, 1 / size^2
};

class StretchedGradation {
  public:
    StretchedGradation(const GradedSizes& sizes, const NodeNeighbours& neighbours,
                       std::int32_t number);

    /// Sizes are spread in the order of the shorter ones.
    [[nodiscard]] double key(Node n) const { return std::min(s_.size[n], s_.longer[n]); }
    [[nodiscard]] bool is_level(const Quarter& /*quarter*/) const { return false; }  // not known
    void visit(Node p, SizeQueue& queue);

  private:
    /// A metric in the axes of a node, `along` first: 1 / size^2 in the diagonal.
    struct AxisMetric {
        double along, left, mixed;
    };

    StretchedNode& node(Node n);
    double bind(const StretchedNode& a, StretchedNode& b, bool is_round) const;
    static void set(StretchedNode& node, double size, double longer);
    [[nodiscard]] static AxisMetric carried(const StretchedNode& a, const StretchedNode& b);
    void hold_along(const StretchedNode& a, const StretchedNode& b, double most,
                    AxisMetric& m) const;

    GradedSizes s_;
    const NodeNeighbours& neighbours_;
    std::int32_t number_;
    Array<StretchedNode> nodes_;  // those that have been asked for; they do not move
    Array<std::int32_t> place_;   // of each node among them, or NIL
    Array<Node> around_;
};

}  // namespace surfmesh
