#include "surfaces/tape_taylor.hpp"

#include <algorithm>
#include <cmath>

#include "surfaces/tape_bounds.hpp"
#include "surfaces/taylor_coefficients.hpp"

namespace surfmesh {
namespace {

using taylor::Coefficients;
using taylor::Variables;

constexpr std::size_t LANES = 32;        // cells at a time: their series stay in the cache
constexpr double WIDER = 1.0 + 0x1p-30;  // of a hundred operations for each of many instructions

using OperandVariables = std::array<Variables, 3>;

/// What the operands of each instruction depend on: registers hold one number after the other.
Array<OperandVariables> variables_of(const Tape& tape) {
    Array<Variables> of_slot(2 + tape.constants().size() + tape.registers(), Variables::NONE);
    of_slot[0] = Variables::U;
    of_slot[1] = Variables::V;
    const auto both = [](Variables a, Variables b) {
        if (a == Variables::NONE || a == b) return b;
        return b == Variables::NONE ? a : Variables::BOTH;
    };
    Array<OperandVariables> found;
    for (const Instruction& step : tape.instructions()) {
        const auto [a, b, c] = step.operands;
        found.push_back({of_slot[a], of_slot[b], of_slot[c]});
        Variables all = Variables::NONE;
        const int count = operation_kinds()[static_cast<std::size_t>(step.operation)].operands;
        for (int k = 0; k < count; ++k)
            all = both(all, of_slot[step.operands[static_cast<std::size_t>(k)]]);
        of_slot[step.target] = all;
    }
    return found;
}

void run(const Instruction& step, const OperandVariables& of, const TapeSlots<Interval>& ranges,
         const TapeSlots<Coefficients>& series, std::size_t n) {
    std::array<Coefficients, LANES> found;
    const auto [a, b, c] = step.operands;
    for (std::size_t i = 0; i < n; ++i)
        found[i] = taylor::of(step, {{{ranges[a][i], series[a][i], of[0]},
                                      {ranges[b][i], series[b][i], of[1]},
                                      {ranges[c][i], series[c][i], of[2]}}});
    run_outward(step, ranges, n);  // which may write what was read
    std::copy_n(found.begin(), n, series[step.target]);
}

DerivativeBalls unknown() {
    DerivativeBalls found{};
    found.rad.fill(intervals::INFINITE);
    return found;
}

/// Taylor coefficients times their factorials.
DerivativeBalls derivatives_of(const Coefficients& series) {
    constexpr std::array<double, 12> FACTORIALS = {2.0, 1.0,  2.0, 6.0, 2.0, 2.0,
                                                   6.0, 24.0, 6.0, 4.0, 6.0, 24.0};
    constexpr std::size_t SECOND = 2;  // after those of the first order
    DerivativeBalls found = unknown();
    for (std::size_t k = 0; k < FACTORIALS.size(); ++k) {
        const double mid = series.mid[SECOND + k] * FACTORIALS[k];
        const double rad =
            series.rad[SECOND + k] * (FACTORIALS[k] * WIDER) + 0x1p-52 * std::abs(mid);
        if (!(std::abs(mid) + rad < intervals::INFINITE)) continue;
        found.mid[k] = mid;
        found.rad[k] = rad;
    }
    return found;
}

}  // namespace

void high_derivatives(const Tape& tape, std::span<const double> lo, std::span<const double> hi,
                      std::span<DerivativeBalls> out) {
    const std::size_t outputs = tape.outputs().size();
    std::fill(out.begin(), out.end(), unknown());
    if (tape.inputs() != 2 || lo.empty()) return;
    const std::size_t count = lo.size() / 2, lanes = std::min(count, LANES);
    const Array<OperandVariables> of = variables_of(tape);
    const TapeSlots<Interval> ranges(tape, lanes);
    const TapeSlots<Coefficients> series(tape, lanes);
    for (std::size_t k = 0; k < tape.constants().size(); ++k) {
        const auto slot = static_cast<std::int32_t>(2 + k);
        std::fill_n(ranges[slot], lanes, outward_constant(tape.constants()[k]));
        std::fill_n(series[slot], lanes, Coefficients{});
    }
    for (std::int32_t input = 0; input < 2; ++input) {
        Coefficients itself{};
        itself.mid[static_cast<std::size_t>(input)] = 1.0;
        std::fill_n(series[input], lanes, itself);
    }
    for (std::size_t start = 0; start < count; start += lanes) {
        const std::size_t n = std::min(lanes, count - start);
        for (std::size_t i = 0; i < 2 * n; ++i)
            ranges[static_cast<std::int32_t>(i % 2)][i / 2] = {lo[2 * start + i],
                                                               hi[2 * start + i]};
        for (std::size_t k = 0; k < tape.instructions().size(); ++k)
            run(tape.instructions()[k], of[static_cast<std::ptrdiff_t>(k)], ranges, series, n);
        for (std::size_t k = 0; k < outputs; ++k)
            for (std::size_t i = 0; i < n; ++i)
                out[(start + i) * outputs + k] = derivatives_of(series[tape.outputs()[k]][i]);
    }
}

}  // namespace surfmesh
