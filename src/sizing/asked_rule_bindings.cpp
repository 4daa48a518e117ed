// Size rules on surfaces of any extent, and their bounds.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/vector.h>

#include "binding/arrays.hpp"
#include "sizing/asked_rules.hpp"

namespace surfmesh::binding {

void bind_asked_rules(nb::module_& m);

namespace {

template <class Rule>
using Given = std::vector<std::shared_ptr<Rule>>;

void bind_bounds(nb::module_& m) {
    m.attr("FINEST_SIZE") = FINEST_SIZE;
    m.attr("FINEST_BY_ANGLE") = FINEST_BY_ANGLE;
    m.attr("DEFAULT_MAX_SIZE") = DEFAULT_MAX_SIZE;
    m.attr("LONGEST_SIZE") = LONGEST_SIZE;
    nb::class_<StatedBounds>(m, "StatedBounds", "What bounds of sizes are asked for, model units.")
        .def(
            "__init__",
            [](StatedBounds* made, std::optional<double> min_size, std::optional<double> max_size,
               std::optional<double> size, bool has_size, bool is_anisotropic) {
                for (const auto& number : {min_size, max_size, size})
                    if (number && !(*number > 0.0))
                        throw nb::value_error("min_size, max_size and size are to be positive");
                new (made) StatedBounds{min_size, max_size, size, has_size, is_anisotropic};
            },
            nb::kw_only(), nb::arg("min_size").none(), nb::arg("max_size").none(),
            nb::arg("size").none(), nb::arg("has_size"), nb::arg("is_anisotropic"),
            "size: the same everywhere. has_size: that, or a law of sizes.");
    nb::class_<SizeBounds>(m, "SizeBounds", "What the least of all rules is kept within.")
        .def_ro("smallest", &SizeBounds::smallest)
        .def_ro("largest", &SizeBounds::largest, "It may be infinite.")
        .def_ro("longest", &SizeBounds::longest, "Along the longer axis of an anisotropic metric.")
        .def_ro("default_largest", &SizeBounds::default_largest,
                "Where none is stated; the smallest size may be larger.");
    m.def("size_bounds", &size_bounds, nb::arg("stated"), nb::arg("diagonal"),
          "On a surface whose bounding box has this diagonal, model units.");
}

void bind_rules_of_any_surface(nb::module_& m) {
    nb::class_<AskedRules>(m, "AskedRules",
                           "What is asked for on any surface, the same in all directions.")
        .def(
            "__init__",
            [](AskedRules* made, Given<CurvatureRule> by_curvature, Given<CurvatureRule> on_lattice,
               Given<PlaceRule> by_place, const StatedBounds& bounds) {
                if (by_curvature.empty() && by_place.empty())
                    throw nb::value_error("no rule is asked for");
                new (made) AskedRules{{by_curvature.begin(), by_curvature.end()},
                                      {on_lattice.begin(), on_lattice.end()},
                                      {by_place.begin(), by_place.end()},
                                      bounds};
            },
            nb::arg("by_curvature"), nb::arg("on_lattice"), nb::arg("by_place"), nb::arg("bounds"),
            "At least one rule. on_lattice: those by curvature for triangles that form a lattice; "
            "none where they may not.");
}

}  // namespace

void bind_asked_rules(nb::module_& m) {
    bind_bounds(m);
    bind_rules_of_any_surface(m);
}

}  // namespace surfmesh::binding
