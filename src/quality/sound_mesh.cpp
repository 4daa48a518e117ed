#include "quality/sound_mesh.hpp"

#include <algorithm>
#include <bit>

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
    std::size_t most = 0;
    for (const std::int32_t number : numbers)  // negative ones are larger than any
        most = std::max<std::size_t>(most, static_cast<std::uint32_t>(number));
    return numbers.empty() || most < count;
}

}  // namespace surfmesh
