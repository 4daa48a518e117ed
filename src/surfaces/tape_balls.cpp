#include "surfaces/tape_balls.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "elementary_functions/bits.hpp"
#include "elementary_functions/exponential.hpp"
#include "elementary_functions/logarithm.hpp"
#include "elementary_functions/sine_cosine.hpp"
#include "surfaces/outward.hpp"
#include "surfaces/tape_bounds.hpp"
#include "surfaces/tape_evaluation.hpp"

namespace surfmesh {
namespace {

constexpr double HALF_ULP = 0x1p-53;  // relative
constexpr double FUNCTION_ULPS = 3.0 * 0x1p-52;
constexpr double UNDERFLOWN = 1e-300;    // more than what underflows in one step
constexpr double WIDER = 1.0 + 0x1p-30;  // of ten operations for each of many instructions
constexpr std::int32_t MOST_FACTORS = 1024;

/// Rows of n middles and of n radii.
struct Row {
    double *mid, *rad;
};
struct ConstRow {
    const double *mid, *rad;
};

/// The slots of a tape, and one row more, which an instruction writes and which then takes the place of
/// its target: so that it may read what it replaces.
class BallSlots {
  public:
    BallSlots(const Tape& tape, std::size_t lanes)
        : rows_(tape.inputs() + tape.constants().size() + tape.registers() + 1),
          memory_(2 * lanes * rows_.size()) {
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            double* row = memory_.data() + 2 * lanes * k;
            rows_.begin()[k] = {row, row + lanes};
        }
    }

    [[nodiscard]] Row target(std::int32_t slot) const { return rows_[slot]; }
    [[nodiscard]] ConstRow operator[](std::int32_t slot) const {
        return {rows_[slot].mid, rows_[slot].rad};
    }
    [[nodiscard]] Row spare() const { return rows_.end()[-1]; }
    void take_spare(std::int32_t slot) { std::swap(rows_[slot], rows_.end()[-1]); }
    void fill(std::int32_t slot, std::size_t n, Ball ball) const {
        std::fill_n(rows_[slot].mid, n, ball.mid);
        std::fill_n(rows_[slot].rad, n, ball.rad);
    }

  private:
    Array<Row> rows_;
    Array<double> memory_;
};

Ball ball_of(Interval a) {
    if (!(outward::magnitude(a) < intervals::INFINITE)) return {0.0, intervals::INFINITE};
    const double mid = 0.5 * a.lo + 0.5 * a.hi;
    const double rad = std::max(a.hi - mid, mid - a.lo);
    return {mid, rad > 0.0 ? outward::above(rad) : 0.0};  // 0 is exact, and no denormal number
}

Interval interval_of(double mid, double rad) {
    if (!(std::abs(mid) + rad < intervals::INFINITE))
        return {-intervals::INFINITE, intervals::INFINITE};
    const double wide = rad * WIDER;
    return {outward::below(mid - wide), outward::above(mid + wide)};
}

/// A sum or difference; round-off of no other operation is so small.
void add(Row out, ConstRow a, ConstRow b, double sign, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
        const double mid = a.mid[i] + sign * b.mid[i];
        out.rad[i] = (a.rad[i] + b.rad[i]) + HALF_ULP * std::abs(mid);
        out.mid[i] = mid;
    }
}

void multiply(Row out, ConstRow a, ConstRow b, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
        const double mid = a.mid[i] * b.mid[i];
        const double size = std::abs(b.mid[i]) + b.rad[i];
        out.rad[i] = (std::abs(a.mid[i]) * b.rad[i] + a.rad[i] * size) +
                     (HALF_ULP * std::abs(mid) + UNDERFLOWN);
        out.mid[i] = mid;
    }
}

/// |a' / b' - a / b| <= (ra + |a / b| rb) / |b'|. Unknown where the divisor may be 0.
void divide(Row out, ConstRow a, ConstRow b, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
        const double mid = a.mid[i] / b.mid[i], least = std::abs(b.mid[i]) - b.rad[i];
        const double off = (a.rad[i] + std::abs(mid) * (b.rad[i] * (1.0 + 0x1p-50))) / least;
        out.rad[i] =
            least > 0.0 ? off + (HALF_ULP * std::abs(mid) + UNDERFLOWN) : intervals::INFINITE;
        out.mid[i] = mid;
    }
}

void reciprocal(Row out, ConstRow a, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
        const double mid = 1.0 / a.mid[i], least = std::abs(a.mid[i]) - a.rad[i];
        const double off = std::abs(mid) * a.rad[i] / least;
        out.rad[i] =
            least > 0.0 ? off + (HALF_ULP * std::abs(mid) + UNDERFLOWN) : intervals::INFINITE;
        out.mid[i] = mid;
    }
}

