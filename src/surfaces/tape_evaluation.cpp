#include "surfaces/tape_evaluation.hpp"

#include <algorithm>
#include <cmath>

#include "elementary_functions/bessel.hpp"
#include "elementary_functions/error_function.hpp"
#include "elementary_functions/exponential.hpp"
#include "elementary_functions/hyperbolic.hpp"
#include "elementary_functions/inverse_trigonometric.hpp"
#include "elementary_functions/logarithm.hpp"
#include "elementary_functions/power.hpp"
#include "elementary_functions/sine_cosine.hpp"

namespace surfmesh {
namespace {

using Slots = TapeSlots<double>;

/// What one instruction reads and writes: n numbers each.
struct Operands {
    double* out;
    const double *a, *b, *c;
    std::size_t n;

    [[nodiscard]] std::span<double> target() const { return {out, n}; }
    [[nodiscard]] std::span<const double> first() const { return {a, n}; }
    [[nodiscard]] std::span<const double> second() const { return {b, n}; }
};

template <class Function>
void each(const Operands& o, Function f) {
    for (std::size_t k = 0; k < o.n; ++k) o.out[k] = f(o.a[k]);
}

template <class Function>
void each_pair(const Operands& o, Function f) {
    for (std::size_t k = 0; k < o.n; ++k) o.out[k] = f(o.a[k], o.b[k]);
}

double sign(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : x == 0.0 ? 0.0 : x; }
double step(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? 0.0 : x == 0.0 ? 0.5 : x; }
/// nan where either is.
double smaller(double a, double b) { return a < b || a != a ? a : b; }
double larger(double a, double b) { return a > b || a != a ? a : b; }

/// x^n by repeated multiplication, bit by bit from the top.
void integer_power(const Operands& o, std::int32_t n) {
    const auto bits = static_cast<std::uint32_t>(n);
    int bit = std::bit_width(bits) - 2;
    for (std::size_t k = 0; k < o.n; ++k) o.out[k] = o.a[k] * o.a[k];
    if (bits >> bit & 1)
        for (std::size_t k = 0; k < o.n; ++k) o.out[k] *= o.a[k];
    while (--bit >= 0) {
        for (std::size_t k = 0; k < o.n; ++k) o.out[k] *= o.out[k];
        if (bits >> bit & 1)
            for (std::size_t k = 0; k < o.n; ++k) o.out[k] *= o.a[k];
    }
}

/// Sums, products and what else needs no function. False: none of them.
bool run_arithmetic(const Instruction& step, const Operands& o) {
    switch (step.operation) {
        case Operation::ADD:
            each_pair(o, [](double a, double b) { return a + b; });
            return true;
        case Operation::SUBTRACT:
            each_pair(o, [](double a, double b) { return a - b; });
            return true;
        case Operation::MULTIPLY:
            each_pair(o, [](double a, double b) { return a * b; });
            return true;
        case Operation::DIVIDE:
            each_pair(o, [](double a, double b) { return a / b; });
            return true;
        case Operation::NEGATIVE:
            each(o, [](double a) { return -a; });
            return true;
        case Operation::RECIPROCAL:
            each(o, [](double a) { return 1.0 / a; });
            return true;
        case Operation::INTEGER_POWER:
            integer_power(o, step.exponent);
            return true;
        case Operation::SQRT:
            each(o, [](double a) { return std::sqrt(a); });
            return true;
        case Operation::ABSOLUTE:
            each(o, [](double a) { return std::abs(a); });
            return true;
        case Operation::FLOOR:
            each(o, [](double a) { return std::floor(a); });
            return true;
        case Operation::MINIMUM:
            each_pair(o, smaller);
            return true;
        case Operation::MAXIMUM:
            each_pair(o, larger);
            return true;
        default:
            return false;
    }
}

/// Choices and the slopes of what breaks off. False: none of them.
bool run_choice(const Instruction& instruction, const Operands& o) {
    switch (instruction.operation) {
        case Operation::SIGNUM:
        case Operation::SIDE:
            each(o, sign);
            return true;
        case Operation::UNIT_STEP:
        case Operation::STEP:
            each(o, step);
            return true;
        case Operation::CHOSEN:
            for (std::size_t k = 0; k < o.n; ++k) o.out[k] = o.a[k] >= 0.0 ? o.b[k] : o.c[k];
            return true;
        case Operation::KINK:
        case Operation::JUMP:
        case Operation::TREAD:
        case Operation::CUT:
            std::fill_n(o.out, o.n, 0.0);
            return true;
        default:
            return false;
    }
}

void run_function(const Instruction& step, const Operands& o) {
    namespace e = elementary;
    switch (step.operation) {
        case Operation::POWER:
            return e::pow(o.first(), o.second(), o.target());
        case Operation::CUBE_ROOT:
            return e::cbrt(o.first(), o.target());
        case Operation::EXP:
            return e::exp(o.first(), o.target());
        case Operation::LOG:
            return e::log(o.first(), o.target());
        case Operation::SIN:
            return e::sin(o.first(), o.target());
        case Operation::COS:
            return e::cos(o.first(), o.target());
        case Operation::TAN:
            return e::tan(o.first(), o.target());
        case Operation::ASIN:
            return e::asin(o.first(), o.target());
        case Operation::ACOS:
            return e::acos(o.first(), o.target());
        case Operation::ATAN:
            return e::atan(o.first(), o.target());
        case Operation::TURN:
        case Operation::ANGLE:
            return e::atan2(o.first(), o.second(), o.target());
        case Operation::SINH:
            return e::sinh(o.first(), o.target());
        case Operation::COSH:
            return e::cosh(o.first(), o.target());
        case Operation::TANH:
            return e::tanh(o.first(), o.target());
        case Operation::ASINH:
            return e::asinh(o.first(), o.target());
        case Operation::ACOSH:
            return e::acosh(o.first(), o.target());
        case Operation::ATANH:
            return e::atanh(o.first(), o.target());
        case Operation::ERF:
            return e::erf(o.first(), o.target());
        case Operation::BESSEL_0:
            return e::bessel_0(o.first(), o.target());
        case Operation::BESSEL_1:
            return e::bessel_1(o.first(), o.target());
        case Operation::BESSEL_2:
            return e::bessel_2(o.first(), o.target());
        default:
            return;  // the others are arithmetic and choices
    }
}

/// A sine or cosine; ``spare``: what the other one of its angle is kept in.
void run_shared(const Instruction& step, const Operands& o, bool is_second,
                std::span<double> spare) {
    if (is_second)
        std::copy(spare.begin(), spare.end(), o.out);
    else if (step.operation == Operation::SIN)
        elementary::sincos(o.first(), o.target(), spare);
    else
        elementary::sincos(o.first(), spare, o.target());
}

/// All instructions, on the first n numbers of the slots.
void run(const Tape& tape, const Slots& slots, std::span<double> spares, std::size_t n) {
    const std::size_t lanes = tape.spares() == 0 ? 0 : spares.size() / tape.spares();
    for (std::size_t k = 0; k < tape.instructions().size(); ++k) {
        const Instruction& step = tape.instructions()[k];
        const SharedAngle shared = tape.shared_angles()[k];
        const auto [a, b, c] = step.operands;
        const Operands o{slots[step.target], slots[a], slots[b], slots[c], n};
        if (shared.spare >= 0)
            run_shared(step, o, shared.is_second,
                       spares.subspan(static_cast<std::size_t>(shared.spare) * lanes, n));
        else if (!run_arithmetic(step, o) && !run_choice(step, o))
            run_function(step, o);
    }
}

}  // namespace

void evaluate(const Tape& tape, std::span<const double> points, std::span<Point3> out) {
    const std::size_t inputs = tape.inputs();
    const std::size_t count = inputs == 0 ? 0 : points.size() / inputs;
    const std::size_t lanes = std::min(count, TAPE_BLOCK);
    const Slots slots(tape, lanes);
    const Array<double> spares(tape.spares() * lanes);
    auto constant = static_cast<std::int32_t>(inputs);
    for (const double value : tape.constants()) std::fill_n(slots[constant++], lanes, value);
    for (std::size_t start = 0; start < count; start += lanes) {
        const std::size_t n = std::min(lanes, count - start);
        for (std::size_t column = 0; column < inputs; ++column) {
            double* input = slots[static_cast<std::int32_t>(column)];
            for (std::size_t k = 0; k < n; ++k) input[k] = points[(start + k) * inputs + column];
        }
        run(tape, slots, spares, n);
        for (std::size_t k = 0; k < tape.outputs().size() / 3; ++k) {
            const double *x = slots[tape.outputs()[3 * k]], *y = slots[tape.outputs()[3 * k + 1]],
                         *z = slots[tape.outputs()[3 * k + 2]];
            Point3* values = out.data() + k * count + start;
            for (std::size_t i = 0; i < n; ++i) values[i] = {x[i], y[i], z[i]};
        }
    }
}

}  // namespace surfmesh
