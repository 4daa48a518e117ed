// The largest of many values, or the least, without sorting or parting all of them.
//
// In: values. Out: their numbers, or a quantile. One pass: twice as many as are
// wanted are kept, at most, and what cannot be among them any more is passed over.
#pragma once

#include <cstdint>
#include <span>

#include "values/array.hpp"

namespace surfmesh {

/// Numbers of the ``count`` largest of some values, or of all where there are no more; of equal ones
/// those that come first. NaN is as large as infinity.
Array<std::int32_t> largest_values(std::span<const double> values, std::size_t count);

/// Numbers of the ``count`` least of some values, the least first; of equal ones those that come
/// first. What is no number is not among them.
Array<std::int32_t> least_values(std::span<const double> values, std::size_t count);

/// The quantile of n > 0 values, linear between two of them in their order; NaN where one is.
double quantile(std::span<const double> values, double fraction);

}  // namespace surfmesh
