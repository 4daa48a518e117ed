#include "optimisation/marked_triangles.hpp"

#include <algorithm>

#include "values/threads.hpp"

namespace surfmesh {
namespace {

constexpr std::size_t MARKED_TOGETHER = 1 << 14;  // triangles looked at together
constexpr std::size_t FEW_PART = 64;  // up to one vertex of so many: their stars are quicker

/// Is triangle abc turned against the normals at its corners?
bool is_folded(const SurfaceFrames& s, Vertex a, Vertex b, Vertex c, double least, double at_apex) {
    const Point3 n = cross(s.point[b] - s.point[a], s.point[c] - s.point[a]);
    const double area = norm(n);
    double worst = area;
    bool regular = true;
    for (const Vertex v : {a, b, c}) {
        if (is_zero(s.normal[v]))
            regular = false;
        else
            worst = std::min(worst, dot(n, s.normal[v]));
    }
    return worst < (regular ? least : at_apex) * area;
}

/// The triangles at marked vertices if these are few, and two borders meet at none of them.
std::optional<Array<Triangle>> triangles_at_few(const Triangulation& t, const Stars& stars,
                                                const Array<std::uint8_t>& vertices) {
    const auto count = std::count(vertices.begin(), vertices.end(), std::uint8_t{1});
    if (static_cast<std::size_t>(count) > vertices.size() / FEW_PART) return {};
    Array<Vertex> marked;
    const auto end = static_cast<Vertex>(vertices.size());
    for (Vertex v = next_marked(vertices, 0, end); v < end; v = next_marked(vertices, v + 1, end))
        marked.push_back(v);
    return triangles_around(t, stars, marked);
}

}  // namespace

Array<std::uint8_t> find_folded(const Triangulation& t, const SurfaceFrames& s, double least,
                                double at_apex) {
    auto folded = Array<std::uint8_t>::unfilled(t.region.size());
    for_each_block(t.region.size(), MARKED_TOGETHER, [&](std::size_t first, std::size_t last) {
        for (auto k = static_cast<Triangle>(first); k < static_cast<Triangle>(last); ++k) {
            const Vertex a = t.tri[3 * k], b = t.tri[3 * k + 1], c = t.tri[3 * k + 2];
            folded[k] = t.region[k] != DEAD && !is_collapsed(s, a, b, c) &&
                        is_folded(s, a, b, c, least, at_apex);
        }
    });
    return folded;
}

Array<Triangle> triangles_at(const Triangulation& t, const Stars* stars,
                             const Array<std::uint8_t>& vertices) {
    if (stars != nullptr)
        if (std::optional<Array<Triangle>> found = triangles_at_few(t, *stars, vertices))
            return *std::move(found);
    return collect_by_blocks<Triangle>(
        t.region.size(), MARKED_TOGETHER,
        [&](std::size_t first, std::size_t last, Array<Triangle>& found) {
            for (auto k = static_cast<Triangle>(first); k < static_cast<Triangle>(last); ++k) {
                if (t.region[k] == DEAD) continue;
                if (vertices[t.tri[3 * k]] || vertices[t.tri[3 * k + 1]] ||
                    vertices[t.tri[3 * k + 2]])
                    found.push_back(k);
            }
        });
}

Array<Triangle> triangles_below(const Triangulation& t, const SurfaceFrames& s, double least) {
    return collect_by_blocks<Triangle>(
        t.region.size(), MARKED_TOGETHER,
        [&](std::size_t first, std::size_t last, Array<Triangle>& found) {
            for (auto k = static_cast<Triangle>(first); k < static_cast<Triangle>(last); ++k)
                if (t.region[k] != DEAD &&
                    is_shape_below(s, t.tri[3 * k], t.tri[3 * k + 1], t.tri[3 * k + 2], least))
                    found.push_back(k);
        });
}

Array<Triangle> triangles_below(const Triangulation& t, const Array<double>& shape, double least) {
    return collect_by_blocks<Triangle>(
        t.region.size(), MARKED_TOGETHER,
        [&](std::size_t first, std::size_t last, Array<Triangle>& found) {
            for (auto k = static_cast<Triangle>(first); k < static_cast<Triangle>(last); ++k)
                if (shape[k] < least && t.region[k] != DEAD) found.push_back(k);
        });
}

int activate_bad(const Triangulation& t, const SurfaceFrames& s, std::span<const double> shape,
                 VertexMarks& marks, double least) {
    const auto is_bad = [&](std::size_t k, Vertex a, Vertex b, Vertex c) {
        if (k < shape.size() && !marks.dirty[a] && !marks.dirty[b] && !marks.dirty[c])
            return shape[k] < least;
        return is_shape_below(s, a, b, c, least);
    };
    const Array<Triangle> bad = collect_by_blocks<Triangle>(
        t.region.size(), MARKED_TOGETHER,
        [&](std::size_t first, std::size_t last, Array<Triangle>& found) {
            for (std::size_t k = first; k < last; ++k) {
                if (t.region[k] == DEAD) continue;
                const Vertex a = t.tri[3 * k], b = t.tri[3 * k + 1], c = t.tri[3 * k + 2];
                if (is_bad(k, a, b, c) && !is_collapsed(s, a, b, c))
                    found.push_back(static_cast<Triangle>(k));
            }
        });
    for (const Triangle k : bad)
        for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e) marks.active[t.tri[e]] = 1;
    return static_cast<int>(bad.size());
}

}  // namespace surfmesh
