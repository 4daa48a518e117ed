#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>

#include <memory>
#include <optional>

#include "binding/arrays.hpp"
#include "binding/released.hpp"
#include "surfaces/callback_surface.hpp"
#include "surfaces/surface.hpp"

namespace surfmesh::binding {

void bind_surface_searches(nb::module_& m);
void bind_formulas(nb::module_& m);  // formula_bindings.cpp
void bind_chart(nb::module_& m);

namespace {

using LowHigh = std::pair<double, double>;
using DerivativeArrays = nb::ndarray<nb::numpy, double, nb::shape<-1, -1, 3>>;
using BoundArrays = nb::ndarray<nb::numpy, double, nb::shape<-1, 5, 3>>;

/// Values of the core's as an array of numpy with more dimensions.
template <class Shaped>
Shaped shaped(const Array<Point3>& values, std::size_t rows, std::size_t columns) {
    const std::size_t shape[] = {rows, columns, 3};
    const nb::capsule owner = owner_of(values);
    return Shaped(reinterpret_cast<double*>(values.data()), 3, shape, owner);
}

DerivativeArrays evaluate(const Surface& surface, const Points2& uv, int order) {
    if (order < 0 || order > 3) throw nb::value_error("the order is 0, 1, 2 or 3");
    SurfaceValues values;
    const auto status = released([&] { return values.evaluate(surface, rows<Point2>(uv), order); });
    raise_failure(surface, status);
    if (status == SurfaceStatus::UNKNOWN)
        throw nb::value_error("the surface has no derivatives of so high an order");
    return shaped<DerivativeArrays>(values.all(), derivative_count(order), uv.shape(0));
}

std::optional<std::pair<BoundArrays, BoundArrays>> derivative_bounds(const Surface& surface,
                                                                     const Points2& lo,
                                                                     const Points2& hi) {
    const std::size_t count = lo.shape(0);
    require_rows(hi.shape(0), count, "hi");
    Array<ParameterBox> cells(count);
    for (std::size_t i = 0; i < count; ++i) cells[i] = {rows<Point2>(lo)[i], rows<Point2>(hi)[i]};
    Array<Point3> lower(BOUNDED_DERIVATIVES * count), upper(BOUNDED_DERIVATIVES * count);
    const auto status =
        released([&] { return surface.derivative_bounds({cells.data(), count}, lower, upper); });
    raise_failure(surface, status);
    if (status == SurfaceStatus::UNKNOWN) return std::nullopt;
    return std::pair(shaped<BoundArrays>(lower, count, BOUNDED_DERIVATIVES),
                     shaped<BoundArrays>(upper, count, BOUNDED_DERIVATIVES));
}

std::optional<DerivativeArrays> derivative_magnitudes(const Surface& surface, const Points2& lo,
                                                      const Points2& hi, int order) {
    const std::size_t count = lo.shape(0);
    require_rows(hi.shape(0), count, "hi");
    if (order < 2 || order > 3) throw nb::value_error("the order is 2 or 3");
    Array<ParameterBox> cells(count);
    for (std::size_t i = 0; i < count; ++i) cells[i] = {rows<Point2>(lo)[i], rows<Point2>(hi)[i]};
    Array<Point3> found(derivative_count(order) * count);
    const auto status = released(
        [&] { return surface.derivative_magnitudes({cells.data(), count}, order, found); });
    raise_failure(surface, status);
    if (status == SurfaceStatus::UNKNOWN) return std::nullopt;
    return shaped<DerivativeArrays>(found, count, derivative_count(order));
}

/// What the collector of cyclic references must see: an object may lead back to its surface.
int visit_object(PyObject* self, visitproc visit, void* arg) {
    Py_VISIT(Py_TYPE(self));
    if (nb::inst_ready(self)) Py_VISIT(nb::inst_ptr<CallbackSurface>(self)->object().ptr());
    return 0;
}

int clear_object(PyObject* self) {
    if (nb::inst_ready(self)) nb::inst_ptr<CallbackSurface>(self)->object().reset();
    return 0;
}

PyType_Slot callback_slots[] = {{Py_tp_traverse, reinterpret_cast<void*>(visit_object)},
                                {Py_tp_clear, reinterpret_cast<void*>(clear_object)},
                                {0, nullptr}};

void bind_surface_class(nb::module_& m) {
    nb::class_<Surface>(m, "Surface", "A map from a rectangle of the (u, v) plane into space.")
        .def_prop_ro(
            "domain",
            [](const Surface& surface) {
                const auto [low, high] = surface.domain();
                return std::pair(LowHigh(low.x, high.x), LowHigh(low.y, high.y));
            },
            "((u0, u1), (v0, v1))")
        .def("evaluate", &evaluate, nb::arg("uv"), nb::arg("order") = 0,
             "(n, 2) -> (m, n, 3): r; r_u, r_v; r_uu, r_uv, r_vv; r_uuu, r_uuv, r_uvv, r_vvv.\n\n"
             "m = 1, 3, 6, 10 for the orders 0 to 3. ValueError where the surface does not have "
             "derivatives of so high an order.")
        .def("derivative_bounds", &derivative_bounds, nb::arg("lo"), nb::arg("hi"),
             "Bounds of r_u, r_v, r_uu, r_uv, r_vv over cells, or None when they are not known.\n\n"
             "lo, hi: (n, 2) corners of the cells -> lower, upper (n, 5, 3), infinite where "
             "unknown.")
        .def("derivative_magnitudes", &derivative_magnitudes, nb::arg("lo"), nb::arg("hi"),
             nb::arg("order") = 2,
             "Bounds of the absolute values of all derivatives over cells, or None when they are "
             "not known.\n\nlo, hi: (n, 2) corners -> (n, m, 3) in the sequence of ``evaluate``, "
             "those of r itself 0. order: 2 or 3.");
    nb::class_<CallbackSurface, Surface>(m, "CallbackSurface", nb::type_slots(callback_slots),
                                         "An object of Python that is asked for each block.")
        .def(nb::init<nb::object>(), nb::arg("surface"),
             "surface: has ``domain``, ``evaluate`` and ``derivative_bounds`` as the protocol "
             "surfmesh.geometry.surface.Surface.");
}

}  // namespace

void bind_curves(nb::module_& m);
void bind_face_surfaces(nb::module_& m);

void bind_surfaces(nb::module_& m) {
    m.doc() = "Surfaces of CAD models and of formulas, evaluated in blocks.";
    bind_surface_class(m);
    bind_curves(m);
    bind_face_surfaces(m);
    bind_surface_searches(m);
    bind_formulas(m);
    bind_chart(m);
}

}  // namespace surfmesh::binding
