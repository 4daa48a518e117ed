#include "elementary_functions/exponential.hpp"

#include "elementary_functions/blocks.hpp"

namespace surfmesh::elementary {

void exp(std::span<const double> x, std::span<double> out) {
    map_blocks(
        x, out, exp_ordinary, [](double a) { return is_above(a, ORDINARY_EXPONENT); },
        [](double a) { return exp(a); });
}

}  // namespace surfmesh::elementary
