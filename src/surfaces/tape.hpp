// A tape: a straight-line program of elementary operations, for points and for intervals.
//
//         slots:  | u | v | constants ... | registers ... |
//         sine:   slots[target] = sin(slots[a])
//
// Every instruction writes one register and reads slots. A tape is checked when it is made and
// never changes: running it reads nothing that was not written and leaves its slots in no case.
// Points run in tape_evaluation.hpp, with all round-off in tape_balls.hpp, cells of the (u, v) plane in
// tape_bounds.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "values/array.hpp"

namespace surfmesh {

enum class Operation : std::uint8_t {
    ADD,
    SUBTRACT,
    MULTIPLY,
    DIVIDE,
    NEGATIVE,
    RECIPROCAL,
    INTEGER_POWER,
    POWER,
    SQRT,
    CUBE_ROOT,
    EXP,
    LOG,
    SIN,
    COS,
    TAN,
    ASIN,
    ACOS,
    ATAN,
    ANGLE,
    SINH,
    COSH,
    TANH,
    ASINH,
    ACOSH,
    ATANH,
    ERF,
    ABSOLUTE,
    SIGNUM,
    UNIT_STEP,
    FLOOR,
    CHOSEN,
    TURN,
    BESSEL_0,
    BESSEL_1,
    BESSEL_2,
    // slopes, and what they hold where they break off
    STEP,
    SIDE,
    KINK,
    JUMP,
    TREAD,
    CUT,
    MINIMUM,
    MAXIMUM,
};

/// An operation's name in Python, and how many slots it reads.
struct OperationKind {
    Operation operation;
    std::string_view name;
    int operands;
};

/// All operations in the order of their numbers.
std::span<const OperationKind> operation_kinds();

/// The operation of a name, or nothing.
std::optional<Operation> operation_named(std::string_view name);

/// slots[target] = operation(slots[operands] ...); exponent: of INTEGER_POWER alone, at least 2.
struct Instruction {
    Operation operation;
    std::int32_t target;
    std::array<std::int32_t, 3> operands;
    std::int32_t exponent;
};

/// A sine or cosine whose angle another instruction has too: they are computed at once by the first,
/// which keeps the other's numbers in a spare register until that one takes them.
struct SharedAngle {
    std::int32_t spare = -1;  // number of the spare register; -1: the angle is not shared
    bool is_second = false;
};

/// The first broken invariant of a program, with the number of its instruction.
enum class TapeFault {
    NONE,
    TOO_LARGE,         // its slots have no 31-bit numbers
    READS_UNWRITTEN,   // reads a slot that is none, or a register before it is written
    WRITES_OUTSIDE,    // writes what is no register
    OVERWRITES_BASE,   // a power writes the register that it reads
    BAD_EXPONENT,      // below 2
    OUTPUT_UNWRITTEN,  // an output is no slot, or never written
};
struct [[nodiscard]] TapeCheck {
    TapeFault fault;
    std::int64_t instruction;
};

class Tape {
  public:
    /// Slots are numbered inputs first, then constants, then registers. Outputs are slots.
    struct Program {
        std::int32_t inputs = 0;
        Array<double> constants;
        Array<Instruction> instructions;
        std::int32_t registers = 0;
        Array<std::int32_t> outputs;
    };

    static TapeCheck check(const Program& program);

    /// Of a program that the check has found right; of another one an empty tape.
    explicit Tape(Program program);

    [[nodiscard]] std::size_t inputs() const { return static_cast<std::size_t>(program_.inputs); }
    [[nodiscard]] std::size_t registers() const {
        return static_cast<std::size_t>(program_.registers);
    }
    [[nodiscard]] std::span<const double> constants() const { return span(program_.constants); }
    [[nodiscard]] std::span<const Instruction> instructions() const {
        return span(program_.instructions);
    }
    [[nodiscard]] std::span<const std::int32_t> outputs() const { return span(program_.outputs); }
    /// Of each instruction.
    [[nodiscard]] std::span<const SharedAngle> shared_angles() const { return span(shared_); }
    [[nodiscard]] std::size_t spares() const { return static_cast<std::size_t>(spares_); }

  private:
    void find_shared_angles();

    template <class T>
    static std::span<const T> span(const Array<T>& array) {
        return array;
    }

    Program program_;
    Array<SharedAngle> shared_;
    std::int32_t spares_ = 0;
};

/// The slots of a tape for a block of points or cells: `lanes` numbers each, in one piece.
template <class Number>
class TapeSlots {
  public:
    TapeSlots(const Tape& tape, std::size_t lanes)
        : lanes_(lanes),
          memory_((tape.inputs() + tape.constants().size() + tape.registers()) * lanes) {}

    [[nodiscard]] Number* operator[](std::int32_t slot) const {
        return memory_.data() + static_cast<std::size_t>(slot) * lanes_;
    }

  private:
    std::size_t lanes_;
    Array<Number> memory_;
};

}  // namespace surfmesh
