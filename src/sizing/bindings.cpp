#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/vector.h>

#include "binding/arrays.hpp"
#include "sizing/callback_rules.hpp"
#include "sizing/least_counts.hpp"
#include "sizing/rim_sizes.hpp"
#include "sizing/size_rules.hpp"
#include "surfaces/callback_surface.hpp"

namespace surfmesh::binding {

void bind_sizing(nb::module_& m);
void bind_asked_rules(nb::module_& m);
void bind_size_limits(nb::module_& m);
void bind_size_laws(nb::module_& m);

namespace {

using Numbers = Vector<double>;

PrincipalCurvatures pair_at(const Numbers& k1, const Numbers& k2, std::size_t i) {
    return {k1.data()[i], k2.data()[i]};
}

/// A formula of two curvatures and one number, at each of n places.
template <double (*formula)(PrincipalCurvatures, double)>
auto at_each(const Numbers& k1, const Numbers& k2, double number) {
    require_rows(k2.shape(0), k1.shape(0), "k2");
    Array<double> found(k1.shape(0));
    for (std::size_t i = 0; i < found.size(); ++i) found[i] = formula(pair_at(k1, k2, i), number);
    return view(found);
}

template <PrincipalSizes (*formula)(PrincipalCurvatures, double, double)>
auto principal_at_each(const Numbers& k1, const Numbers& k2, double number, const Numbers& ratio) {
    require_rows(k2.shape(0), k1.shape(0), "k2");
    require_rows(ratio.shape(0), k1.shape(0), "ratio");
    Array<double> first(k1.shape(0)), second(k1.shape(0));
    for (std::size_t i = 0; i < first.size(); ++i) {
        const PrincipalSizes found = formula(pair_at(k1, k2, i), number, ratio.data()[i]);
        first[i] = found.first;
        second[i] = found.second;
    }
    return std::pair(view(first), view(second));
}

void bind_formulas_of_sizes(nb::module_& m) {
    m.attr("DEVIATION_RESERVE") = DEVIATION_RESERVE;
    m.attr("ALIKE_RESERVE") = ALIKE_RESERVE;
    m.attr("ROUND_RESERVE") = ROUND_RESERVE;
    m.attr("BENT_RESERVE") = BENT_RESERVE;
    m.attr("STRETCHED_RESERVE") = STRETCHED_RESERVE;
    m.attr("STRAIGHT_RESERVE") = STRAIGHT_RESERVE;
    m.def(
        "deviation_factor",
        [](const Numbers& k1, const Numbers& k2) {
            require_rows(k2.shape(0), k1.shape(0), "k2");
            Array<double> found(k1.shape(0));
            for (std::size_t i = 0; i < found.size(); ++i)
                found[i] = deviation_factor(pair_at(k1, k2, i));
            return view(found);
        },
        nb::arg("k1"), nb::arg("k2"), "c (n,) with deviation = c h^2.");
    m.def("chord_size", &at_each<chord_size>, nb::arg("k1"), nb::arg("k2"), nb::arg("chord"),
          "Edge length (n,) at which triangles stay within chord.");
    m.def("lattice_chord_size", &at_each<lattice_chord_size>, nb::arg("k1"), nb::arg("k2"),
          nb::arg("chord"), "The same of a lattice laid where it deviates least.");
    m.def("quadratic_chord_size", &at_each<quadratic_chord_size>, nb::arg("k1"), nb::arg("k2"),
          nb::arg("chord"), "Edge length (n,) at which quadratic triangles stay within chord.");
    m.def(
        "share_of_width",
        [](const Numbers& k1, const Numbers& k2, const Numbers& ratio) {
            require_rows(k2.shape(0), k1.shape(0), "k2");
            require_rows(ratio.shape(0), k1.shape(0), "ratio");
            Array<double> found(k1.shape(0));
            for (std::size_t i = 0; i < found.size(); ++i)
                found[i] = share_of_width(pair_at(k1, k2, i), ratio.data()[i]);
            return view(found);
        },
        nb::arg("k1"), nb::arg("k2"), nb::arg("ratio"),
        "Fraction (n,) of a chord that may be used where it is the width of the band that a "
        "triangle needs.");
    m.def("angle_size", &at_each<angle_size>, nb::arg("k1"), nb::arg("k2"), nb::arg("angle"),
          "Edge length (n,) at which dihedral angles are at most angle (degrees).");
    m.def("normal_deviation_size", &at_each<normal_deviation_size>, nb::arg("k1"), nb::arg("k2"),
          nb::arg("angle"),
          "Edge length (n,) at which the normals of neighbours differ by at most angle (degrees).");
    m.def("principal_chord_sizes", &principal_at_each<principal_chord_sizes>, nb::arg("k1"),
          nb::arg("k2"), nb::arg("chord"), nb::arg("ratio"),
          "Edge lengths (n,), (n,) along the directions of k1 and k2, likewise.");
    m.def("evened_chord_sizes", &principal_at_each<evened_chord_sizes>, nb::arg("k1"),
          nb::arg("k2"), nb::arg("chord"), nb::arg("ratio"),
          "The same of triangles whose corners move until they lie nearer.");
    m.def("saddle_lattice_sizes", &principal_at_each<saddle_lattice_sizes>, nb::arg("k1"),
          nb::arg("k2"), nb::arg("chord"), nb::arg("ratio"),
          "The same of a lattice laid on a saddle where it deviates least.");
    m.def("principal_angle_sizes", &principal_at_each<principal_angle_sizes>, nb::arg("k1"),
          nb::arg("k2"), nb::arg("angle"), nb::arg("ratio"),
          "Edge lengths (n,), (n,) along the directions of k1 and k2, likewise.");
}

void bind_rim_sizes(nb::module_& m) {
    m.attr("RIM_RESERVE") = RIM_RESERVE;
    m.def(
        "rim_sizes",
        [](const Surface& surface, const Points2& uv, const Points2& step, double chord) {
            require_rows(step.shape(0), uv.shape(0), "step");
            Array<double> sizes(uv.shape(0));
            Array<Point3> tangents(uv.shape(0));
            SurfaceReader reader(surface);
            {
                const nb::gil_scoped_release released;
                reader.read(rows<Point2>(uv), 2);
                for (std::size_t i = 0; i < sizes.size(); ++i) {
                    const RimSize found = rim_size(reader, i, rows<Point2>(step)[i], chord);
                    sizes[i] = found.size;
                    tangents[i] = found.tangent;
                }
            }
            raise_failure(surface, reader.status());
            return std::pair(view(sizes), view(tangents));
        },
        nb::arg("surface"), nb::arg("uv"), nb::arg("step"), nb::arg("chord"),
        "Sizes (n,) that the curvature of lines of (u, v) allows along them, at uv (n, 2) in the "
        "directions step (n, 2), and unit tangents (n, 3); infinite and zero where a line has no "
        "speed.");
}

void bind_least_counts(nb::module_& m) {
    m.def(
        "least_densities",
        [](const Numbers& k1, const Numbers& k2, double chord, bool balanced) {
            require_rows(k2.shape(0), k1.shape(0), "k2");
            Array<double> least(k1.shape(0)), equilateral(k1.shape(0));
            for (std::size_t i = 0; i < least.size(); ++i) {
                const LeastDensity found = least_density(pair_at(k1, k2, i), chord, balanced);
                least[i] = found.least;
                equilateral[i] = found.equilateral;
            }
            return std::pair(view(least), view(equilateral));
        },
        nb::arg("k1"), nb::arg("k2"), nb::arg("chord"), nb::arg("balanced"),
        "The fewest triangles on a unit of area (n,) that chord allows, whatever their shape, and "
        "the fewest equilateral ones (n,). balanced: vertices may lie off the surface.");
    m.def(
        "least_segments",
        [](const Points3& line, bool closed, double chord, bool balanced) {
            return least_segments(rows<Point3>(line), closed, chord, balanced);
        },
        nb::arg("line"), nb::arg("closed"), nb::arg("chord"), nb::arg("balanced"),
        "The fewest segments that chord allows along a line with nodes (n, 3). closed: the first "
        "node, which is not repeated, follows the last.");
}

void bind_rules(nb::module_& m) {
    nb::class_<CurvatureRule>(m, "CurvatureRule", "Sizes that follow from the curvature.");
    nb::class_<PlaceRule>(m, "PlaceRule", "Sizes that depend on the place alone.");
    nb::class_<ChordRule, CurvatureRule>(m, "ChordRule")
        .def(
            nb::init<double, bool, bool, bool>(), nb::arg("chord"), nb::arg("is_width") = false,
            nb::arg("on_lattice") = false, nb::arg("evened") = false,
            "is_width: chord is that of the whole band that a triangle needs. on_lattice: edges "
            "lie where they deviate least. evened: of stretched triangles whose corners move until "
            "they lie nearer.");
    nb::class_<QuadraticChordRule, CurvatureRule>(m, "QuadraticChordRule")
        .def(nb::init<double>(), nb::arg("chord"));
    nb::class_<AngleRule, CurvatureRule>(m, "AngleRule")
        .def(nb::init<double, double>(), nb::arg("angle"), nb::arg("finest"),
             "angle: degrees. finest: nothing smaller is asked for, model units.");
    nb::class_<NormalDeviationRule, CurvatureRule>(m, "NormalDeviationRule")
        .def(nb::init<double, double>(), nb::arg("angle"), nb::arg("finest"), "Likewise.");
    nb::class_<ConstantSize, PlaceRule>(m, "ConstantSize").def(nb::init<double>(), nb::arg("size"));
    nb::class_<CallbackCurvatureRule, CurvatureRule>(m, "CallbackCurvatureRule")
        .def(nb::init<nb::object>(), nb::arg("rule"),
             "rule: a CurvatureRule of surfmesh.sizing.rules.rule.");
    nb::class_<CallbackPlaceRule, PlaceRule>(m, "CallbackPlaceRule")
        .def(nb::init<nb::object>(), nb::arg("rule"),
             "rule: a PlaceRule of surfmesh.sizing.rules.rule.");
    nb::class_<SizeRules>(m, "SizeRules", "All rules that hold on one surface.")
        .def(
            "__init__",
            [](SizeRules* made, std::vector<std::shared_ptr<CurvatureRule>> by_curvature,
               std::vector<std::shared_ptr<PlaceRule>> by_place, std::pair<double, double> clamp,
               double longest, double anisotropy) {
                new (made) SizeRules{{by_curvature.begin(), by_curvature.end()},
                                     {by_place.begin(), by_place.end()},
                                     clamp.first,
                                     clamp.second,
                                     longest,
                                     anisotropy};
            },
            nb::arg("by_curvature"), nb::arg("by_place"), nb::arg("clamp"), nb::arg("longest"),
            nb::arg("anisotropy"),
            "clamp: the smallest and the largest size. longest: the largest along the longer axis "
            "of an anisotropic metric. anisotropy: largest ratio of two sizes.");
}

}  // namespace

void bind_sizing(nb::module_& m) {
    m.doc() =
        "What sizes are asked for on one surface: rules, limits, and the law of a size field.";
    bind_formulas_of_sizes(m);
    bind_rim_sizes(m);
    bind_least_counts(m);
    bind_rules(m);
    bind_asked_rules(m);
    bind_size_limits(m);
    bind_size_laws(m);
}

}  // namespace surfmesh::binding
