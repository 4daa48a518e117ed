// Least, mean and largest of many values, and how far they lie from the mean.
//
// In: values. Out: four numbers, NaN where a value is or where there is none. Sums are of blocks, in
// lanes side by side: quicker than one after the other, and less is lost to rounding.
#pragma once

#include <span>

namespace surfmesh {

struct Spread {
    double least, mean, largest;
    double deviation;  // root of the mean square distance from the mean
};

Spread spread_of(std::span<const double> values);

}  // namespace surfmesh
