// A binary heap of directed edges with a key: smallest key first.
//
// Stale entries are not removed; whoever pops one compares it with the front and drops it. Ties are
// broken by the edge, so that the order does not depend on the history of the heap.
#pragma once

#include "packing/front.hpp"
#include "values/array.hpp"

namespace surfmesh {

struct QueuedEdge {
    double key;
    FrontEdge edge;
};

class EdgeHeap {
  public:
    [[nodiscard]] bool empty() const { return entries_.empty(); }
    [[nodiscard]] std::size_t size() const { return entries_.size(); }
    void push(QueuedEdge added);
    /// Remove and return the smallest entry; there is one.
    QueuedEdge pop();

  private:
    /// Put an entry into place i, which is free, or above it.
    void rise(std::ptrdiff_t i, QueuedEdge added);

    Array<QueuedEdge> entries_;  // the children of i are 2 i + 1 and 2 i + 2
};

}  // namespace surfmesh
