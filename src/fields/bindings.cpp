#include "binding/arrays.hpp"

namespace surfmesh::binding {

void bind_fields(nb::module_& m) {
    m.doc() = "Size tensors, their gradation, and the look-up in a background.";
}

}  // namespace surfmesh::binding
