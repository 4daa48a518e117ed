#include "packing/edge_heap.hpp"

namespace surfmesh {
namespace {

bool is_before(const QueuedEdge& p, const QueuedEdge& q) {
    if (p.key != q.key) return p.key < q.key;
    if (p.edge.a != q.edge.a) return p.edge.a < q.edge.a;
    return p.edge.b < q.edge.b;
}

}  // namespace

void EdgeHeap::push(QueuedEdge added) {
    entries_.push_back(added);
    rise(static_cast<std::ptrdiff_t>(entries_.size()) - 1, added);
}

void EdgeHeap::rise(std::ptrdiff_t i, QueuedEdge added) {
    while (i > 0) {
        const std::ptrdiff_t parent = (i - 1) / 2;
        if (!is_before(added, entries_[parent])) break;
        entries_[i] = entries_[parent];
        i = parent;
    }
    entries_[i] = added;
}

// The hole left by the top sinks along the smaller children to the bottom; the last entry, which
// comes from there, most often belongs not far above it.
QueuedEdge EdgeHeap::pop() {
    const QueuedEdge top = entries_[0], last = entries_.pop_back();
    const auto n = static_cast<std::ptrdiff_t>(entries_.size());
    if (n == 0) return top;
    QueuedEdge* const entries = entries_.data();
    std::ptrdiff_t i = 0;
    for (std::ptrdiff_t child = 1; child < n; child = 2 * i + 1) {
        child += child + 1 < n && is_before(entries[child + 1], entries[child]);
        entries[i] = entries[child];
        i = child;
    }
    rise(i, last);
    return top;
}

}  // namespace surfmesh
