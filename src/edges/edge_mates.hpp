// Edges that run side by side: where they do, and the sizes that they pass to each other.
//
//     a  o-------o-------o------o      a run: a part of one edge, at its samples, with their feet
//        :       :       :      :      on another edge and the gaps between
//     b  o-------o-------o------o
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "edges/edge_chains.hpp"

namespace surfmesh {

/// Parts of edges and their feet on other ones.
struct MateRuns {
    Array<std::int64_t> edge, mate, first;  // samples of run i: first[i] to first[i + 1]
    Array<double> t, foot, gap;             // of the samples: places on both edges, distances

    [[nodiscard]] std::size_t size() const { return edge.size(); }
    /// The part of a row over all samples that is of one run.
    [[nodiscard]] std::span<const double> of(const Array<double>& row, std::size_t run) const {
        const auto start = static_cast<std::size_t>(first.data()[run]);
        return {row.data() + start, static_cast<std::size_t>(first.data()[run + 1]) - start};
    }
};

/// Chains of edges, and which of them are to be looked at beside which.
struct SideBySide {
    std::span<const DirectedEdge> uses;        // of all chains, one chain after the other
    std::span<const std::int64_t> first;       // where those of each chain begin
    std::span<const std::int64_t> own, other;  // pairs of chains
    std::span<const double> width;             // of the pairs: they are mates up to this distance
    std::size_t fewest;                        // samples of a run
};

/// The runs of one chain of each pair along the other.
MateRuns mate_runs(const SampledCurves& edges, const SideBySide& pairs);

/// Sizes at samples of edges, lowered to those of their mates, run after run.
Array<double> lowered_to_mates(const SampleRows& samples, const MateRuns& runs,
                               std::span<const double> sizes);

}  // namespace surfmesh
