#include "proof/plane_groups.hpp"

#include <algorithm>
#include <cmath>

namespace surfmesh {

Array<PlacedTriangle> placed_triangles(std::span<const PlaneCorners> uv) {
    auto members = Array<PlacedTriangle>::unfilled(uv.size());
    for (std::size_t t = 0; t < uv.size(); ++t)
        members.begin()[t] = {uv[t][0] + uv[t][1] + uv[t][2], static_cast<std::int32_t>(t)};
    return members;
}

std::array<TriangleGroup, 2> halves_of(TriangleGroup group, std::span<const PlaneCorners> uv) {
    Point2 low = group[0].middle, high = low;
    for (const PlacedTriangle& member : group) {
        const Point2 p = member.middle;
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    // sides in (u, v) are compared as the triangles lie in space
    double along_u = 0.0, along_v = 0.0;
    const PlaneCorners& first = uv[static_cast<std::size_t>(group[0].triangle)];
    for (const Point2 p : first) {
        along_u = std::max(along_u, std::abs(p.x - first[0].x));
        along_v = std::max(along_v, std::abs(p.y - first[0].y));
    }
    const auto half = static_cast<std::ptrdiff_t>(group.size() / 2);
    const auto cut_by = [&](auto place) {
        std::nth_element(group.begin(), group.begin() + half, group.end(),
                         [place](const PlacedTriangle& a, const PlacedTriangle& b) {
                             const double x = place(a), y = place(b);
                             return x < y || (x == y && a.triangle < b.triangle);
                         });
    };
    if ((high.x - low.x) * along_v >= (high.y - low.y) * along_u)
        cut_by([](const PlacedTriangle& member) { return member.middle.x; });
    else
        cut_by([](const PlacedTriangle& member) { return member.middle.y; });
    const auto middle = static_cast<std::size_t>(half);
    return {group.first(middle), group.subspan(middle)};
}

}  // namespace surfmesh
