// Work on blocks of a range by several threads of one call.
//
// In: how many elements there are, how many make a block, and work on [first, last). Blocks are
// the same whatever the number of threads, and work must write only what belongs to its own block:
// so the result is the same, bit for bit, however many threads there are and in whatever order
// they take the blocks. Nothing is handed from one block to another.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <vector>

#include "values/array.hpp"

namespace surfmesh {

/// How many threads work that this thread begins may use; 1 in every new thread.
inline int& allowed_threads() {
    thread_local int count = 1;
    return count;
}

/// Call work() in this thread and in ``threads`` - 1 others at the same time, in fewer where the
/// system gives no more. Throws what one of them has thrown first, when all have come to an end.
void run_by_threads(std::size_t threads, const std::function<void()>& work);

/// Call work(first, last) for blocks of [0, count). Throws what work
/// throws, when the others are done.
template <class Work>
void for_each_block(std::size_t count, std::size_t block, const Work& work) {
    const std::size_t blocks = (count + block - 1) / block;
    const auto take = [&](std::size_t k) { work(k * block, std::min(count, (k + 1) * block)); };
    const std::size_t threads =
        std::min(blocks, static_cast<std::size_t>(std::max(1, allowed_threads())));
    if (threads < 2) {
        for (std::size_t k = 0; k < blocks; ++k) take(k);
        return;
    }
    std::atomic<std::size_t> next = 0;
    run_by_threads(threads, [&] {
        for (std::size_t k = next++; k < blocks; k = next++) take(k);
    });
}

/// So many are copied before another thread has begun.
inline constexpr std::size_t FEW_VALUES = 1 << 16;

/// What work(first, last, found) adds to ``found``, for blocks of [0, count) in their order.
template <class Value, class Work>
Array<Value> collect_by_blocks(std::size_t count, std::size_t block, const Work& work) {
    std::vector<Array<Value>> found((count + block - 1) / block);
    for_each_block(count, block, [&](std::size_t first, std::size_t last) {
        Array<Value> own;
        work(first, last, own);
        found[first / block].swap(own);
    });
    if (found.size() == 1) return std::move(found[0]);
    std::vector<std::size_t> start(1, 0);
    for (const Array<Value>& some : found) start.push_back(start.back() + some.size());
    Array<Value> all = Array<Value>::unfilled(start.back());
    for_each_block(found.size(), start.back() < FEW_VALUES ? found.size() + 1 : 1,
                   [&](std::size_t first, std::size_t last) {
                       for (std::size_t k = first; k < last; ++k)
                           std::copy(found[k].begin(), found[k].end(), all.begin() + start[k]);
                   });
    return all;
}

}  // namespace surfmesh
