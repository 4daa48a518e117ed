#include "binding/arrays.hpp"

namespace surfmesh::binding {

void bind_space(nb::module_& m) { m.doc() = "What is measured and decided in three dimensions."; }

}  // namespace surfmesh::binding
