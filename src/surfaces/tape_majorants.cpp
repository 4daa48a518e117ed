#include "surfaces/tape_majorants.hpp"

#include <algorithm>

#include "surfaces/majorant.hpp"
#include "surfaces/tape_bounds.hpp"

namespace surfmesh {
namespace {

using majorants::Majorant;
using majorants::Sizes;

constexpr std::size_t LANES = 32;        // cells at a time: their sizes stay in the cache
constexpr double WIDER = 1.0 + 0x1p-30;  // of a hundred operations for each of many instructions

void run(const Instruction& step, const TapeSlots<Interval>& ranges, const TapeSlots<Sizes>& sizes,
         std::size_t n) {
    std::array<Sizes, LANES> found;
    for (std::size_t i = 0; i < n; ++i) {
        std::array<Majorant, 3> operands;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t slot = step.operands[k];
            operands[k] = {ranges[slot][i], sizes[slot][i]};
        }
        found[i] = majorants::of(step, operands);
    }
    run_outward(step, ranges, n);  // which may write what was read
    std::copy_n(found.begin(), n, sizes[step.target]);
}

/// Taylor coefficients times their factorials.
std::array<double, 5> derivatives_of(const Sizes& sizes) {
    constexpr std::array<double, 5> FACTORIALS = {24.0, 6.0, 4.0, 6.0, 24.0};
    std::array<double, 5> found{};
    for (std::size_t k = 0; k < 5; ++k) {
        const double size = sizes[9 + k] * (FACTORIALS[k] * WIDER);
        found[k] = size < intervals::INFINITE ? size : intervals::INFINITE;
    }
    return found;
}

}  // namespace

void fourth_derivatives(const Tape& tape, std::span<const double> lo, std::span<const double> hi,
                        std::span<std::array<double, 5>> out) {
    const std::size_t outputs = tape.outputs().size();
    constexpr double NONE = intervals::INFINITE;
    std::fill(out.begin(), out.end(), std::array<double, 5>{NONE, NONE, NONE, NONE, NONE});
    if (tape.inputs() != 2 || lo.empty()) return;
    const std::size_t count = lo.size() / 2, lanes = std::min(count, LANES);
    const TapeSlots<Interval> ranges(tape, lanes);
    const TapeSlots<Sizes> sizes(tape, lanes);
    for (std::size_t k = 0; k < tape.constants().size(); ++k) {
        const auto slot = static_cast<std::int32_t>(2 + k);
        std::fill_n(ranges[slot], lanes, outward_constant(tape.constants()[k]));
        std::fill_n(sizes[slot], lanes, Sizes{});
    }
    for (std::int32_t input = 0; input < 2; ++input) {
        Sizes itself{};
        itself[static_cast<std::size_t>(input)] = 1.0;
        std::fill_n(sizes[input], lanes, itself);
    }
    for (std::size_t start = 0; start < count; start += lanes) {
        const std::size_t n = std::min(lanes, count - start);
        for (std::size_t i = 0; i < 2 * n; ++i)
            ranges[static_cast<std::int32_t>(i % 2)][i / 2] = {lo[2 * start + i],
                                                               hi[2 * start + i]};
        for (const Instruction& step : tape.instructions()) run(step, ranges, sizes, n);
        for (std::size_t k = 0; k < outputs; ++k)
            for (std::size_t i = 0; i < n; ++i)
                out[(start + i) * outputs + k] = derivatives_of(sizes[tape.outputs()[k]][i]);
    }
}

}  // namespace surfmesh
