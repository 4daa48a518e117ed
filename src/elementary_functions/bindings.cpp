#include "binding/arrays.hpp"

namespace surfmesh::binding {

void bind_elementary_functions(nb::module_& m) {
    m.doc() =
        "Sine, cosine, exponential and the like: one implementation, the same bits everywhere.";
}

}  // namespace surfmesh::binding
