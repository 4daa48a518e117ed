#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "binding/released.hpp"
#include "surfaces/elementary_curves.hpp"
#include "surfaces/offset_curve.hpp"
#include "surfaces/spline_curve.hpp"
#include "surfaces/spline_through_points.hpp"
#include "surfaces/vectors.hpp"

namespace surfmesh::binding {
namespace {

using Table = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using SharedCurve = std::shared_ptr<Curve>;
using ParameterLimits = std::pair<double, double>;

constexpr int MOST_DERIVATIVES = 8;  // guards against orders that are a mistake

int checked_dimension(std::size_t numbers) {
    if (numbers != 2 && numbers != 3)
        throw nb::value_error("points of curves have two or three coordinates");
    return static_cast<int>(numbers);
}

Point3 padded(const double* values, int dimension) {
    return {values[0], values[1], dimension == 3 ? values[2] : 0.0};
}

/// A vector in space or in the plane, of a curve with so many dimensions.
Point3 vector_of(const Numbers& values, int dimension) {
    require_rows(values.shape(0), static_cast<std::size_t>(dimension), "a vector of a curve");
    return padded(values.data(), dimension);
}

nb::ndarray<nb::numpy, double, nb::ndim<3>> evaluate_curve(const Curve& curve, const Numbers& t,
                                                           int order) {
    if (order < 0 || order > MOST_DERIVATIVES)
        throw nb::value_error("the order of derivatives is out of range");
    const std::size_t dimension = static_cast<std::size_t>(curve.dimension());
    const std::size_t shape[] = {static_cast<std::size_t>(order + 1), t.shape(0), dimension};
    Array<Point3> values(shape[0] * shape[1]);
    {
        const nb::gil_scoped_release released;
        curve.evaluate(numbers(t), order, values);
    }
    if (dimension == 3)
        return {reinterpret_cast<double*>(values.data()), 3, shape, owner_of(values)};
    Array<Point2> found(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) found[i] = {values[i].x, values[i].y};
    return {reinterpret_cast<double*>(found.data()), 3, shape, owner_of(found)};
}

/// Row i of t on curve i; the curves are of one dimension.
nb::ndarray<nb::numpy, double, nb::ndim<3>> points_on(const std::vector<SharedCurve>& curves,
                                                      const Table& t) {
    require_rows(t.shape(0), curves.size(), "t");
    const std::size_t dimension =
        curves.empty() ? 3 : static_cast<std::size_t>(curves[0]->dimension());
    for (const SharedCurve& curve : curves)
        if (static_cast<std::size_t>(curve->dimension()) != dimension)
            throw nb::value_error("the curves differ in their dimension");
    const std::size_t columns = t.shape(1);
    const std::size_t shape[] = {curves.size(), columns, dimension};
    Array<Point3> row(columns);
    Array<double> found(shape[0] * shape[1] * shape[2]);
    {
        const nb::gil_scoped_release released;
        double* out = found.data();
        for (std::size_t i = 0; i < curves.size(); ++i) {
            curves[i]->evaluate({t.data() + i * columns, columns}, 0, {row.data(), columns});
            for (const Point3& point : std::span<const Point3>(row.data(), columns)) {
                *out++ = point.x;
                *out++ = point.y;
                if (dimension == 3) *out++ = point.z;
            }
        }
    }
    return {found.data(), 3, shape, owner_of(found)};
}

SharedCurve conic(ConicKind kind, const Numbers& origin, const Numbers& x, const Numbers& y,
                  double major, double minor) {
    const int dimension = checked_dimension(origin.shape(0));
    const Conic::Axes axes{vector_of(origin, dimension), vector_of(x, dimension),
                           vector_of(y, dimension)};
    return std::make_shared<Conic>(dimension, kind, axes, major, minor);
}

SharedCurve spline_curve(const Numbers& knots, const Table& control,
                         const std::optional<Numbers>& weights,
                         const std::optional<ParameterLimits>& limits, double period) {
    const int dimension = checked_dimension(control.shape(1));
    checked_degree(numbers(knots), control.shape(0));
    if (weights) require_rows(weights->shape(0), control.shape(0), "weights");
    Array<Point3> points(control.shape(0));
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i] = padded(control.data() + i * control.shape(1), dimension);
    constexpr double NOWHERE = std::numeric_limits<double>::quiet_NaN();
    const auto [first, last] = limits.value_or(ParameterLimits(NOWHERE, NOWHERE));
    return std::make_shared<SplineCurve>(
        dimension, numbers(knots), std::span<const Point3>(points.data(), points.size()),
        weights ? numbers(*weights) : std::span<const double>(), SplineLimits{first, last, period});
}

SharedCurve offset(const SharedCurve& curve, double distance,
                   const std::optional<Vector3>& direction,
                   const std::optional<ParameterLimits>& limits) {
    if (direction.has_value() != (curve->dimension() == 3))
        throw nb::value_error("an offset curve has a direction in space, and none in the plane");
    std::optional<CurveLimits> part;
    if (limits) part = {limits->first, limits->second};
    return std::make_shared<OffsetCurve>(
        curve, distance, direction ? point(*direction) : Point3{0.0, 0.0, 0.0}, part);
}

std::pair<nb::ndarray<nb::numpy, double, nb::ndim<1>>, nb::ndarray<nb::numpy, double, nb::ndim<2>>>
through_points(const Numbers& places, const Table& values, std::size_t degree) {
    const auto at = numbers(places);
    require_rows(values.shape(0), at.size(), "values");
    if (degree % 2 == 0 || at.size() <= degree)
        throw nb::value_error("a spline of odd degree goes through more points than its degree");
    const auto rises = [](double a, double b) { return !(a < b); };
    if (std::adjacent_find(at.begin(), at.end(), rises) != at.end())
        throw nb::value_error("the places of a spline's points do not rise");
    const auto made = released([&] {
        return spline_through_points(at, {values.data(), values.size()}, values.shape(1), degree);
    });
    const std::size_t shape[] = {at.size(), values.shape(1)};
    return {view(made.knots), {made.control.data(), 2, shape, owner_of(made.control)}};
}

void bind_basis(nb::module_& m) {
    using Basis = nb::ndarray<nb::numpy, double, nb::ndim<2>>;
    m.def(
        "spline_basis",
        [](const Numbers& knots, std::size_t degree, double t, int order, double first, double last,
           double period) {
            if (order < 0 || order > MOST_DERIVATIVES || knots.shape(0) < degree + 1)
                throw nb::value_error("the order or the degree is out of range");
            checked_degree(numbers(knots), knots.shape(0) - degree - 1);
            const SplineBasis basis(numbers(knots), degree, {first, last, period});
            const KnotPlace place = basis.locate(t);
            const std::size_t columns = degree + 1;
            const std::size_t shape[] = {static_cast<std::size_t>(order + 1), columns};
            Array<double> table(columns * columns), found(shape[0] * columns);
            basis.derivatives(place, order, table, found);
            return std::tuple(place.span, place.t, Basis(found.data(), 2, shape, owner_of(found)));
        },
        nb::arg("knots"), nb::arg("degree"), nb::arg("t"), nb::arg("order"), nb::arg("first"),
        nb::arg("last"), nb::arg("period"),
        "The span of t, t brought into it by whole periods, and the spline functions that are not "
        "zero there with their derivatives, (order + 1, degree + 1).\n\nAt a knot that is an end "
        "of first .. last, the part in use, the span lies inside. period: 0 for none.");
}

}  // namespace

