#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>

#include <array>
#include <optional>
#include <tuple>
#include <utility>

#include "binding/arrays.hpp"
#include "surfaces/callback_surface.hpp"
#include "surfaces/chart_making.hpp"
#include "surfaces/monotone_cubic.hpp"

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

using Ends = std::pair<Vector<double>, Vector<double>>;
using Scaling = std::tuple<std::size_t, int, double, Ends>;

PoleScaling scaling_of(const Scaling& given, const Chart& chart) {
    const auto& [axis, poles, c, ends] = given;
    if (!(c > 0.0 && c < 1.6)) throw nb::value_error("the angle is not between 0 and pi / 2");
    if (poles < 0 || poles > 2) throw nb::value_error("the poles are 0, 1 or 2");
    const double extent = axis == 0 ? chart.v.extent : chart.u.extent;
    if (axis > 1) throw nb::value_error("the scaled axis is 0 or 1");
    const auto cubic = [extent](const Vector<double>& values) {
        if (values.shape(0) < 2) throw nb::value_error("elongations are at least two");
        for (const double x : rows<double>(values))
            if (!(x > 0.0)) throw nb::value_error("elongations are not positive");
        return even_cubic(extent, Array<double>(rows<double>(values)));
    };
    return {axis, static_cast<PoleEnds>(poles), c, cubic(ends.first), cubic(ends.second)};
}

nb::object scaling_in(const Chart& chart) {
    const PoleScaling& scaling = chart.scaling;
    if (scaling.is_none()) return nb::none();
    return nb::cast(std::tuple(scaling.axis, static_cast<int>(scaling.poles), scaling.c,
                               std::pair(view(scaling.first.values), view(scaling.last.values))));
}

using Domain = std::pair<std::pair<double, double>, std::pair<double, double>>;

Chart made_of(const Surface& surface, std::pair<bool, bool> steady,
              const std::pair<std::optional<Pieces>, std::optional<Pieces>>& pieces,
              std::size_t samples, bool to_poles) {
    if (samples < 2 || samples > 100'000) throw nb::value_error("samples are at least two");
    const auto known = [samples](bool is_steady, const std::optional<Pieces>& given) {
        KnownAxis axis{is_steady, {}, samples};
        if (given) axis.pieces = Array<BentPiece>(rows<BentPiece>(*given));
        return axis;
    };
    const std::array axes = {known(steady.first, pieces.first),
                             known(steady.second, pieces.second)};
    SurfaceReader reader(surface);
    Chart made;
    {
        const nb::gil_scoped_release released;
        made = chart_of(reader, axes, to_poles);
    }
    raise_failure(surface, reader.status());
    if (reader.failed()) throw nb::value_error("the surface has no first derivatives");
    return made;
}

void bind_monotone_cubic(nb::module_& m) {
    m.def(
        "monotone_cubic",
        [](const Vector<double>& x, const Vector<double>& y, const Vector<double>& at) {
            if (x.shape(0) < 2) throw nb::value_error("x are at least two");
            require_rows(y.shape(0), x.shape(0), "y");
            const MonotoneCubic cubic(rows<double>(x), rows<double>(y));
            Array<double> value(at.shape(0)), derivative(at.shape(0));
            for (std::size_t i = 0; i < at.shape(0); ++i) {
                value[i] = cubic.value(at.data()[i]);
                derivative[i] = cubic.derivative(at.data()[i]);
            }
            return std::pair(view(value), view(derivative));
        },
        nb::arg("x"), nb::arg("y"), nb::arg("at"),
        "Values and derivatives (m,) at ``at`` (m,) of a cubic through y (n,) at rising x (n,) "
        "that rises where they do.");
}

void bind_axes(nb::module_& m) {
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
        .def_prop_ro(
            "knots", [](const ChartAxis& axis) { return read_only_view(axis.knots); },
            nb::rv_policy::automatic)
        .def_prop_ro(
            "slopes", [](const ChartAxis& axis) { return read_only_view(axis.slopes); },
            nb::rv_policy::automatic)
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
}

void bind_charts_of_two_axes(nb::module_& m) {
    m.attr("CHART_SAMPLES") = CHART_SAMPLES;
    m.attr("CHART_SAMPLES_OF_PIECE") = CHART_SAMPLES_OF_PIECE;
    nb::class_<Chart>(m, "Chart", "(u, v) of a surface and the scaled plane, axis by axis.")
        .def(
            "__init__",
            [](Chart* made, const ChartAxis& u, const ChartAxis& v,
               const std::optional<Scaling>& scaling) {
                new (made) Chart{u, v, {}};
                if (scaling) made->scaling = scaling_of(*scaling, *made);
            },
            nb::arg("u"), nb::arg("v"), nb::arg("scaling") = nb::none(), "scaling: as below.")
        .def_static(
            "of", &made_of, nb::arg("surface"), nb::arg("steady"), nb::arg("pieces"),
            nb::arg("samples"), nb::arg("to_poles"),
            "The chart of a surface from its speeds. steady: axes along which the speed is the "
            "same everywhere. pieces: (p, 7) of the axes with speeds without bound, or None. "
            "samples: along each axis. to_poles: axes that run to elongated poles are scaled.")
        .def_static(
            "uniform",
            [](const Domain& domain, std::pair<double, double> speeds) {
                const auto& [u, v] = domain;
                return Chart{linear_axis(u.first, u.second, speeds.first),
                             linear_axis(v.first, v.second, speeds.second)};
            },
            nb::arg("domain"), nb::arg("speeds"), "Where |r_u| and |r_v| are the same everywhere.")
        .def_prop_ro("u", [](const Chart& chart) { return chart.u; })
        .def_prop_ro("v", [](const Chart& chart) { return chart.v; })
        .def_prop_ro(
            "scaling", &scaling_in,
            "The axis that is scaled towards elongated poles, 0 or 1, which ends are poles (0: "
            "the first, 1: the last, 2: both), an angle, and the elongations at both ends, "
            "(k,) and (l,) at even places of the other axis: see pole_scaling.hpp; or None.")
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
            "crossed_rates",
            [](const Chart& chart, const Points2& xy) {
                Array<Point2> crossed(xy.shape(0));
                for (std::size_t i = 0; i < xy.shape(0); ++i)
                    crossed[i] = chart.at(rows<Point2>(xy)[i]).crossed;
                return view(crossed);
            },
            nb::arg("xy"), "xy (n, 2) -> (du/dy, dv/dx) (n, 2), zero but where an axis is scaled.")
        .def(
            "to_plane",
            [](const Chart& chart, const Points2& uv) {
                return view(chart.to_plane(rows<Point2>(uv)));
            },
            nb::arg("uv"),
            "uv (n, 2), bent parameters where there are some -> xy (n, 2).\n\nExact at the ends of "
            "the axes; what lies beyond is moved there.");
}

}  // namespace

void bind_chart(nb::module_& m) {
    bind_monotone_cubic(m);
    bind_axes(m);
    bind_charts_of_two_axes(m);
}

}  // namespace surfmesh::binding