/// |a'^k - a^k| <= k ra (|a| + ra)^(k - 1), and an ulp for each factor.
void integer_power(Row out, ConstRow a, std::int32_t exponent, std::size_t n) {
    const double factors = exponent;
    std::fill_n(out.mid, n, 1.0);
    std::fill_n(out.rad, n, 1.0);  // of the power below
    for (std::int32_t k = 1; k < exponent; ++k)
        for (std::size_t i = 0; i < n; ++i) {
            out.mid[i] *= a.mid[i];
            out.rad[i] *= std::abs(a.mid[i]) + a.rad[i];
        }
    for (std::size_t i = 0; i < n; ++i) {
        out.mid[i] *= a.mid[i];
        out.rad[i] = factors * (a.rad[i] * out.rad[i]) +
                     factors * (2.0 * HALF_ULP * std::abs(out.mid[i]) + UNDERFLOWN);
    }
}

void negative(Row out, ConstRow a, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
        out.mid[i] = -a.mid[i];
        out.rad[i] = a.rad[i];
    }
}

/// |sqrt a' - sqrt a| <= ra / sqrt a.
void square_root(Row out, ConstRow a, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
        const double mid = std::sqrt(a.mid[i]);
        out.rad[i] = a.mid[i] > a.rad[i] ? a.rad[i] / mid + (HALF_ULP * mid + UNDERFLOWN)
                                         : intervals::INFINITE;
        out.mid[i] = mid;
    }
}

/// A sine or cosine, whose slope is at most 1, from computed middles.
void wave(Row out, ConstRow a, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
        const double off = a.rad[i] + (FUNCTION_ULPS * std::abs(out.mid[i]) + UNDERFLOWN);
        const bool known = off < 1.0;
        out.rad[i] = known ? off : 1.0;
        out.mid[i] = known ? out.mid[i] : 0.0;
    }
}

/// e^r - 1 <= r + r^2 for r <= 1.
void exponential(Row out, ConstRow a, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
        const double r = a.rad[i], mid = out.mid[i];
        const double off = mid * (r + r * r) * (1.0 + 2.0 * FUNCTION_ULPS);
        out.rad[i] = r <= 1.0 ? off + (FUNCTION_ULPS * mid + UNDERFLOWN) : intervals::INFINITE;
    }
}

void logarithm(Row out, ConstRow a, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
        const double least = a.mid[i] - a.rad[i];
        out.rad[i] = least > 0.0
                         ? a.rad[i] / least + (FUNCTION_ULPS * std::abs(out.mid[i]) + UNDERFLOWN)
                         : intervals::INFINITE;
    }
}

/// False: there is no rule for it. Results may be infinite where intervals know more.
bool run_by_rule(const Instruction& step, Row out, ConstRow a, ConstRow b, std::size_t n) {
    const std::span<const double> first{a.mid, n};
    const std::span<double> found{out.mid, n};
    switch (step.operation) {
        case Operation::ADD:
            return add(out, a, b, 1.0, n), true;
        case Operation::SUBTRACT:
            return add(out, a, b, -1.0, n), true;
        case Operation::MULTIPLY:
            return multiply(out, a, b, n), true;
        case Operation::DIVIDE:
            return divide(out, a, b, n), true;
        case Operation::NEGATIVE:
            return negative(out, a, n), true;
        case Operation::RECIPROCAL:
            return reciprocal(out, a, n), true;
        case Operation::INTEGER_POWER:
            if (step.exponent > MOST_FACTORS) return false;
            return integer_power(out, a, step.exponent, n), true;
        case Operation::SQRT:
            return square_root(out, a, n), true;
        case Operation::SIN:
            return elementary::sin(first, found), wave(out, a, n), true;
        case Operation::COS:
            return elementary::cos(first, found), wave(out, a, n), true;
        case Operation::EXP:
            return elementary::exp(first, found), exponential(out, a, n), true;
        case Operation::LOG:
            return elementary::log(first, found), logarithm(out, a, n), true;
        default:
            return false;
    }
}

/// Three operands and a result, for an instruction by itself.
Tape one_instruction() {
    Tape::Program program;
    program.inputs = 3;
    program.registers = 1;
    return Tape(std::move(program));
}

/// Blocks of points on their way through a tape.
class BallRun {
  public:
    BallRun(const Tape& tape, std::size_t lanes)
        : tape_(tape),
          lanes_(lanes),
          slots_(tape, lanes),
          ranges_(one_instruction(), lanes),
          angles_(tape.spares() * lanes) {
        auto constant = static_cast<std::int32_t>(tape.inputs());
        for (const double value : tape.constants())
            slots_.fill(constant++, lanes, ball_of(outward_constant(value)));
    }
    /// n points, as many as there are lanes at most.
    void run(std::span<const double> points, std::size_t n, std::span<Ball> out);

