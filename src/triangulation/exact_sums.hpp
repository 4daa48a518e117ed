// The sign of a sum of numbers of any size, exactly: what predicates fall back on.
//
// A number here is a double times a power of two whose exponent is an integer of its own, so that
// no product of coordinates under- or overflows.
#pragma once

#include <span>

namespace surfmesh {

struct ScaledNumber {
    double mantissa;
    int exponent;
};

/// About the sum of mantissa 2**exponent over at most 255 finite terms; its sign is exact, and it
/// is finite.
double exact_sum(std::span<const ScaledNumber> terms);

}  // namespace surfmesh
