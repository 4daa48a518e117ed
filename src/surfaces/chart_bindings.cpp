#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>

#include <optional>

#include "binding/arrays.hpp"
#include "surfaces/chart.hpp"

namespace surfmesh::binding {

namespace {

using Pieces = Matrix<double, 7>;

/// One axis of a chart from its arrays.
ChartAxis axis_of(double extent, const Vector<double>& knots, const Vector<double>& slopes,
                  const std::optional<Pieces>& pieces) {
    if (!(extent > 0.0)) throw nb::value_error("extent is not positive");
    if (knots.shape(0) < 2) throw nb::value_error("knots are at least two");
    require_rows(slopes.shape(0), knots.shape(0), "slopes");
    ChartAxis axis;
    axis.extent = extent;
    axis.knots = Array<double>(rows<double>(knots));
    axis.slopes = Array<double>(rows<double>(slopes));
    if (pieces) axis.pieces = Array<BentPiece>(rows<BentPiece>(*pieces));
    return axis;
}

}  // namespace

void bind_chart(nb::module_& m) {
    nb::class_<ChartAxis>(m, "ChartAxis",
                          "A monotone map between one parameter and its scaled coordinate.")
        .def(
            "__init__",
            [](ChartAxis* made, double extent, const Vector<double>& knots,
               const Vector<double>& slopes, const std::optional<Pieces>& pieces) {
                new (made) ChartAxis(axis_of(extent, knots, slopes, pieces));
            },
            nb::arg("extent"), nb::arg("knots"), nb::arg("slopes"), nb::arg("pieces") = nb::none(),
            "knots, slopes (k,): the parameter and its derivative at k even coordinates from 0 to "
            "extent.\npieces (p, 7), where knots are of the bent parameter: first, last, powers at "
            "both ends, their beta function, clearance at both ends.")
        .def_prop_ro("extent", [](const ChartAxis& axis) { return axis.extent; })
        .def(
            "parameter_and_rate",
            [](const ChartAxis& axis, const Vector<double>& x) {
                Array<double> parameter(x.shape(0)), rate(x.shape(0));
                for (std::size_t i = 0; i < x.shape(0); ++i) {
                    const ValueAndRate found = axis.parameter(rows<double>(x)[i]);
                    parameter[i] = found.value;
                    rate[i] = found.rate;
                }
                return std::pair(view(parameter), view(rate));
            },
            nb::arg("x"),
            "The parameter (n,) at scaled coordinates x (n,), and its derivative by x (n,).\n\n"
            "Linear outside [0, extent], constant where the parameter is bent.");
    nb::class_<Chart>(m, "Chart", "(u, v) of a surface and the scaled plane, axis by axis.")
        .def(
            "__init__",
            [](Chart* made, const ChartAxis& u, const ChartAxis& v) { new (made) Chart{u, v}; },
            nb::arg("u"), nb::arg("v"))
        .def(
            "to_uv_and_rates",
            [](const Chart& chart, const Points2& xy) {
                Array<Point2> uv(xy.shape(0)), rates(xy.shape(0));
                for (std::size_t i = 0; i < xy.shape(0); ++i) {
                    const ChartPoint at = chart.at(rows<Point2>(xy)[i]);
                    uv[i] = at.uv;
                    rates[i] = at.rates;
                }
                return std::pair(view(uv), view(rates));
            },
            nb::arg("xy"), "xy (n, 2) -> uv (n, 2) and (du/dx, dv/dy) (n, 2).")
        .def(
            "to_plane",
            [](const Chart& chart, const Points2& uv) {
                return view(chart.to_plane(rows<Point2>(uv)));
            },
            nb::arg("uv"),
            "uv (n, 2), bent parameters where there are some -> xy (n, 2).\n\nExact at the ends of "
            "the axes; what lies beyond is moved there.");
}

}  // namespace surfmesh::binding
