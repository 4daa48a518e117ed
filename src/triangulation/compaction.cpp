#include "triangulation/compaction.hpp"

#include <algorithm>
#include <atomic>

#include "triangulation/space_filling_order.hpp"
#include "values/first_touch.hpp"

namespace surfmesh {
namespace {

/// From so many triangles on a domain is numbered along a space-filling curve and cut into parts:
/// it does not fit into the memory near a processor, and is worth a second one.
constexpr Triangle LARGE_TRIANGULATION = 50'000;
constexpr std::size_t VERTICES_OF_PART = 32'768;  // about
constexpr std::size_t COPIED_TOGETHER = 1 << 15;  // vertices or triangles copied together
constexpr std::size_t ROOM = 16;                  // there is room for this part more, as for splits

/// The vertices that triangles inside use, in the order they will have.
Array<Vertex> vertices_inside(const Triangulation& t, Triangle triangles) {
    auto used = filled_by_threads<std::uint8_t>(t.xy.size(), 0);
    for_each_block(t.region.size(), COPIED_TOGETHER, [&](std::size_t start, std::size_t end) {
        for (auto k = static_cast<Triangle>(start); k < static_cast<Triangle>(end); ++k) {
            if (t.region[k] != INSIDE) continue;
            for (HalfEdge e = 3 * k; e < 3 * k + 3; ++e)  // by several threads at once
                std::atomic_ref(used[t.tri[e]]).store(1, std::memory_order_relaxed);
        }
    });
    const Array<Vertex> inside = collect_by_blocks<Vertex>(
        t.xy.size(), COPIED_TOGETHER,
        [&](std::size_t start, std::size_t end, Array<Vertex>& found) {
            for (auto v = static_cast<Vertex>(start); v < static_cast<Vertex>(end); ++v)
                if (used[v]) found.push_back(v);
        });
    if (triangles < LARGE_TRIANGULATION) return inside;
    return along_hilbert_curve(t.xy, inside);
}

/// The number of each triangle inside, NIL for others, in the order they have.
Array<Triangle> number_triangles(const Triangulation& t) {
    Array<Triangle> number(t.region.size(), NIL);
    Triangle count = 0;
    for (Triangle k = 0; k < t.triangles(); ++k)
        if (t.region[k] == INSIDE) number[k] = count++;
    return number;
}

/// The same in the order of their first vertices; ``first``: of each vertex, its first triangle.
Array<Triangle> number_by_vertex(const Triangulation& t, const Array<Vertex>& vertex_number,
                                 Array<Triangle>& first) {
    const auto vertex_of = [&](Triangle k) {
        return std::min({vertex_number[t.tri[3 * k]], vertex_number[t.tri[3 * k + 1]],
                         vertex_number[t.tri[3 * k + 2]]});
    };
    auto number = Array<Triangle>::unfilled(t.region.size());  // at first those vertices
    for_each_block(t.region.size(), COPIED_TOGETHER, [&](std::size_t start, std::size_t end) {
        for (auto k = static_cast<Triangle>(start); k < static_cast<Triangle>(end); ++k)
            number[k] = t.region[k] == INSIDE ? vertex_of(k) : NIL;
    });
    for (Triangle k = 0; k < t.triangles(); ++k)
        if (t.region[k] == INSIDE) ++first[number[k] + 1];
    for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
    Array<Triangle> next(first);
    for (Triangle k = 0; k < t.triangles(); ++k)
        if (t.region[k] == INSIDE) number[k] = next[number[k]]++;
    return number;
}

/// Parts of equally many vertices. ``first``: of each vertex, its first triangle.
Array<Part> parts_of(const Array<Triangle>& first) {
    const std::size_t vertices = first.size() - 1;
    const std::size_t count = std::max<std::size_t>(2, vertices / VERTICES_OF_PART);
    const std::size_t each = (vertices + count - 1) / count;
    Array<Part> parts;
    for (std::size_t start = 0; start < vertices; start += each) {
        const std::size_t end = std::min(start + each, vertices);
        parts.push_back(
            {static_cast<Vertex>(start), static_cast<Vertex>(end), first[start], first[end]});
    }
    return parts;
}

void copy_triangles(const Triangulation& t, const Array<Triangle>& number,
                    DomainTriangulation& domain) {
    Triangulation& out = domain.t;
    for_each_block(t.region.size(), COPIED_TOGETHER, [&](std::size_t start, std::size_t end) {
        for (auto k = static_cast<Triangle>(start); k < static_cast<Triangle>(end); ++k) {
            if (number[k] == NIL) continue;
            for (HalfEdge e = 3 * k, f = 3 * number[k]; e < 3 * k + 3; ++e, ++f) {
                out.tri[f] = domain.vertex_number[t.tri[e]];
                out.fixed[f] = t.fixed[e];
                const HalfEdge twin = t.adj[e];
                const Triangle m = twin >= 0 ? number[twin / 3] : NIL;
                out.adj[f] = m != NIL ? 3 * m + twin % 3 : NIL;
            }
        }
    });
}

}  // namespace

DomainTriangulation cut_inside(const Triangulation& t) {
    const auto triangles =
        static_cast<Triangle>(std::count(t.region.begin(), t.region.end(), INSIDE));
    DomainTriangulation domain{{}, filled_by_threads<Vertex>(t.xy.size(), NIL)};
    Triangulation& out = domain.t;
    const Array<Vertex> inside = vertices_inside(t, triangles);
    const std::size_t vertices = inside.size() + inside.size() / ROOM + 64;  // with room for more
    out.xy = unfilled_with_room<Point2>(inside.size(), vertices);
    out.size = unfilled_with_room<SizeTensor>(inside.size(), vertices);
    for_each_block(inside.size(), COPIED_TOGETHER, [&](std::size_t start, std::size_t end) {
        for (std::size_t n = start; n < end; ++n) {
            domain.vertex_number[inside[n]] = static_cast<Vertex>(n);
            out.xy[n] = t.xy[inside[n]];
            out.size[n] = t.size[inside[n]];
        }
    });
    const auto half_edges = 3 * static_cast<std::size_t>(triangles);
    out.tri = unfilled_with_room<Vertex>(half_edges, 6 * vertices);
    out.adj = unfilled_with_room<HalfEdge>(half_edges, 6 * vertices);
    out.fixed = unfilled_with_room<std::uint8_t>(half_edges, 6 * vertices);
    out.region = filled_by_threads<Region>(half_edges / 3, 0, 2 * vertices);
    out.mark = filled_by_threads<std::int32_t>(half_edges / 3, 0, 2 * vertices);
    if (triangles < LARGE_TRIANGULATION) {
        copy_triangles(t, number_triangles(t), domain);
        return domain;
    }
    auto first = filled_by_threads<Triangle>(out.xy.size() + 1, 0);
    copy_triangles(t, number_by_vertex(t, domain.vertex_number, first), domain);
    out.parts = parts_of(first);
    return domain;
}

}  // namespace surfmesh
