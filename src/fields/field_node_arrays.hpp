// How the nodes of a size field look to numpy: twelve arrays.
#pragma once

#include "binding/arrays.hpp"
#include "fields/field_nodes.hpp"

namespace surfmesh::binding {

template <>
struct Row<PlaneJacobian> : RowOf<double, 6> {};
template <>
struct Row<NumberPair> : RowOf<double, 2> {};

/// As views; the jacobian (nodes, 6).
inline nb::tuple node_arrays(const FieldNodes& n) {
    return nb::make_tuple(view(n.size), view(n.target_size), view(n.root), view(n.normal),
                          view(n.point), view(n.longer), view(n.longer_target), view(n.along),
                          view(n.jacobian), view(n.asked), view(n.curvature), view(n.turn_rates));
}

}  // namespace surfmesh::binding
