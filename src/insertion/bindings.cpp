#include "binding/arrays.hpp"

namespace surfmesh::binding {

void bind_insertion(nb::module_& m) {
    m.doc() = "Section 3 of the paper: boundary nodes and segments by tracing neighbours.";
}

}  // namespace surfmesh::binding
