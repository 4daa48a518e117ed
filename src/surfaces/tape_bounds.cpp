#include "surfaces/tape_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "elementary_functions/bessel.hpp"
#include "elementary_functions/error_function.hpp"
#include "elementary_functions/exponential.hpp"
#include "elementary_functions/hyperbolic.hpp"
#include "elementary_functions/inverse_trigonometric.hpp"
#include "elementary_functions/logarithm.hpp"
#include "elementary_functions/power.hpp"
#include "surfaces/outward.hpp"
#include "surfaces/tape_evaluation.hpp"

namespace surfmesh {
namespace {

using Slots = TapeSlots<Interval>;

constexpr std::size_t CELLS_TOGETHER =
    64;  // a register of cells is 1 kB, a tape of them stays near

/// What one instruction reads and writes: n intervals each.
struct Operands {
    Interval* out;
    const Interval *a, *b, *c;
    std::size_t n;
};

template <class Function>
void each(const Operands& o, Function f) {
    for (std::size_t k = 0; k < o.n; ++k) o.out[k] = f(o.a[k]);
}

template <class Function>
void each_pair(const Operands& o, Function f) {
    for (std::size_t k = 0; k < o.n; ++k) o.out[k] = f(o.a[k], o.b[k]);
}

/// A function at both ends of all intervals.
void map_ends(const Operands& o, void (*f)(std::span<const double>, std::span<double>)) {
    static_assert(sizeof(Interval) == 2 * sizeof(double));
    f({reinterpret_cast<const double*>(o.a), 2 * o.n}, {reinterpret_cast<double*>(o.out), 2 * o.n});
}

void each_increasing(const Operands& o, double (*f)(double), double first = -intervals::INFINITE,
                     double last = intervals::INFINITE) {
    each(o, [=](Interval a) { return intervals::increasing(a, f, first, last); });
}

void each_steady(const Operands& o, double (*f)(double), double lowest, double highest) {
    constexpr double STEEPEST = 0.44;  // the steepest slope of all is that of j0: 0.4362
    each(o, [=](Interval a) { return intervals::steady(a, f, STEEPEST, lowest, highest); });
}

/// Sums, products and what else needs no function. False: none of them.
bool run_arithmetic(const Instruction& step, const Operands& o) {
    namespace i = intervals;
    switch (step.operation) {
        case Operation::ADD:
            each_pair(o, i::add);
            return true;
        case Operation::SUBTRACT:
            each_pair(o, i::subtract);
            return true;
        case Operation::MULTIPLY:
            each_pair(o, i::multiply);
            return true;
        case Operation::DIVIDE:
            each_pair(o, i::divide);
            return true;
        case Operation::NEGATIVE:
            each(o, i::negative);
            return true;
        case Operation::RECIPROCAL:
            each(o, i::reciprocal);
            return true;
        case Operation::INTEGER_POWER:
            each(o, [n = step.exponent](Interval a) { return i::integer_power(a, n); });
            return true;
        case Operation::SQRT:
            each(o, i::sqrt);
            return true;
        case Operation::ABSOLUTE:
            each(o, i::absolute);
            return true;
        case Operation::FLOOR:
            each_increasing(o, [](double x) { return std::floor(x); });
            return true;
        case Operation::MINIMUM:
            each_pair(o, i::minimum);
            return true;
        case Operation::MAXIMUM:
            each_pair(o, i::maximum);
            return true;
        default:
            return false;
    }
}

/// Choices and the slopes of what breaks off. False: none of them.
bool run_choice(const Instruction& instruction, const Operands& o, Kinks kinks) {
    namespace i = intervals;
    switch (instruction.operation) {
        case Operation::SIGNUM:
            each(o, i::signum);
            return true;
        case Operation::SIDE:
            each(o, i::slope_side);
            return true;
        case Operation::UNIT_STEP:
            each(o, i::step);
            return true;
        case Operation::STEP:
            each(o, i::slope_step);
            return true;
        case Operation::CHOSEN:
            for (std::size_t k = 0; k < o.n; ++k) o.out[k] = i::chosen(o.a[k], o.b[k], o.c[k]);
            return true;
        case Operation::KINK:
            if (kinks == Kinks::LEFT_OUT)
                std::fill_n(o.out, o.n, Interval{0.0, 0.0});
            else
                each(o, i::kink);
            return true;
        case Operation::JUMP:
            each(o, i::jump);
            return true;
        case Operation::TREAD:
            each(o, i::tread);
            return true;
        case Operation::CUT:
            each_pair(o, i::cut);
            return true;
        default:
            return false;
    }
}

/// The functions that increase, where they are defined. False: none of them.
bool run_increasing(const Instruction& step, const Operands& o) {
    namespace e = elementary;
    switch (step.operation) {
        case Operation::CUBE_ROOT:
            each_increasing(o, e::cbrt);
            return true;
        case Operation::EXP:
            map_ends(o, e::exp);
            each_pair({o.out, o.out, o.out, o.c, o.n}, [](Interval found, Interval) {
                return intervals::known(found.lo, found.hi);
            });
            return true;
        case Operation::LOG:
            each_increasing(o, e::log, 0.0);
            return true;
        case Operation::ASIN:
            each_increasing(o, e::asin, -1.0, 1.0);
            return true;
        case Operation::ATAN:
            each_increasing(o, e::atan);
            return true;
        case Operation::SINH:
            each_increasing(o, e::sinh);
            return true;
        case Operation::TANH:
            each_increasing(o, e::tanh);
            return true;
        case Operation::ASINH:
            each_increasing(o, e::asinh);
            return true;
        case Operation::ACOSH:
            each_increasing(o, e::acosh, 1.0);
            return true;
        case Operation::ATANH:
            each_increasing(o, e::atanh, -1.0, 1.0);
            return true;
        case Operation::ERF:
            each_increasing(o, e::erf);
            return true;
        default:
            return false;
    }
}

void run_function(const Instruction& step, const Operands& o) {
    namespace i = intervals;
    switch (step.operation) {
        case Operation::POWER:
            return each_pair(o, i::power);
        case Operation::SIN:
            return each(o, i::sin);
        case Operation::COS:
            return each(o, i::cos);
        case Operation::TAN:
            return each(o, i::tan);
        case Operation::ACOS:
            return each(o, i::acos);
        case Operation::COSH:
            return each(o, i::cosh);
        case Operation::ANGLE:
            return each_pair(o, i::angle);
        case Operation::TURN:
            return each_pair(o, i::turn);
        case Operation::BESSEL_0:
            return each_steady(o, elementary::bessel_0, -0.2173, 1.0);
        case Operation::BESSEL_1:
            return each_steady(o, elementary::bessel_1, -0.4362, 0.4362);
        case Operation::BESSEL_2:
            return each_steady(o, elementary::bessel_2, -0.1396, 0.3069);
        default:
            return;
    }
}

void run(const Instruction& step, const Slots& slots, std::size_t n, Kinks kinks) {
    const auto [a, b, c] = step.operands;
    const Operands o{slots[step.target], slots[a], slots[b], slots[c], n};
    if (!run_arithmetic(step, o) && !run_choice(step, o, kinks) && !run_increasing(step, o))
        run_function(step, o);
}

/// Outwards by more than the round-off of a tape of ordinary length: of the larger end, since
/// that much may have cancelled, or of the one that is finite.
Interval widened(Interval a) {
    const double low = std::abs(a.lo), high = std::abs(a.hi);
    const double larger = intervals::larger(low, high);
    const double size = std::isfinite(larger) ? larger : std::isfinite(low) ? low : high;
    const double margin = std::isfinite(size) ? 1e-13 * size : 0.0;
    return {a.lo - margin, a.hi + margin};
}

/// By how many ulps a function's computed ends are off at most: their headers say how exact the
/// elementary functions are. Sums and products are rounded as they are made.
double ulps_of(const Instruction& step) {
    switch (step.operation) {
        case Operation::NEGATIVE:
        case Operation::ABSOLUTE:
        case Operation::MINIMUM:
        case Operation::MAXIMUM:
        case Operation::SIGNUM:
        case Operation::SIDE:
        case Operation::UNIT_STEP:
        case Operation::STEP:
        case Operation::FLOOR:
        case Operation::CHOSEN:
        case Operation::KINK:
        case Operation::JUMP:
        case Operation::TREAD:
        case Operation::CUT:
            return 0.0;
        case Operation::RECIPROCAL:
        case Operation::SQRT:
            return 0.5;
        case Operation::INTEGER_POWER:  // a product's relative error is the sum of its factors'
            return static_cast<double>(step.exponent);
        case Operation::TURN:  // pi is added
            return 4.0;
        default:
            return 3.0;
    }
}

bool is_bessel(Operation operation) {
    return operation == Operation::BESSEL_0 || operation == Operation::BESSEL_1 ||
           operation == Operation::BESSEL_2;
}

/// Waves of angles so large say nothing: their phase is not known well enough.
Interval known_phase(Interval a, Interval found) {
    constexpr double FARTHEST = 1e6;
    return std::abs(a.lo) < FARTHEST && std::abs(a.hi) < FARTHEST ? found : Interval{-1.0, 1.0};
}

/// Which instructions the outputs from ``first`` on depend on.
Array<std::uint8_t> needed_for(const Tape& tape, std::size_t first) {
    const std::span<const Instruction> steps = tape.instructions();
    const std::size_t slots = tape.inputs() + tape.constants().size() + tape.registers();
    if (first == 0) return Array<std::uint8_t>(steps.size(), 1);
    Array<std::uint8_t> live(slots, 0), needed(steps.size(), 0);
    for (const std::int32_t output : tape.outputs().subspan(first)) live[output] = 1;
    for (std::size_t k = steps.size(); k-- > 0;) {
        const Instruction& step = steps[k];
        if (live[step.target] == 0) continue;
        needed[static_cast<std::ptrdiff_t>(k)] = 1;
        live[step.target] = 0;  // what it held before is not read any more, but by itself
        for (const std::int32_t operand : step.operands) live[operand] = 1;
    }
    return needed;
}

/// Which numbers tapes are run in, and what becomes of their outputs.
struct Arithmetic {
    Interval (*constant)(double);
    void (*run)(const Instruction&, const Slots&, std::size_t, Kinks);
    Interval (*output)(Interval);
};

void bounds_in(const Arithmetic& arithmetic, const Tape& tape, std::span<const double> lo,
               std::span<const double> hi, Kinks kinks, std::size_t first, std::span<double> lower,
               std::span<double> upper) {
    const std::size_t inputs = tape.inputs();
    const std::size_t count = inputs == 0 ? 0 : lo.size() / inputs;
    const std::size_t lanes = std::min(count, CELLS_TOGETHER);
    const std::span<const std::int32_t> outputs = tape.outputs();
    if (first >= outputs.size()) return;
    const std::size_t stride = outputs.size() - first;
    const Array<std::uint8_t> needed = needed_for(tape, first);
    const Slots slots(tape, lanes);
    auto constant = static_cast<std::int32_t>(inputs);
    for (const double value : tape.constants())
        std::fill_n(slots[constant++], lanes, arithmetic.constant(value));
    for (std::size_t start = 0; start < count; start += lanes) {
        const std::size_t n = std::min(lanes, count - start);
        for (std::size_t column = 0; column < inputs; ++column) {
            Interval* input = slots[static_cast<std::int32_t>(column)];
            for (std::size_t k = 0; k < n; ++k) {
                const std::size_t from = (start + k) * inputs + column;
                input[k] = {lo[from], hi[from]};
            }
        }
        for (std::size_t k = 0; k < needed.size(); ++k)
            if (needed[static_cast<std::ptrdiff_t>(k)] != 0)
                arithmetic.run(tape.instructions()[k], slots, n, kinks);
        for (std::size_t k = 0; k < stride; ++k) {
            const Interval* found = slots[outputs[first + k]];
            for (std::size_t i = 0; i < n; ++i) {
                const Interval wide = arithmetic.output(found[i]);
                lower[(start + i) * stride + k] = wide.lo;
                upper[(start + i) * stride + k] = wide.hi;
            }
        }
    }
}

}  // namespace

void run_outward(const Instruction& step, const TapeSlots<Interval>& slots, std::size_t n) {
    const auto [a, b, c] = step.operands;
    const Operands o{slots[step.target], slots[a], slots[b], slots[c], n};
    if (step.operation == Operation::ADD) return each_pair(o, outward::add);
    if (step.operation == Operation::SUBTRACT) return each_pair(o, outward::subtract);
    if (step.operation == Operation::MULTIPLY) return each_pair(o, outward::multiply);
    if (step.operation == Operation::DIVIDE) return each_pair(o, outward::divide);
    if (is_bessel(step.operation)) {  // a middle, and a slope from there
        constexpr double ROUNDING = 0x1p-47;
        run(step, slots, n, Kinks::UNBOUNDED);
        return each_pair({o.out, o.out, o.a, o.a, n}, [](Interval found, Interval) {
            return Interval{found.lo - ROUNDING, found.hi + ROUNDING};
        });
    }
    const bool wave = step.operation == Operation::SIN || step.operation == Operation::COS;
    if (wave) {
        const bool is_sine = step.operation == Operation::SIN;
        return each(o, [is_sine](Interval angle) {
            const Interval found = is_sine ? intervals::sin(angle) : intervals::cos(angle);
            return outward::widened(known_phase(angle, found), 1.0);
        });
    }
    run(step, slots, n, Kinks::UNBOUNDED);
    const double ulps = ulps_of(step);
    if (ulps == 0.5)
        for (std::size_t k = 0; k < n; ++k) o.out[k] = outward::rounded(o.out[k]);
    else if (ulps > 0.0)
        for (std::size_t k = 0; k < n; ++k) o.out[k] = outward::widened(o.out[k], ulps);
}

Interval outward_constant(double x) {
    const bool whole = x == std::floor(x) && std::abs(x) < 0x1p53;
    return whole ? Interval{x, x} : outward::widened({x, x}, 4.0);
}

void bounds(const Tape& tape, std::span<const double> lo, std::span<const double> hi, Kinks kinks,
            std::size_t first, std::span<double> lower, std::span<double> upper) {
    constexpr Arithmetic NEAREST = {[](double x) { return Interval{x, x}; }, run, widened};
    bounds_in(NEAREST, tape, lo, hi, kinks, first, lower, upper);
}

void enclosures(const Tape& tape, std::span<const double> lo, std::span<const double> hi,
                std::size_t first, std::span<double> lower, std::span<double> upper) {
    constexpr Arithmetic OUTWARD = {outward_constant,
                                    [](const Instruction& step, const Slots& slots, std::size_t n,
                                       Kinks) { run_outward(step, slots, n); },
                                    [](Interval found) { return found; }};
    bounds_in(OUTWARD, tape, lo, hi, Kinks::UNBOUNDED, first, lower, upper);
}

}  // namespace surfmesh
