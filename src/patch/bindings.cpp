#include "binding/arrays.hpp"

namespace surfmesh::binding {

void bind_patch(nb::module_& m) {
    m.doc() = "A whole (u, v) domain and its size field become triangles in one call.";
}

}  // namespace surfmesh::binding
