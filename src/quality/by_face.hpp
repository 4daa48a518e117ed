// Things that belong to faces, face by face: one counting sort, so that each surface is asked for
// blocks of places.
//
// In: how many things and faces there are, and face_of(thing). Out: the numbers of the things of
// each face, in their order.
#pragma once

#include <cstdint>
#include <numeric>
#include <span>

#include "values/array.hpp"

namespace surfmesh {

struct ByFace {
    Array<std::int32_t> members;
    Array<std::size_t> first;  // of each face, and how many there are in all

    [[nodiscard]] std::span<const std::int32_t> of(std::size_t face) const {
        return {members.data() + first[face], first[face + 1] - first[face]};
    }
};

template <class FaceOf>
ByFace by_face(std::size_t count, std::size_t faces, const FaceOf& face_of) {
    ByFace sorted{Array<std::int32_t>(count), Array<std::size_t>(faces + 1, 0)};
    if (faces == 1) {
        std::iota(sorted.members.begin(), sorted.members.end(), 0);
        sorted.first[1] = count;
        return sorted;
    }
    for (std::size_t i = 0; i < count; ++i) ++sorted.first[face_of(i) + 1];
    for (std::size_t f = 0; f < faces; ++f) sorted.first[f + 1] += sorted.first[f];
    Array<std::size_t> next = sorted.first;
    for (std::size_t i = 0; i < count; ++i)
        sorted.members[next[face_of(i)]++] = static_cast<std::int32_t>(i);
    return sorted;
}

}  // namespace surfmesh
