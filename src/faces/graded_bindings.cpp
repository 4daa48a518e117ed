// Faces whose sizes follow from their curvature and their edges.
#include <nanobind/stl/array.h>
#include <nanobind/stl/shared_ptr.h>

#include "binding/arrays.hpp"
#include "faces/graded_face.hpp"

namespace surfmesh::binding {

void bind_graded(nb::module_& m);

void bind_graded(nb::module_& m) {
    nb::class_<GradedFace>(m, "GradedFace",
                           "A face whose sizes follow from its curvature and its edges.")
        .def(
            "__init__",
            [](GradedFace* made, std::shared_ptr<Surface> of_face,
               std::shared_ptr<Surface> over_box, const std::array<bool, 2>& is_steady, int pieces,
               std::shared_ptr<FaceBoundary> boundary, std::shared_ptr<AskedRules> asked,
               double slope, const FaceManner& manner) {
                if (boundary->has_degenerate())
                    throw nb::value_error("a degenerate coedge is not cut yet");
                if (pieces < 1) throw nb::value_error("pieces is at least 1");
                if (!(slope > 0.0)) throw nb::value_error("slope is to be positive");
                new (made) GradedFace{{std::move(of_face), std::move(over_box), is_steady, pieces},
                                      std::move(boundary),
                                      std::move(asked),
                                      slope,
                                      manner};
            },
            nb::arg("of_face"), nb::arg("over_box"), nb::arg("is_steady"), nb::arg("pieces"),
            nb::arg("boundary"), nb::arg("asked"), nb::arg("slope"), nb::arg("manner"),
            "of_face: the surface over the domain of the face; over_box: over the box of its "
            "boundary. is_steady: |r_u| is the same all along u, |r_v| along v. pieces: smooth "
            "ones over the box. boundary: without degenerate coedges. slope: growth of the size "
            "per "
            "length.");
}

}  // namespace surfmesh::binding
