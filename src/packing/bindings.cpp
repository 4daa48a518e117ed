#include "binding/arrays.hpp"

namespace surfmesh::binding {

void bind_packing(nb::module_& m) {
    m.doc() = "Section 2 of the paper: the front, and circles placed at it.";
}

}  // namespace surfmesh::binding
