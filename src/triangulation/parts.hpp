// Parts of a large triangulation, on which threads work side by side.
//
// A part is a range of vertices and one of triangles. A triangle of the range whose corners all are
// vertices of the part is *within* it: whoever works on the part may change it, its corners and the
// twins across its edges, and need not look at anything that belongs to another part. What is not
// within any part is left until all are done. Which parts there are depends on the triangulation
// alone, never on the number of threads; a small one has none, and is worked on as one.
#pragma once

#include <vector>

#include "triangulation/triangulation.hpp"
#include "values/threads.hpp"

namespace surfmesh {

inline std::size_t count_parts(const Triangulation& t) {
    return t.parts.empty() ? 1 : t.parts.size();
}

inline Part whole_of(const Triangulation& t) { return {0, t.vertices(), 0, t.triangles()}; }

/// Part n, or the whole where there are none.
inline Part part_of(const Triangulation& t, std::size_t n) {
    if (!t.parts.empty()) return t.parts[static_cast<std::ptrdiff_t>(n)];
    return whole_of(t);
}

inline bool has_vertex(const Part& part, Vertex v) {
    return part.first_vertex <= v && v < part.end_vertex;
}

/// Is triangle k within the part? What another thread changes is not looked at.
inline bool is_within(const Triangulation& t, const Part& part, Triangle k) {
    return part.first_triangle <= k && k < part.end_triangle && has_vertex(part, t.tri[3 * k]) &&
           has_vertex(part, t.tri[3 * k + 1]) && has_vertex(part, t.tri[3 * k + 2]);
}

/// Is triangle k within a part, that of its corners? All are where there are none.
inline bool is_within_its_part(const Triangulation& t, Triangle k) {
    if (t.parts.empty()) return true;
    const auto n = static_cast<std::size_t>(t.tri[3 * k] / t.parts[0].end_vertex);  // see below
    return n < count_parts(t) && is_within(t, part_of(t, n), k);
}

/// Do vertices a, b and c belong to one part?
inline bool are_in_one_part(const Triangulation& t, Vertex a, Vertex b, Vertex c) {
    if (t.parts.empty()) return true;
    const Vertex each = t.parts[0].end_vertex;  // all parts but the last have so many
    const Vertex part = a / each;
    return part == b / each && part == c / each && a < part_of(t, count_parts(t) - 1).end_vertex;
}

/// Call ``work(part, left)`` for each part, side by side; ``left``: what it leaves for later.
///
/// Returns what was left, part by part, and then the triangles that are in no part's range.
template <class Work>
Array<Triangle> for_each_part(const Triangulation& t, const Work& work) {
    std::vector<Array<Triangle>> left(count_parts(t));
    for_each_block(count_parts(t), 1, [&](std::size_t n, std::size_t) {
        Array<Triangle> own;
        work(part_of(t, n), own);
        left[n].swap(own);
    });
    Array<Triangle> all = std::move(left[0]);
    for (std::size_t n = 1; n < left.size(); ++n)
        for (const Triangle k : left[n]) all.push_back(k);
    const Part last = part_of(t, count_parts(t) - 1);
    for (Triangle k = last.end_triangle; k < t.triangles(); ++k) all.push_back(k);
    return all;
}

}  // namespace surfmesh
