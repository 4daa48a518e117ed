#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>

#include <memory>

#include "surfaces/curve_on_surface.hpp"
#include "surfaces/elementary_surfaces.hpp"
#include "surfaces/offset_surface.hpp"
#include "surfaces/spline_surface.hpp"
#include "surfaces/swept_surfaces.hpp"
#include "surfaces/vectors.hpp"

namespace surfmesh::binding {
namespace {

using SharedSurface = std::shared_ptr<Surface>;
using SharedCurve = std::shared_ptr<Curve>;
using Domain = std::pair<std::pair<double, double>, std::pair<double, double>>;
using Grid = nb::ndarray<const double, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu>;
using WeightGrid = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Periods = std::pair<double, double>;

ParameterBox box(const Domain& domain) {
    const auto& [u, v] = domain;
    return {{u.first, v.first}, {u.second, v.second}};
}

SharedSurface turned(const Domain& domain, const Vector3& origin, const Vector3& x,
                     const Vector3& y, const Vector3& z, const Profile& profile) {
    const Frame frame{point(origin), point(x), point(y), point(z)};
    return std::make_shared<TurnedProfile>(box(domain), frame, profile);
}

void bind_elementary(nb::module_& m) {
    m.def(
        "plane",
        [](const Domain& domain, const Vector3& origin, const Vector3& x,
           const Vector3& y) -> SharedSurface {
            const Frame frame{point(origin), point(x), point(y), {0.0, 0.0, 0.0}};
            return std::make_shared<Plane>(box(domain), frame);
        },
        nb::arg("domain"), nb::arg("origin"), nb::arg("x"), nb::arg("y"), "origin + u x + v y");
    m.def(
        "cylinder",
        [](const Domain& domain, const Vector3& origin, const Vector3& x, const Vector3& y,
           const Vector3& z, double radius) {
            return turned(domain, origin, x, y, z, {radius, 0.0, 1.0, 0.0, false});
        },
        nb::arg("domain"), nb::arg("origin"), nb::arg("x"), nb::arg("y"), nb::arg("z"),
        nb::arg("radius"), "origin + radius e(u) + v z, with e(u) = cos u x + sin u y");
    m.def(
        "cone",
        [](const Domain& domain, const Vector3& origin, const Vector3& x, const Vector3& y,
           const Vector3& z, double radius, double angle) {
            return turned(domain, origin, x, y, z, profile_of_cone(radius, angle));
        },
        nb::arg("domain"), nb::arg("origin"), nb::arg("x"), nb::arg("y"), nb::arg("z"),
        nb::arg("radius"), nb::arg("angle"),
        "origin + (radius + v sin angle) e(u) + v cos angle z");
    m.def(
        "sphere",
        [](const Domain& domain, const Vector3& origin, const Vector3& x, const Vector3& y,
           const Vector3& z, double radius) {
            return turned(domain, origin, x, y, z, {0.0, 0.0, 0.0, radius, true});
        },
        nb::arg("domain"), nb::arg("origin"), nb::arg("x"), nb::arg("y"), nb::arg("z"),
        nb::arg("radius"), "origin + radius cos v e(u) + radius sin v z");
    m.def(
        "torus",
        [](const Domain& domain, const Vector3& origin, const Vector3& x, const Vector3& y,
           const Vector3& z, double radius,
           double tube) { return turned(domain, origin, x, y, z, {radius, 0.0, 0.0, tube, true}); },
        nb::arg("domain"), nb::arg("origin"), nb::arg("x"), nb::arg("y"), nb::arg("z"),
        nb::arg("radius"), nb::arg("tube"), "origin + (radius + tube cos v) e(u) + tube sin v z");
}

SharedSurface spline(const Domain& domain, const Numbers& knots_u, const Numbers& knots_v,
                     const Grid& control, const std::optional<WeightGrid>& weights,
                     const Periods& periods) {
    const std::size_t rows = control.shape(0), columns = control.shape(1);
    if (weights && (weights->shape(0) != rows || weights->shape(1) != columns))
        throw nb::value_error("there must be one weight for each control point");
    const auto [low, high] = box(domain);
    const SplineBasis u(numbers(knots_u), checked_degree(numbers(knots_u), rows),
                        {low.x, high.x, periods.first});
    const SplineBasis v(numbers(knots_v), checked_degree(numbers(knots_v), columns),
                        {low.y, high.y, periods.second});
    const std::span points{reinterpret_cast<const Point3*>(control.data()), rows * columns};
    const auto values = weights ? std::span<const double>(weights->data(), weights->size())
                                : std::span<const double>();
    return std::make_shared<SplineSurface>(box(domain), u, v, columns, points, values);
}

void require_in_space(const SharedCurve& curve) {
    if (curve->dimension() != 3) throw nb::value_error("the curve must lie in space");
}

void bind_derived(nb::module_& m) {
    m.def("spline_surface", &spline, nb::arg("domain"), nb::arg("knots_u"), nb::arg("knots_v"),
          nb::arg("control"), nb::arg("weights").none(), nb::arg("periods"),
          "control (nu, nv, 3); weights (nu, nv) or None; periods of u and v: 0 for none.\n\nAt a "
          "crease that is a side of the domain, the derivatives are those inside.");
    m.def(
        "extrusion",
        [](const Domain& domain, const SharedCurve& curve,
           const Vector3& direction) -> SharedSurface {
            require_in_space(curve);
            return std::make_shared<ExtrusionSurface>(box(domain), curve, point(direction));
        },
        nb::arg("domain"), nb::arg("curve"), nb::arg("direction"), "c(u) + v direction");
    m.def(
        "revolution",
        [](const Domain& domain, const SharedCurve& curve, const Vector3& origin,
           const Vector3& axis) -> SharedSurface {
            require_in_space(curve);
            return std::make_shared<RevolutionSurface>(box(domain), curve, point(origin),
                                                       point(axis));
        },
        nb::arg("domain"), nb::arg("curve"), nb::arg("origin"), nb::arg("axis"),
        "c(v) turned by the angle u about the axis through origin, of unit length");
    m.def(
        "curve_on_surface",
        [](const SharedSurface& surface, const SharedCurve& pcurve, double shift,
           double rate) -> SharedCurve {
            if (pcurve->dimension() != 2) throw nb::value_error("the curve must lie in (u, v)");
            return std::make_shared<CurveOnSurface>(surface, pcurve, shift, rate);
        },
        nb::arg("surface"), nb::arg("pcurve"), nb::arg("shift"), nb::arg("rate"),
        "r(p(shift + rate t)) with a curve p in (u, v); derivatives beyond the second are no "
        "numbers.");
    m.def(
        "offset_surface",
        [](const SharedSurface& basis, double distance) -> SharedSurface {
            return std::make_shared<OffsetSurface>(basis, distance);
        },
        nb::arg("basis"), nb::arg("distance"),
        "r + distance n with n along r_u x r_v, for a basis that has third derivatives.");
}

}  // namespace

void bind_face_surfaces(nb::module_& m) {
    bind_elementary(m);
    bind_derived(m);
}

}  // namespace surfmesh::binding
