// A function over a block of numbers: without a branch where the block allows, so that compilers
// can compute several at a time; that changes no result, as each number has the same operations.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace surfmesh::elementary {

inline constexpr std::size_t CHUNK = 256;  // numbers that are tested together for being ordinary

/// out[i] = f(x[i]), which is ordinary(x) unless the first bit of is_special(x) is set.
/// x and out have one length and may be the same.
template <class Ordinary, class IsSpecial, class Function>
void map_blocks(std::span<const double> x, std::span<double> out, Ordinary ordinary,
                IsSpecial is_special, Function f) {
    std::array<double, CHUNK> given;  // apart from `out`, so that the compiler knows it is
    for (std::size_t start = 0; start < x.size(); start += CHUNK) {
        const std::size_t count = std::min(CHUNK, x.size() - start);
        std::copy_n(x.data() + start, count, given.data());
        double* result = out.data() + start;
        std::uint64_t special = 0;
        for (std::size_t k = 0; k < count; ++k) special |= is_special(given[k]);
        if (special >> 63 == 0)
            for (std::size_t k = 0; k < count; ++k) result[k] = ordinary(given[k]);
        else
            for (std::size_t k = 0; k < count; ++k) result[k] = f(given[k]);
    }
}

/// out[i] = f(x[i]), one after the other. x and out have one length and may be the same.
inline void map_each(std::span<const double> x, std::span<double> out, double (*f)(double)) {
    for (std::size_t k = 0; k < x.size(); ++k) out[k] = f(x[k]);
}

}  // namespace surfmesh::elementary
