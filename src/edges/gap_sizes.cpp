#include "edges/gap_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t SAMPLES_A_BLOCK = 1 << 14;

double size_across(double gap, double asked, const GapLaw& law) {
    const double ignored = std::max(law.ignored, law.ignored_of_size * asked);
    if (!std::isfinite(gap) || gap < ignored) return std::numeric_limits<double>::infinity();
    double narrow = std::min(law.longer * gap, law.narrowest);
    if (narrow < law.least_narrow) narrow = law.narrowest;
    return std::max(law.along * gap, std::max(narrow, law.least));
}

}  // namespace

Array<double> gap_sizes(const SampledEdges& sampled, std::span<const double> asked,
                        const GapLaw& law) {
    Array<double> sizes = edge_gaps(sampled).gap;
    for_each_block(sizes.size(), SAMPLES_A_BLOCK, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            sizes.data()[i] = size_across(sizes.data()[i], asked[i], law);
    });
    return sizes;
}

}  // namespace surfmesh
