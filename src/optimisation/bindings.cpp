#include "binding/arrays.hpp"

namespace surfmesh::binding {

void bind_optimisation(nb::module_& m) {
    m.doc() = "Swaps, smoothing, collapse and split, measured on the surface.";
}

}  // namespace surfmesh::binding
