// What the passes of the optimiser tell each other of a vertex.
#pragma once

#include <cstdint>
#include <cstring>

#include "values/array.hpp"
#include "values/conventions.hpp"

namespace surfmesh {

struct VertexMarks {
    Array<std::uint8_t> active;  // smoothing and splits look at it
    Array<std::uint8_t> dirty;   // its triangles have changed since swaps last looked at them

    VertexMarks() = default;
    explicit VertexMarks(std::size_t vertices) { resize(vertices); }

    /// Marks for vertices up to number ``vertices``; a new one is active and dirty.
    void resize(std::size_t vertices) {
        active.resize(vertices, 1);
        dirty.resize(vertices, 1);
    }

    void touch(Vertex v) { active[v] = dirty[v] = 1; }
};

/// The first vertex from v on that is marked, or ``end``.
inline Vertex next_marked(const Array<std::uint8_t>& marks, Vertex v, Vertex end) {
    constexpr Vertex MANY = 8;  // looked at together
    std::uint64_t several = 0;
    static_assert(sizeof several == MANY);
    while (v + MANY <= end) {
        std::memcpy(&several, marks.data() + v, MANY);
        if (several != 0) break;
        v += MANY;
    }
    while (v < end && marks[v] == 0) ++v;
    return v;
}

}  // namespace surfmesh
