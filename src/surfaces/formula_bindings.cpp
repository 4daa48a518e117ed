#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <string>
#include <tuple>
#include <vector>

#include "binding/arrays.hpp"
#include "surfaces/formula_surface.hpp"
#include "surfaces/tape.hpp"
#include "surfaces/tape_balls.hpp"
#include "surfaces/tape_bounds.hpp"
#include "surfaces/tape_evaluation.hpp"

namespace surfmesh::binding {
namespace {

using Rows = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using NewVectors = nb::ndarray<nb::numpy, double, nb::shape<-1, -1, 3>>;
using NewRows = nb::ndarray<nb::numpy, double, nb::ndim<2>>;
using GivenInstruction =
    std::tuple<std::string, std::int32_t, std::vector<std::int32_t>, std::int32_t>;

std::string fault_in_words(const TapeCheck& check) {
    const std::string number = "instruction " + std::to_string(check.instruction);
    switch (check.fault) {
        case TapeFault::NONE:
            return "";
        case TapeFault::TOO_LARGE:
            return "there are too many slots, or less than none";
        case TapeFault::READS_UNWRITTEN:
            return number + " reads a register before it is written";
        case TapeFault::WRITES_OUTSIDE:
            return number + " writes outside the registers";
        case TapeFault::OVERWRITES_BASE:
            return number + " overwrites the base of a power";
        case TapeFault::BAD_EXPONENT:
            return number + " has an exponent below 2";
        case TapeFault::OUTPUT_UNWRITTEN:
            return "an output is never written";
    }
    return "";
}

Instruction instruction(const GivenInstruction& given) {
    const auto& [name, target, operands, exponent] = given;
    const std::optional<Operation> operation = operation_named(name);
    if (!operation) throw nb::value_error(("there is no operation " + name).c_str());
    const auto wanted = operation_kinds()[static_cast<std::size_t>(*operation)].operands;
    if (operands.size() != static_cast<std::size_t>(wanted))
        throw nb::value_error((name + " takes " + std::to_string(wanted) + " operands").c_str());
    Instruction made{*operation, target, {0, 0, 0}, exponent};
    std::copy(operands.begin(), operands.end(), made.operands.begin());
    return made;
}

Tape::Program program(std::int32_t inputs, const std::vector<double>& constants,
                      const std::vector<GivenInstruction>& instructions, std::int32_t registers,
                      const std::vector<std::int32_t>& outputs) {
    Tape::Program made{inputs,
                       Array<double>(std::span<const double>(constants)),
                       {},
                       registers,
                       Array<std::int32_t>(std::span<const std::int32_t>(outputs))};
    for (const GivenInstruction& given : instructions)
        made.instructions.push_back(instruction(given));
    return made;
}

std::span<const double> numbers(const Tape& tape, const Rows& points, const char* what) {
    if (points.shape(1) != tape.inputs())
        throw nb::value_error((std::string(what) + " has " + std::to_string(points.shape(1)) +
                               " columns instead of " + std::to_string(tape.inputs()))
                                  .c_str());
    return {points.data(), points.size()};
}

NewVectors evaluate_tape(const Tape& tape, const Rows& points) {
    const std::span<const double> given = numbers(tape, points, "points");
    const std::size_t count = points.shape(0), vectors = tape.outputs().size() / 3;
    Array<Point3> found(vectors * count);
    {
        const nb::gil_scoped_release released;
        evaluate(tape, given, found);
    }
    const std::size_t shape[] = {vectors, count, 3};
    const nb::object owner = nb::cast(view(found));
    return NewVectors(reinterpret_cast<double*>(found.data()), 3, shape, owner);
}

std::pair<NewRows, NewRows> bound_tape(const Tape& tape, const Rows& lo, const Rows& hi,
                                       bool kinks) {
    const std::span<const double> low = numbers(tape, lo, "lo"), high = numbers(tape, hi, "hi");
    require_rows(hi.shape(0), lo.shape(0), "hi");
    const std::size_t shape[] = {lo.shape(0), tape.outputs().size()};
    Array<double> lower(shape[0] * shape[1]), upper(shape[0] * shape[1]);
    {
        const nb::gil_scoped_release released;
        bounds(tape, low, high, kinks ? Kinks::UNBOUNDED : Kinks::LEFT_OUT, 0, lower, upper);
    }
    const auto shaped = [&](const Array<double>& values) {
        return NewRows(values.data(), 2, shape, nb::cast(view(values)));
    };
    return std::pair(shaped(lower), shaped(upper));
}

std::pair<NewRows, NewRows> enclose_tape(const Tape& tape, const Rows& points) {
    const std::span<const double> given = numbers(tape, points, "points");
    const std::size_t shape[] = {points.shape(0), tape.outputs().size()};
    Array<Ball> found(shape[0] * shape[1]);
    Array<double> mid, rad;
    {
        const nb::gil_scoped_release released;
        enclose_outputs(tape, given, found);
        for (const Ball& ball : found) {
            mid.push_back(ball.mid);
            rad.push_back(ball.rad);
        }
    }
    const auto shaped = [&](const Array<double>& values) {
        return NewRows(values.data(), 2, shape, nb::cast(view(values)));
    };
    return std::pair(shaped(mid), shaped(rad));
}

void bind_tape(nb::module_& m) {
    nb::list names;
    for (const OperationKind& kind : operation_kinds())
        names.append(nb::str(kind.name.data(), kind.name.size()));
    m.attr("OPERATIONS") = nb::tuple(names);
    m.attr("BLOCK") = TAPE_BLOCK;
    nb::class_<Tape>(m, "Tape", "A straight-line program of elementary operations. Immutable.")
        .def(
            "__init__",
            [](Tape* self, std::int32_t inputs, const std::vector<double>& constants,
               const std::vector<GivenInstruction>& instructions, std::int32_t registers,
               const std::vector<std::int32_t>& outputs) {
                Tape::Program made = program(inputs, constants, instructions, registers, outputs);
                const TapeCheck check = Tape::check(made);
                if (check.fault != TapeFault::NONE)
                    throw nb::value_error(fault_in_words(check).c_str());
                std::construct_at(self, std::move(made));
            },
            nb::arg("inputs"), nb::arg("constants"), nb::arg("instructions"), nb::arg("registers"),
            nb::arg("outputs"),
            "Slots are numbered inputs first, then constants, then registers.\n\n"
            "instructions: (operation, target, operands, exponent) each, operation one of "
            "OPERATIONS, exponent 0 but for \"integer_power\". ValueError for a program that reads "
            "what was not written, writes elsewhere than into registers, or the like.")
        .def("evaluate", evaluate_tape, nb::arg("points"),
             "Outputs at points (n, inputs), three together: (m, n, 3).\n\n"
             "What is undefined comes out as nan or infinity.")
        .def("enclose", enclose_tape, nb::arg("points"),
             "Outputs at points (n, inputs), proved: each within rad of mid, both (n, outputs).\n\n"
             "Constants are taken within four ulps; rad is infinite where nothing is known.")
        .def("bounds", bound_tape, nb::arg("lo"), nb::arg("hi"), nb::arg("kinks"),
             "Bounds over cells: lo, hi (n, inputs) -> lower, upper (n, outputs).\n\n"
             "Infinite where nothing is known. kinks: False leaves out what second derivatives "
             "are across kinks.");
}

using SharedTape = std::shared_ptr<Tape>;
using PieceLimits = std::tuple<std::vector<double>, std::vector<double>, std::vector<double>>;

SpeedLimits speed_limits(const PieceLimits& given) {
    const auto& [places, lowest, highest] = given;
    const std::size_t pieces = places.empty() ? 0 : places.size() - 1;
    if (lowest.size() != pieces || highest.size() != pieces)
        throw nb::value_error("the limits of m places are m - 1 lowest and m - 1 highest numbers");
    const auto array = [](const std::vector<double>& x) {
        return Array<double>(std::span<const double>(x));
    };
    return {array(places), array(lowest), array(highest)};
}

FormulaSurface::Tapes surface_tapes(const std::vector<SharedTape>& given) {
    if (given.size() != 3) throw nb::value_error("there are three tapes, of order 0, 1 and 2");
    FormulaSurface::Tapes tapes;
    for (std::size_t order = 0; order < 3; ++order) {
        const SharedTape& tape = given[order];
        const std::size_t wanted = 3 * derivative_count(static_cast<int>(order));
        if (tape && (tape->inputs() != 2 || tape->outputs().size() != wanted))
            throw nb::value_error("a tape of a surface has two inputs and 3, 9 or 18 outputs");
        tapes[order] = tape;
    }
    return tapes;
}

void bind_formula_surface(nb::module_& m) {
    using Ends = std::pair<double, double>;
    nb::class_<FormulaSurface, Surface>(m, "FormulaSurface", "The surface of three formulas.")
        .def(
            "__init__",
            [](FormulaSurface* self, const std::vector<SharedTape>& tapes,
               const std::pair<Ends, Ends>& domain,
               const std::pair<PieceLimits, PieceLimits>& limits) {
                const auto& [u, v] = domain;
                std::construct_at(
                    self, surface_tapes(tapes),
                    ParameterBox{{u.first, v.first}, {u.second, v.second}},
                    std::array{speed_limits(limits.first), speed_limits(limits.second)});
            },
            nb::sig("def __init__(self, tapes: Sequence[Tape | None], domain: tuple[tuple[float, "
                    "float], tuple[float, float]], limits: Sequence[tuple[Sequence[float], "
                    "Sequence[float], Sequence[float]]]) -> None"),
            nb::arg("tapes"), nb::arg("domain"), nb::arg("limits"),
            "tapes: of r, with r_u and r_v, with r_uu, r_uv, r_vv; None for an order that is not "
            "wanted.\n\nlimits: for u and for v (places, lowest, highest): places of infinite "
            "speed, and within which limits derivatives are taken between them; all empty where "
            "the speed is finite.");
}

}  // namespace

void bind_formulas(nb::module_& m) {
    bind_tape(m);
    bind_formula_surface(m);
}

}  // namespace surfmesh::binding
