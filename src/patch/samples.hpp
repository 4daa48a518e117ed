// Barycentric places at which triangles are looked at.
#pragma once

#include <algorithm>
#include <array>

namespace surfmesh {

using BarycentricWeights = std::array<double, 3>;

inline constexpr BarycentricWeights CENTROID = {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};

/// The middles of the sides 0, 1 and 2, and the centroid.
inline constexpr std::array<BarycentricWeights, 4> FEW_SAMPLES = {
    {{0.5, 0.5, 0.0}, {0.0, 0.5, 0.5}, {0.5, 0.0, 0.5}, CENTROID}};

inline constexpr int DENSE_GRID = 6;

/// The sides in six, without the corners. Between the samples of a coarser grid were 3 % more in
/// triangles across a direction that turns.
inline constexpr auto DENSE_SAMPLES = [] {
    std::array<BarycentricWeights, (DENSE_GRID + 1) * (DENSE_GRID + 2) / 2 - 3> samples{};
    std::size_t count = 0;
    for (int i = 0; i <= DENSE_GRID; ++i)
        for (int j = 0; j <= DENSE_GRID - i; ++j) {
            const int k = DENSE_GRID - i - j;
            if (i == DENSE_GRID || j == DENSE_GRID || k == DENSE_GRID) continue;
            samples[count++] = {double(i) / DENSE_GRID, double(j) / DENSE_GRID,
                                double(k) / DENSE_GRID};
        }
    return samples;
}();

/// The dense samples that are not among the few.
inline constexpr auto OTHER_SAMPLES = [] {
    std::array<BarycentricWeights, DENSE_SAMPLES.size() - FEW_SAMPLES.size()> samples{};
    std::size_t count = 0;
    for (const BarycentricWeights& w : DENSE_SAMPLES)
        if (std::find(FEW_SAMPLES.begin(), FEW_SAMPLES.end(), w) == FEW_SAMPLES.end())
            samples[count++] = w;
    return samples;
}();

/// The value at a barycentric place of a triangle with these values at its corners.
template <class Point>
constexpr Point at_weights(const std::array<Point, 3>& corners, const BarycentricWeights& w) {
    return w[0] * corners[0] + w[1] * corners[1] + w[2] * corners[2];
}

}  // namespace surfmesh
