// The extension surfmesh._core: one submodule a room, in the order in which they build on each
// other.
#include <nanobind/nanobind.h>

#include <algorithm>
#include <utility>

#include "values/conventions.hpp"
#include "values/free_memory.hpp"
#include "values/threads.hpp"

namespace surfmesh::binding {

namespace nb = nanobind;

void bind_elementary_functions(nb::module_& m);
void bind_fields(nb::module_& m);
void bind_triangulation(nb::module_& m);
void bind_space(nb::module_& m);
void bind_packing(nb::module_& m);
void bind_insertion(nb::module_& m);
void bind_optimisation(nb::module_& m);
void bind_surfaces(nb::module_& m);
void bind_sizing(nb::module_& m);
void bind_patch(nb::module_& m);
void bind_faces(nb::module_& m);
void bind_edges(nb::module_& m);
void bind_intersection(nb::module_& m);
void bind_quality(nb::module_& m);
void bind_proof(nb::module_& m);

namespace {

/// Add a room to the module.
void add(nb::module_& m, const char* name, void (*bind)(nb::module_&)) {
    nb::module_ room = m.def_submodule(name);
    bind(room);
}

}  // namespace
}  // namespace surfmesh::binding

NB_MODULE(_core, m) {
    using namespace surfmesh::binding;
    nanobind::set_leak_warnings(false);  // what callers keep until the end is no fault
    m.doc() = "The compiled core of surfmesh: arrays in, arrays and a status out.";
    m.attr("NIL") = surfmesh::NIL;
    m.def(
        "allow_threads",
        [](int count) { return std::exchange(surfmesh::allowed_threads(), std::max(1, count)); },
        nanobind::arg("count"),
        "How many threads calls from this thread of Python may use; returns how many they were "
        "allowed.\n\nResults do not depend on it. 1 in every new thread.");
    m.def(
        "return_free_memory",
        [](long long triangles) {
            const nanobind::gil_scoped_release released;
            surfmesh::return_free_memory(triangles);
        },
        nanobind::arg("triangles"),
        "After work on a mesh of so many triangles: give memory back to the system that the C "
        "library keeps although it is free.\n\nDoes nothing for small meshes.");
    add(m, "elementary_functions", bind_elementary_functions);
    add(m, "fields", bind_fields);
    add(m, "triangulation", bind_triangulation);
    add(m, "space", bind_space);
    add(m, "packing", bind_packing);
    add(m, "insertion", bind_insertion);
    add(m, "optimisation", bind_optimisation);
    add(m, "surfaces", bind_surfaces);
    add(m, "sizing", bind_sizing);
    add(m, "patch", bind_patch);
    add(m, "faces", bind_faces);
    add(m, "edges", bind_edges);
    add(m, "intersection", bind_intersection);
    add(m, "quality", bind_quality);
    add(m, "proof", bind_proof);
}
