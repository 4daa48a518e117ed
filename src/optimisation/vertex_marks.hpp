// What the passes of the optimiser tell each other of a vertex.
#pragma once

#include <cstdint>

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

}  // namespace surfmesh
