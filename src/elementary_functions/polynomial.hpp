// A polynomial by Horner's rule.
#pragma once

#include <cstddef>

namespace surfmesh::elementary {

/// coefficients[0] + coefficients[1] x + ...
template <std::size_t count>
inline double polynomial(const double (&coefficients)[count], double x) {
    double sum = coefficients[count - 1];
    for (std::size_t k = count - 1; k-- > 0;) sum = sum * x + coefficients[k];
    return sum;
}

}  // namespace surfmesh::elementary
