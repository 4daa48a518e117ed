#include "quality/sound_mesh.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "quality/triangle_fans.hpp"

namespace surfmesh {

bool are_proper(std::span<const TriangleCorners> triangles, std::size_t vertices) {
    Array<std::uint8_t> is_used(vertices, 0);
    for (const auto& [a, b, c] : triangles) {
        for (const Vertex v : {a, b, c})
            if (v < 0 || static_cast<std::size_t>(v) >= vertices) return false;
        if (a == b || b == c || c == a) return false;
        is_used[a] = is_used[b] = is_used[c] = 1;
    }
    return std::find(is_used.begin(), is_used.end(), 0) == is_used.end() &&
           !has_repeated_triangles(triangles, vertices);
}

bool are_finite(std::span<const double> values) {
    // an exponent of ones alone carries into the sign: no branch that depends on data
    constexpr std::uint64_t EXPONENT = 0x7FF0000000000000, ONE = 0x0010000000000000;
    std::uint64_t carried = 0;
    for (const double value : values)
        carried |= (std::bit_cast<std::uint64_t>(value) & EXPONENT) + ONE;
    return carried >> 63 == 0;
}

bool are_in_range(std::span<const std::int32_t> numbers, std::size_t count) {
    constexpr auto LARGEST = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
    if (count == 0) return numbers.empty();
    const auto last = static_cast<std::uint32_t>(std::min(count - 1, LARGEST));
    std::uint32_t signs = 0;  // several are looked at at once
    for (const std::int32_t number : numbers)
        signs |= static_cast<std::uint32_t>(number) | (last - static_cast<std::uint32_t>(number));
    return static_cast<std::int32_t>(signs) >= 0;
}

}  // namespace surfmesh
