// The laws of size fields, and what stretched ones do once a field is refined.
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>

#include "binding/arrays.hpp"
#include "fields/field_node_arrays.hpp"
#include "fields/field_outcome_tuple.hpp"
#include "sizing/bounded_features.hpp"
#include "sizing/principal_lattice.hpp"
#include "sizing/stretched_law.hpp"
#include "sizing/surface_law.hpp"
#include "surfaces/callback_surface.hpp"
#include "surfaces/surface_reader.hpp"

namespace surfmesh::binding {

void bind_size_laws(nb::module_& m);

namespace {

void raise_failure_of(std::exception_ptr failure) {
    if (failure) std::rethrow_exception(failure);
    throw nb::value_error("the sizes could not be found");
}

using Limits = std::shared_ptr<SizeLimits>;

using RimArguments = std::optional<std::tuple<double, std::array<bool, 4>, std::optional<Limits>>>;
using LimitArguments = std::optional<std::tuple<Limits, double, bool>>;

std::optional<Rims> rims_of(const RimArguments& rims) {
    if (!rims) return std::nullopt;
    return Rims{std::get<0>(*rims), std::get<1>(*rims), std::get<2>(*rims).value_or(nullptr)};
}

OuterLimits outer_of(const LimitArguments& limits) {
    if (!limits) return {nullptr, 0.0, false};
    return {std::get<0>(*limits), std::get<1>(*limits), std::get<2>(*limits)};
}

void bind_surface_law(nb::module_& m) {
    nb::class_<SurfaceLaw, NodeLaw>(m, "SurfaceLaw", "Ungraded target sizes on one surface.")
        .def(
            "__init__",
            [](SurfaceLaw* made, const Surface& surface, const Chart& chart, const SizeRules& rules,
               const RimArguments& rims, const LimitArguments& limits) {
                new (made) SurfaceLaw(surface, chart, rules, rims_of(rims), outer_of(limits));
            },
            nb::arg("surface"), nb::arg("chart"), nb::arg("rules"), nb::arg("rims") = nb::none(),
            nb::arg("limits") = nb::none(), nb::keep_alive<1, 2>(),
            "rims: chord, which sides of the rectangle are open, limits near trimming loops or "
            "None. limits: of edges or earlier rounds, what none goes below, and whether sizes "
            "within them count as asked for.")
        .def(
            "nodes",
            [](SurfaceLaw& law, const Points2& xy) {
                FieldNodes nodes;
                const bool told = [&] {
                    const nb::gil_scoped_release released;
                    return law.ask(rows<Point2>(xy), nodes);
                }();
                if (!told) raise_failure_of(law.take_failure());
                return node_arrays(nodes);
            },
            nb::arg("xy"), "The twelve arrays of FieldNodes at xy (n, 2) of the chart.");
}

void bind_stretched_law(nb::module_& m) {
    nb::class_<StretchedLaw, SurfaceLaw>(m, "StretchedLaw",
                                         "The same where sizes depend on the direction.")
        .def(
            "__init__",
            [](StretchedLaw* made, const Surface& surface, const Chart& chart,
               const SizeRules& rules, const RimArguments& rims, const LimitArguments& limits,
               bool even) {
                new (made)
                    StretchedLaw(surface, chart, rules, rims_of(rims), outer_of(limits), even);
            },
            nb::arg("surface"), nb::arg("chart"), nb::arg("rules"), nb::arg("rims") = nb::none(),
            nb::arg("limits") = nb::none(), nb::arg("even") = false, nb::keep_alive<1, 2>(),
            "Likewise. even: the curvatures are known to be the same everywhere.");
    m.attr("BENDING") = BENDING;
    m.attr("FANNING") = FANNING;
    m.attr("ROUND") = ROUND;
    m.def(
        "limit_longer_sizes",
        [](FieldBuilder& builder, StretchedLaw& law, double chord) {
            if (!builder.is_finished()) throw nb::value_error("the field is not refined yet");
            if (!builder.nodes.is_anisotropic() || !builder.nodes.is_complete())
                throw nb::value_error("the field does not depend on the direction");
            FieldOutcome outcome{};
            {
                const nb::gil_scoped_release released;
                outcome = limit_longer_sizes(builder, law, chord);
            }
            if (outcome.status == FieldStatus::failed) raise_failure_of(law.take_failure());
            return outcome_tuple(outcome);
        },
        nb::arg("builder"), nb::arg("law"), nb::arg("chord"),
        "Lower long sizes of a refined field where directions change, and raise short ones where "
        "long ones are not reached; returned as by FieldBuilder.refine.");
}

void bind_direction_rates(nb::module_& m) {
    m.def(
        "direction_rates",
        [](const Surface& surface, const Points2& uv, const Vector<double>& size,
           const Vector<std::uint8_t>& along_first) {
            require_rows(size.shape(0), uv.shape(0), "size");
            require_rows(along_first.shape(0), uv.shape(0), "along_first");
            Array<NumberPair> rates(uv.shape(0));
            SurfaceStatus status{};
            {
                const nb::gil_scoped_release released;
                SurfaceReader reader(surface);
                reader.read(rows<Point2>(uv), 2);
                Array<RatePlace> places;
                for (std::size_t i = 0; i < rates.size(); ++i)
                    places.push_back({rows<Point2>(uv)[i],
                                      principal_directions(fundamental_forms(
                                          reader[1][i], reader[2][i],
                                          {reader[3][i], reader[4][i], reader[5][i]})),
                                      rows<std::uint8_t>(along_first)[i] != 0,
                                      rows<double>(size)[i]});
                status = reader.status();
                if (!reader.failed()) status = direction_rates(surface, places, rates);
            }
            raise_failure(surface, status);
            return view(rates);
        },
        nb::arg("surface"), nb::arg("uv"), nb::arg("size"), nb::arg("along_first"),
        "|K_t| and |k_n| (n, 2), 1 / model unit^2, at uv (n, 2); zero where they are not known.\n\n"
        "size (n,): a length. along_first (n,): is t the first principal direction?");
    m.def(
        "longest_along",
        [](const Matrix<double, 2>& rates, const Vector<double>& k1, const Vector<double>& k2,
           const Vector<double>& size, double chord) {
            require_rows(k1.shape(0), rates.shape(0), "k1");
            require_rows(k2.shape(0), rates.shape(0), "k2");
            require_rows(size.shape(0), rates.shape(0), "size");
            Array<double> found(rates.shape(0));
            for (std::size_t i = 0; i < found.size(); ++i)
                found[i] =
                    longest_along(rows<NumberPair>(rates)[i], {k1(i), k2(i)}, size(i), chord);
            return view(found);
        },
        nb::arg("rates"), nb::arg("k1"), nb::arg("k2"), nb::arg("size"), nb::arg("chord"),
        "Largest length (n,) of triangles that are size (n,) wide, at rates (n, 2); at least "
        "that.");
}

void bind_principal_lattice(nb::module_& m) {
    m.attr("LEAST_ROWS") = LEAST_ROWS;
    m.def(
        "keeps_lattice",
        [](const Surface& surface, std::pair<double, double> extent, const SizeRules& rules,
           double slope) {
            SurfaceReader reader(surface);
            const bool kept = [&] {
                const nb::gil_scoped_release released;
                return keeps_lattice(reader, {extent.first, extent.second}, rules, slope);
            }();
            raise_failure(surface, reader.status());
            if (std::exception_ptr failure = rules.take_failure()) std::rethrow_exception(failure);
            return kept;
        },
        nb::arg("surface"), nb::arg("extent"), nb::arg("rules"), nb::arg("slope"),
        "Does a lattice of triangles, laid along principal directions at one place, lie so "
        "everywhere?\n\nextent: of the surface's chart. rules: for such a lattice. slope: growth "
        "of sizes per length at most.");
}

void bind_bounded_features(nb::module_& m) {
    nb::class_<BoundedFeatures, HiddenFeatures>(m, "BoundedFeatures",
                                                "Features between samples, where derivatives are "
                                                "bounded.")
        .def(
            "__init__",
            [](BoundedFeatures* made, const SurfaceLaw& law, std::optional<double> angle,
               std::optional<double> chord) {
                new (made) BoundedFeatures(law.surface(), law.chart(), law.rules(), angle, chord);
            },
            nb::arg("law"), nb::arg("angle").none(), nb::arg("chord").none(),
            nb::keep_alive<1, 2>(),
            "angle (degrees), chord (model units): what is asked for. What rises or turns less "
            "than "
            "a fraction of these within a narrow or deep cell is no feature.");
}

}  // namespace

void bind_size_laws(nb::module_& m) {
    bind_surface_law(m);
    bind_stretched_law(m);
    bind_direction_rates(m);
    bind_principal_lattice(m);
    bind_bounded_features(m);
}

}  // namespace surfmesh::binding
