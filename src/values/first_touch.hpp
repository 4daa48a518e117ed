// Large arrays whose memory is touched first by the threads that fill it.
//
// The system hands out a page of memory when it is first written: of large arrays that takes longer
// than the writing, and one thread alone would do it for all.
#pragma once

#include <algorithm>
#include <cstddef>

#include "values/array.hpp"
#include "values/threads.hpp"

namespace surfmesh {

inline constexpr std::size_t TOUCHED_TOGETHER = 1 << 15;  // values

/// So many values that are to be written before they are read, with room for more.
template <class T>
[[nodiscard]] Array<T> unfilled_with_room(std::size_t size, std::size_t room) {
    Array<T> made = Array<T>::unfilled(std::max(size, room));
    made.resize(size);
    return made;
}

/// So many of one value, with room for more.
template <class T>
[[nodiscard]] Array<T> filled_by_threads(std::size_t size, T value, std::size_t room = 0) {
    Array<T> made = unfilled_with_room<T>(size, room);
    for_each_block(size, TOUCHED_TOGETHER, [&](std::size_t first, std::size_t last) {
        std::fill(made.data() + first, made.data() + last, value);
    });
    return made;
}

}  // namespace surfmesh
