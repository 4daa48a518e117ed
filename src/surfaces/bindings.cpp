#include "binding/arrays.hpp"

namespace surfmesh::binding {

void bind_surfaces(nb::module_& m) {
    m.doc() = "Surfaces of CAD models and of formulas, evaluated in blocks.";
}

}  // namespace surfmesh::binding
