// Counts of values in bins of one width.
//
// In: values, where the first bin begins and the last one ends. Out: how many are in each; what lies
// outside is in the bins at the ends, what is not finite in none.
#pragma once

#include <cstdint>
#include <span>

#include "values/array.hpp"

namespace surfmesh {

Array<std::int64_t> binned_counts(std::span<const double> values, double low, double high,
                                  std::size_t bins);

}  // namespace surfmesh
