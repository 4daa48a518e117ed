#include "surfaces/tape.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace surfmesh {
namespace {

using enum Operation;

constexpr OperationKind KINDS[] = {
    {ADD, "add", 2},
    {SUBTRACT, "subtract", 2},
    {MULTIPLY, "multiply", 2},
    {DIVIDE, "divide", 2},
    {NEGATIVE, "negative", 1},
    {RECIPROCAL, "reciprocal", 1},
    {INTEGER_POWER, "integer_power", 1},
    {POWER, "power", 2},
    {SQRT, "sqrt", 1},
    {CUBE_ROOT, "cube_root", 1},
    {EXP, "exp", 1},
    {LOG, "log", 1},
    {SIN, "sin", 1},
    {COS, "cos", 1},
    {TAN, "tan", 1},
    {ASIN, "asin", 1},
    {ACOS, "acos", 1},
    {ATAN, "atan", 1},
    {ANGLE, "angle", 2},
    {SINH, "sinh", 1},
    {COSH, "cosh", 1},
    {TANH, "tanh", 1},
    {ASINH, "asinh", 1},
    {ACOSH, "acosh", 1},
    {ATANH, "atanh", 1},
    {ERF, "erf", 1},
    {ABSOLUTE, "absolute", 1},
    {SIGNUM, "signum", 1},
    {UNIT_STEP, "unit_step", 1},
    {FLOOR, "floor", 1},
    {CHOSEN, "chosen", 3},
    {TURN, "turn", 2},
    {BESSEL_0, "bessel_0", 1},
    {BESSEL_1, "bessel_1", 1},
    {BESSEL_2, "bessel_2", 1},
    {STEP, "step", 1},
    {SIDE, "side", 1},
    {KINK, "kink", 1},
    {JUMP, "jump", 1},
    {TREAD, "tread", 1},
    {CUT, "cut", 2},
    {MINIMUM, "minimum", 2},
    {MAXIMUM, "maximum", 2},
};

int operands_of(Operation operation) { return KINDS[static_cast<std::size_t>(operation)].operands; }

/// The fault of one instruction, where `written` tells which slots may be read.
TapeFault fault_of(const Instruction& step, const Array<bool>& written, std::int32_t fixed) {
    const auto slots = static_cast<std::int32_t>(written.size());
    if (static_cast<std::size_t>(step.operation) >= std::size(KINDS))
        return TapeFault::READS_UNWRITTEN;
    for (int k = 0; k < operands_of(step.operation); ++k) {
        const std::int32_t operand = step.operands[static_cast<std::size_t>(k)];
        if (operand < 0 || operand >= slots || !written[operand]) return TapeFault::READS_UNWRITTEN;
    }
    if (step.target < fixed || step.target >= slots) return TapeFault::WRITES_OUTSIDE;
    if (step.operation == INTEGER_POWER) {
        if (step.target == step.operands[0]) return TapeFault::OVERWRITES_BASE;
        if (step.exponent < 2) return TapeFault::BAD_EXPONENT;
    }
    return TapeFault::NONE;
}

}  // namespace

std::span<const OperationKind> operation_kinds() { return KINDS; }

std::optional<Operation> operation_named(std::string_view name) {
    const auto* found = std::ranges::find(KINDS, name, &OperationKind::name);
    if (found == std::end(KINDS)) return std::nullopt;
    return found->operation;
}

TapeCheck Tape::check(const Program& program) {
    constexpr auto MOST = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
    if (program.inputs < 0 || program.registers < 0 ||
        static_cast<std::size_t>(program.inputs) + program.constants.size() +
                static_cast<std::size_t>(program.registers) >
            MOST)
        return {TapeFault::TOO_LARGE, -1};
    const auto fixed = program.inputs + static_cast<std::int32_t>(program.constants.size());
    Array<bool> written(static_cast<std::size_t>(fixed), true);
    written.resize(static_cast<std::size_t>(fixed + program.registers), false);
    std::int64_t number = 0;
    for (const Instruction& step : program.instructions) {
        const TapeFault fault = fault_of(step, written, fixed);
        if (fault != TapeFault::NONE) return {fault, number};
        written[step.target] = true;
        ++number;
    }
    for (const std::int32_t output : program.outputs)
        if (output < 0 || static_cast<std::size_t>(output) >= written.size() || !written[output])
            return {TapeFault::OUTPUT_UNWRITTEN, -1};
    return {TapeFault::NONE, -1};
}

Tape::Tape(Program program) {
    if (check(program).fault != TapeFault::NONE) return;
    program_ = std::move(program);
    for (Instruction& step : program_.instructions)  // what is not read is slot 0
        for (auto k = static_cast<std::size_t>(operands_of(step.operation)); k < 3; ++k)
            step.operands[k] = 0;
    find_shared_angles();
}

void Tape::find_shared_angles() {
    shared_.resize(program_.instructions.size());
    const std::size_t slots = inputs() + program_.constants.size() + registers();
    Array<std::int32_t> first(slots, -1);  // of each slot: the instruction that takes its sine or
                                           // cosine, while the slot holds the same and it is alone
    std::int32_t number = 0;
    for (const Instruction& step : program_.instructions) {
        if (step.operation == SIN || step.operation == COS) {
            std::int32_t& before = first[step.operands[0]];
            if (before >= 0 && program_.instructions[before].operation != step.operation) {
                shared_[before] = {spares_, false};
                shared_[number] = {spares_++, true};
                before = -1;
            } else {
                before = number;
            }
        }
        first[step.target] = -1;
        ++number;
    }
}

}  // namespace surfmesh
