// Doubles as 64 bits: choices without a branch, which compilers can make for several at a time.
#pragma once

#include <bit>
#include <cstdint>

namespace surfmesh::elementary {

inline constexpr std::uint64_t SIGN_BIT = 0x8000000000000000;
inline constexpr std::uint64_t EXPONENT_OF_ONE = 0x3ff;

inline std::uint64_t bits_of(double x) { return std::bit_cast<std::uint64_t>(x); }
inline double number_of(std::uint64_t bits) { return std::bit_cast<double>(bits); }
inline std::uint64_t bits_of_magnitude(double x) { return bits_of(x) & ~SIGN_BIT; }

/// Its first bit is set where |x| > limit, and where x is nan.
inline std::uint64_t is_above(double x, double limit) {
    return bits_of(limit) - bits_of_magnitude(x);
}

/// All bits set where the first bit of x is, else none.
inline std::uint64_t mask_of(std::uint64_t x) { return 0 - (x >> 63); }

/// a where the mask has all bits, b where it has none.
inline double choose(std::uint64_t mask, double a, double b) {
    return number_of((bits_of(a) & mask) | (bits_of(b) & ~mask));
}

/// x, or -x where the first bit of `sign` is set.
inline double with_sign_flipped(double x, std::uint64_t sign) {
    return number_of(bits_of(x) ^ (sign & SIGN_BIT));
}

}  // namespace surfmesh::elementary