  private:
    void run(std::size_t instruction, std::size_t n);
    void run_by_intervals(const Instruction& step, Row found, std::size_t n);

    const Tape& tape_;
    std::size_t lanes_;
    BallSlots slots_;
    TapeSlots<Interval> ranges_;
    Array<double> angles_;  // sines and cosines of shared angles, until they are taken
};

/// A sine or cosine; other: what the other one of its angle is kept in.
void run_shared(const Instruction& step, bool is_second, Row out, ConstRow a,
                std::span<double> other) {
    const std::size_t n = other.size();
    const std::span<const double> angle{a.mid, n};
    const std::span<double> found{out.mid, n};
    if (is_second)
        std::copy_n(other.data(), n, out.mid);
    else if (step.operation == Operation::SIN)
        elementary::sincos(angle, found, other);
    else
        elementary::sincos(angle, other, found);
    wave(out, a, n);
}

/// Of these intervals know no more.
bool is_sum_or_product(Operation operation) {
    return operation == Operation::ADD || operation == Operation::SUBTRACT ||
           operation == Operation::MULTIPLY || operation == Operation::NEGATIVE;
}

bool are_known(const double* rad, std::size_t n) {
    std::uint64_t beyond = 0;
    for (std::size_t i = 0; i < n; ++i)
        beyond |= elementary::is_above(rad[i], std::numeric_limits<double>::max());
    return beyond >> 63 == 0;
}

/// Where nothing is known yet.
void BallRun::run_by_intervals(const Instruction& step, Row found, std::size_t n) {
    for (std::int32_t k = 0; k < 3; ++k) {
        const ConstRow operand = slots_[step.operands[static_cast<std::size_t>(k)]];
        for (std::size_t i = 0; i < n; ++i)
            ranges_[k][i] = interval_of(operand.mid[i], operand.rad[i]);
    }
    const Instruction alone{step.operation, 3, {0, 1, 2}, step.exponent};
    run_outward(alone, ranges_, n);
    for (std::size_t i = 0; i < n; ++i) {
        if (found.rad[i] < intervals::INFINITE) continue;
        const Ball ball = ball_of(ranges_[3][i]);
        found.mid[i] = ball.mid;
        found.rad[i] = ball.rad;
    }
}

void BallRun::run(std::size_t instruction, std::size_t n) {
    const Instruction& step = tape_.instructions()[instruction];
    const auto [spare, is_second] = tape_.shared_angles()[instruction];
    const auto [a, b, c] = step.operands;
    const Row found = slots_.spare();
    if (spare >= 0)
        run_shared(step, is_second, found, slots_[a],
                   {angles_.data() + static_cast<std::size_t>(spare) * lanes_, n});
    else if (!run_by_rule(step, found, slots_[a], slots_[b], n))
        std::fill_n(found.rad, n, intervals::INFINITE);
    if (!is_sum_or_product(step.operation) && !are_known(found.rad, n))
        run_by_intervals(step, found, n);
    slots_.take_spare(step.target);
}

void BallRun::run(std::span<const double> points, std::size_t n, std::span<Ball> out) {
    const std::size_t inputs = tape_.inputs(), outputs = tape_.outputs().size();
    for (std::size_t column = 0; column < inputs; ++column) {
        const Row input = slots_.target(static_cast<std::int32_t>(column));
        for (std::size_t i = 0; i < n; ++i) input.mid[i] = points[i * inputs + column];
        std::fill_n(input.rad, n, 0.0);
    }
    for (std::size_t k = 0; k < tape_.instructions().size(); ++k) run(k, n);
    for (std::size_t k = 0; k < outputs; ++k) {
        const ConstRow found = slots_[tape_.outputs()[k]];
        for (std::size_t i = 0; i < n; ++i) {
            const bool is_known = std::abs(found.mid[i]) + found.rad[i] < intervals::INFINITE;
            out[i * outputs + k] = is_known ? Ball{found.mid[i], found.rad[i] * WIDER}
                                            : Ball{0.0, intervals::INFINITE};
        }
    }
}

}  // namespace

void enclose_outputs(const Tape& tape, std::span<const double> points, std::span<Ball> out) {
    const std::size_t inputs = tape.inputs(), outputs = tape.outputs().size();
    const std::size_t count = inputs == 0 ? 0 : points.size() / inputs;
    if (count == 0) return;
    const std::size_t lanes = std::min(count, TAPE_BLOCK);
    BallRun block(tape, lanes);
    for (std::size_t start = 0; start < count; start += lanes) {
        const std::size_t n = std::min(lanes, count - start);
        block.run(points.subspan(start * inputs, n * inputs), n,
                  out.subspan(start * outputs, n * outputs));
    }
}

}  // namespace surfmesh
