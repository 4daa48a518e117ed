// Nodes whose sizes are to be spread, the smallest first.
//
// A node that is lowered while it waits moves forward. Ties are broken by the node, so that the
// order does not depend on the history of the queue. A node is put in anew when what it has been
// lowered by since it was taken out adds up to more than a tolerance: less is not spread.
//
// Where cells are so sheared that what is spread comes back to where it came from, nodes are lowered
// little by little, and each time all that depends on them. So the tolerance of a node that has been
// taken out often doubles each time, up to what nobody notices, once most nodes have been.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "fields/background.hpp"
#include "values/array.hpp"

namespace surfmesh {

class SizeQueue {
  public:
    SizeQueue(std::size_t nodes, double tolerance)
        : waits_with_(nodes, NOT_WAITING),
          unspread_(nodes, 0.0),
          taken_(nodes, 0),
          tolerance_(tolerance) {}

    /// Put in a node before `start`. What is no number is not spread.
    void seed(Node node, double size) {
        if (waits_with_[node] != NOT_WAITING || std::isnan(size)) return;
        waits_with_[node] = size;
        seeds_.push_back({size, node});
    }
    void start() { std::sort(seeds_.begin(), seeds_.end(), IsBefore()); }
    /// A node is lowered to a size, by a relative change.
    void lowered(Node node, double size, double change) {
        unspread_[node] += change;
        if (unspread_[node] <= tolerance(node) || !(size < waits_with_[node])) return;
        waits_with_[node] = size;
        heap_.push_back({size, node});
        std::push_heap(heap_.begin(), heap_.end(), IsAfter());
    }
    /// The next node to be spread, or NIL.
    Node take() {
        while (next_ < seeds_.size() || !heap_.empty()) {
            const auto [size, node] = first();
            if (size != waits_with_[node]) continue;  // it has moved forward
            waits_with_[node] = NOT_WAITING;
            unspread_[node] = 0.0;
            if (taken_[node] < COUNTED) ++taken_[node];
            ++in_all_;
            return node;
        }
        return NIL;
    }

  private:
    static constexpr double NOT_WAITING = std::numeric_limits<double>::infinity();

    // Times that a node is taken out before its tolerance doubles, and what that is at most.
    static constexpr std::uint8_t OFTEN = 8, COUNTED = 64;
    static constexpr std::size_t MANY = 1;  // times the number of nodes are taken out before that
    static constexpr double UNNOTICED = 1.28e-4;

    struct Entry {
        double size;
        Node node;
    };
    // Objects rather than functions: sorts and heaps take their calls in.
    struct IsBefore {
        bool operator()(const Entry& a, const Entry& b) const {
            return a.size < b.size || (a.size == b.size && a.node < b.node);
        }
    };
    struct IsAfter {
        bool operator()(const Entry& a, const Entry& b) const { return IsBefore()(b, a); }
    };

    [[nodiscard]] double tolerance(Node node) const {
        if (taken_[node] <= OFTEN || tolerance_ >= UNNOTICED || in_all_ < MANY * taken_.size())
            return tolerance_;
        return std::min(std::ldexp(tolerance_, taken_[node] - OFTEN), UNNOTICED);
    }

    /// The smaller of the first seed and the top of the heap, taken out.
    Entry first() {
        const bool is_seed = next_ < seeds_.size();
        if (is_seed && (heap_.empty() || IsBefore()(seeds_[next_], heap_[0])))
            return seeds_[next_++];
        std::pop_heap(heap_.begin(), heap_.end(), IsAfter());
        return heap_.pop_back();
    }

    Array<Entry> seeds_;  // in order, of which those before `next_` are taken
    Array<Entry> heap_;   // nodes that are lowered
    std::size_t next_ = 0;
    Array<double> waits_with_;   // size with which a node stands in the queue
    Array<double> unspread_;     // relative changes since it was taken out, added up
    Array<std::uint8_t> taken_;  // how often it was taken out, no further than counts
    std::size_t in_all_ = 0;     // times that any was
    double tolerance_;
};

}  // namespace surfmesh
