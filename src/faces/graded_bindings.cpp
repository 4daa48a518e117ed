// Faces whose sizes follow from their curvature and their edges.
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>

#include "binding/arrays.hpp"
#include "faces/graded_face.hpp"

namespace surfmesh::binding {

void bind_graded(nb::module_& m);

namespace {

void require_positive(const std::optional<double>& number, const char* name) {
    if (number && !(*number > 0.0))
        throw nb::value_error((std::string(name) + " is to be positive").c_str());
}

AskedSizes asked_sizes(std::optional<double> chord, std::optional<double> angle,
                       std::optional<double> size, std::optional<double> min_size,
                       std::optional<double> max_size, bool is_curved, bool is_width, double slope,
                       double default_angle, double default_largest) {
    if (!chord && !angle && !size) throw nb::value_error("no chord, angle or size is asked for");
    require_positive(chord, "chord");
    require_positive(angle, "angle");
    require_positive(size, "size");
    require_positive(max_size, "max_size");
    for (const double x : {slope, default_angle, default_largest})
        require_positive(x, "slope, default_angle or default_largest");
    return {chord,     angle,    size,  min_size,      max_size,
            is_curved, is_width, slope, default_angle, default_largest};
}

void bind_asked_sizes(nb::module_& m) {
    nb::class_<AskedSizes>(m, "AskedSizes",
                           "What is asked for on any face, the same in all directions.")
        .def(
            "__init__",
            [](AskedSizes* made, std::optional<double> chord, std::optional<double> angle,
               std::optional<double> size, std::optional<double> min_size,
               std::optional<double> max_size, bool is_curved, bool is_width, double slope,
               double default_angle, double default_largest) {
                new (made) AskedSizes(asked_sizes(chord, angle, size, min_size, max_size, is_curved,
                                                  is_width, slope, default_angle, default_largest));
            },
            nb::kw_only(), nb::arg("chord").none(), nb::arg("angle").none(), nb::arg("size").none(),
            nb::arg("min_size").none(), nb::arg("max_size").none(), nb::arg("is_curved"),
            nb::arg("is_width"), nb::arg("slope"), nb::arg("default_angle"),
            nb::arg("default_largest"),
            "Model units and degrees; at least one of chord, angle and size is there. is_curved: "
            "chord is that of quadratic triangles. is_width: it is that of the whole band that a "
            "triangle needs. slope: growth of the size per length. default_angle: of neighbours' "
            "normals, where a chord alone is asked for. default_largest: size, as a fraction of "
            "the diagonal, where none is stated.");
}

}  // namespace

void bind_graded(nb::module_& m) {
    bind_asked_sizes(m);
    nb::class_<GradedFace>(m, "GradedFace",
                           "A face whose sizes follow from its curvature and its edges.")
        .def(
            "__init__",
            [](GradedFace* made, std::shared_ptr<Surface> of_face,
               std::shared_ptr<Surface> over_box, const std::array<bool, 2>& is_steady, int pieces,
               std::shared_ptr<FaceBoundary> boundary, std::shared_ptr<AskedSizes> asked,
               const FaceManner& manner) {
                if (boundary->has_degenerate())
                    throw nb::value_error("a degenerate coedge is not cut yet");
                if (pieces < 1) throw nb::value_error("pieces is at least 1");
                new (made) GradedFace{{std::move(of_face), std::move(over_box), is_steady, pieces},
                                      std::move(boundary),
                                      std::move(asked),
                                      manner};
            },
            nb::arg("of_face"), nb::arg("over_box"), nb::arg("is_steady"), nb::arg("pieces"),
            nb::arg("boundary"), nb::arg("asked"), nb::arg("manner"),
            "of_face: the surface over the domain of the face; over_box: over the box of its "
            "boundary. is_steady: |r_u| is the same all along u, |r_v| along v. pieces: smooth "
            "ones over the box. boundary: without degenerate coedges.");
}

}  // namespace surfmesh::binding
