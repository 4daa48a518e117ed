// What bindings refuse of the vertices that they are given.
#pragma once

#include "binding/arrays.hpp"
#include "optimisation/surface_frames.hpp"

namespace surfmesh::binding {

inline void require_vertex(const SurfaceFrames& s, Vertex v) {
    if (v < 0 || static_cast<std::size_t>(v) >= s.point.size())
        throw nb::value_error("there is no such vertex");
}

}  // namespace surfmesh::binding