std::size_t checked_degree(std::span<const double> knots, std::size_t control) {
    if (control < 2 || knots.size() < control + 2 || knots.size() > 2 * control)
        throw nb::value_error("the numbers of knots and control points do not fit together");
    const std::size_t degree = knots.size() - control - 1;
    const bool finite =
        std::all_of(knots.begin(), knots.end(), [](double knot) { return std::isfinite(knot); });
    if (!finite || !std::is_sorted(knots.begin(), knots.end()) || !(knots[degree] < knots[control]))
        throw nb::value_error("the knots decrease, are not finite, or leave no interval");
    return degree;
}

void bind_curves(nb::module_& m) {
    nb::class_<Curve>(m, "Curve", "A map from a parameter into space or into the (u, v) plane.")
        .def_prop_ro("dimension", &Curve::dimension, "2 or 3")
        .def("evaluate", &evaluate_curve, nb::arg("t"), nb::arg("order") = 0,
             "(n,) -> (order + 1, n, dimension): c, c', c'', ...");
    m.def(
        "points_on", &points_on, nb::arg("curves"), nb::arg("t"),
        "Points of n curves of one dimension, row i of t (n, k) on curve i -> (n, k, dimension).");
    m.def(
        "line",
        [](const Numbers& origin, const Numbers& direction) -> SharedCurve {
            const int dimension = checked_dimension(origin.shape(0));
            return std::make_shared<Line>(dimension, vector_of(origin, dimension),
                                          vector_of(direction, dimension));
        },
        nb::arg("origin"), nb::arg("direction"), "origin + t direction");
    m.def(
        "ellipse",
        [](const Numbers& origin, const Numbers& x, const Numbers& y, double major, double minor) {
            return conic(ConicKind::ELLIPSE, origin, x, y, major, minor);
        },
        nb::arg("origin"), nb::arg("x"), nb::arg("y"), nb::arg("major"), nb::arg("minor"),
        "origin + major cos t x + minor sin t y");
    m.def(
        "hyperbola",
        [](const Numbers& origin, const Numbers& x, const Numbers& y, double major, double minor) {
            return conic(ConicKind::HYPERBOLA, origin, x, y, major, minor);
        },
        nb::arg("origin"), nb::arg("x"), nb::arg("y"), nb::arg("major"), nb::arg("minor"),
        "origin + major cosh t x + minor sinh t y");
    m.def(
        "parabola",
        [](const Numbers& origin, const Numbers& x, const Numbers& y, double focal) {
            return conic(ConicKind::PARABOLA, origin, x, y, focal, 0.0);
        },
        nb::arg("origin"), nb::arg("x"), nb::arg("y"), nb::arg("focal"),
        "origin + t^2 / (4 focal) x + t y");
    m.def("spline_curve", &spline_curve, nb::arg("knots"), nb::arg("control"),
          nb::arg("weights").none(), nb::arg("limits").none(), nb::arg("period"),
          "control (n, 2) or (n, 3); weights (n,) or None; limits: first and last parameter of the "
          "part in use, at whose ends the derivatives are those inside; period: 0 for none.");
    m.def("spline_through_points", &through_points, nb::arg("places"), nb::arg("values"),
          nb::arg("degree"),
          "Knots (n + degree + 1,) and control points (n, d) of the spline of odd degree through "
          "values (n, d) at places (n,) that rise, n > degree; no knot at the places next to its "
          "ends.");
    m.def("offset_curve", &offset, nb::arg("curve"), nb::arg("distance"),
          nb::arg("direction").none(), nb::arg("limits").none(),
          "A curve beside another: c + distance m / |m| with m = c' x direction in space, "
          "(c'_y, -c'_x) in the plane, where direction is None.");
    bind_basis(m);
}

}  // namespace surfmesh::binding
