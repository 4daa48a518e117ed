#include "quality/corner_places.hpp"

#include <algorithm>
#include <utility>

#include "values/conventions.hpp"

namespace surfmesh {
namespace {

struct Corner {
    Vertex vertex;
    std::int32_t place;
};

bool comes_before(const Corner& a, const Corner& b) {
    return std::pair(a.vertex, a.place) < std::pair(b.vertex, b.place);
}
bool are_one(const Corner& a, const Corner& b) {
    return a.vertex == b.vertex && a.place == b.place;
}

}  // namespace

Array<std::int32_t> corner_places(std::span<const TriangleCorners> triangles,
                                  std::span<const TriangleCorners> uv_triangles,
                                  std::size_t vertices, std::size_t places) {
    Array<std::int32_t> count(vertices, 0);
    Array<Vertex> vertex_of(places, NIL);  // the first: as a rule a place belongs to one
    Array<Corner> others;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const TriangleCorners &k = triangles[t], &q = uv_triangles[t];
        for (const Corner corner : {Corner{k.a, q.a}, Corner{k.b, q.b}, Corner{k.c, q.c}}) {
            Vertex& first = vertex_of[corner.place];
            if (first == NIL) {
                first = corner.vertex;
                ++count[first];
            } else if (first != corner.vertex) {
                others.push_back(corner);
            }
        }
    }
    std::sort(others.begin(), others.end(), comes_before);
    const Corner* const end = std::unique(others.begin(), others.end(), are_one);
    for (const Corner* other = others.begin(); other != end; ++other) ++count[other->vertex];
    return count;
}

}  // namespace surfmesh
