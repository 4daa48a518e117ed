// Sums of many numbers, in the order in which numpy has them: halves of halves, and eight running
// sums for what is left, so that rounding errors grow with the logarithm of the number alone.
//
// Source: N.J. Higham, The accuracy of floating point summation, SIAM J. Sci. Comput. 14, 1993.
#pragma once

#include <cstddef>
#include <span>

namespace surfmesh {

inline double pairwise_sum(std::span<const double> x) {
    constexpr std::size_t LANES = 8, BLOCK = 128;
    if (x.size() < LANES) {
        double sum = 0.0;
        for (const double value : x) sum += value;
        return sum;
    }
    if (x.size() > BLOCK) {
        const std::size_t half = x.size() / 2 - x.size() / 2 % LANES;
        return pairwise_sum(x.first(half)) + pairwise_sum(x.subspan(half));
    }
    double r[LANES];
    for (std::size_t k = 0; k < LANES; ++k) r[k] = x[k];
    std::size_t i = LANES;
    for (; i < x.size() - x.size() % LANES; i += LANES)
        for (std::size_t k = 0; k < LANES; ++k) r[k] += x[i + k];
    double sum = ((r[0] + r[1]) + (r[2] + r[3])) + ((r[4] + r[5]) + (r[6] + r[7]));
    for (; i < x.size(); ++i) sum += x[i];
    return sum;
}

inline double mean(std::span<const double> x) {
    return pairwise_sum(x) / static_cast<double>(x.size());
}

}  // namespace surfmesh
