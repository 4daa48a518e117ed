#include "quality/spread.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace surfmesh {
namespace {

constexpr std::size_t LANES = 8, SUMMED_BLOCK = 512;
constexpr double UNKNOWN = std::numeric_limits<double>::quiet_NaN();

/// The sum of term(value) over all values.
template <class Term>
double sum_of(std::span<const double> values, const Term& term) {
    double sum = 0.0;
    for (std::size_t k = 0; k < values.size(); k += SUMMED_BLOCK) {
        const auto block = values.subspan(k, std::min(SUMMED_BLOCK, values.size() - k));
        std::array<double, LANES> lanes{};
        const std::size_t even = block.size() - block.size() % LANES;
        for (std::size_t i = 0; i < even; i += LANES)
            for (std::size_t j = 0; j < LANES; ++j) lanes[j] += term(block[i + j]);
        for (std::size_t i = even; i < block.size(); ++i) lanes[i - even] += term(block[i]);
        sum += ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) +
               ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]));
    }
    return sum;
}

}  // namespace

Spread spread_of(std::span<const double> values) {
    if (values.empty()) return {UNKNOWN, UNKNOWN, UNKNOWN, UNKNOWN};
    const auto count = static_cast<double>(values.size());
    const double mean = sum_of(values, [](double x) { return x; }) / count;
    if (mean != mean && std::any_of(values.begin(), values.end(), [](double x) { return x != x; }))
        return {UNKNOWN, UNKNOWN, UNKNOWN, UNKNOWN};
    double least = values[0], largest = values[0];
    for (const double x : values) {
        least = x < least ? x : least;
        largest = x > largest ? x : largest;
    }
    const double square = sum_of(values, [mean](double x) { return (x - mean) * (x - mean); });
    return {least, mean, largest, std::sqrt(square / count)};
}

}  // namespace surfmesh
