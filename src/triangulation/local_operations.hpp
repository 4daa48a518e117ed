// Local changes of a triangulation: swap an edge, remove a vertex. Orientation is kept exactly.
#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "triangulation/triangulation.hpp"

namespace surfmesh {

/// Can e be swapped: is its quadrilateral strictly convex at both ends of e?
[[nodiscard]] bool is_convex(const Triangulation& t, HalfEdge e);

/// Replace the edge a-b by c-d; the two triangles keep their slots.
///
///          c                       c            before: e a->b, e1 b->c, e2 c->a
///        / | \                   /   \                  f b->a, f1 a->d, f2 d->b
///    e2 /  |  \ e1           e2 /     \ f
///      /   |   \               / e1 f1 \        after:  e a->d, e1 d->c, e2 c->a
///     a   e|f   b     to      a --------- b             f b->c, f1 c->d, f2 d->b
///      \   |   /               \       /
///    f1 \  |  / f2            e \     / f2      (e runs from a to b; c-d is drawn
///        \ | /                   \   /           as the level line on the right)
///          d                       d
void swap_edge(Triangulation& t, HalfEdge e);

/// An edge of the rim of a star, counter-clockwise: where it starts, and what is beyond.
struct StarEdge {
    Vertex start;
    HalfEdge outer;  // NIL at the border
    std::uint8_t fixed;
};

/// The star of a vertex, to be triangulated without it.
struct StarPolygon {
    Array<StarEdge> rim;
    Array<Triangle> triangles;  // whose slots may be used
};

/// Take the star of the start of e. False where it meets the hull, or the vertex has to stay: it
/// is on the border, or a fixed edge ends there.
[[nodiscard]] bool take_star(const Triangulation& t, HalfEdge e, StarPolygon& polygon);

/// Is the triangle of corners i, i + 1 and i + 2 positive, with no other corner in it?
[[nodiscard]] bool is_ear(const Triangulation& t, std::span<const Vertex> corners, std::size_t i);

/// The ears that a polygon is cut into, one after the other: of each its first corner, as the
/// corners are numbered when the earlier ones are off. The last ear is all that is left.
struct Ears {
    Array<std::size_t> first;
    double worst = std::numeric_limits<double>::infinity();  // shape of all the triangles
};

template <class T>
void erase(Array<T>& values, std::size_t k) {
    std::copy(values.begin() + k + 1, values.end(), values.begin() + k);
    values.resize(values.size() - 1);
}

/// Cut a polygon into ears, that of the best shape(p, q, r) first; a simple polygon has one.
template <class Shape>
Ears best_ears(const Triangulation& t, const StarPolygon& polygon, const Shape& shape) {
    Array<Vertex> corners;
    for (const StarEdge& edge : polygon.rim) corners.push_back(edge.start);
    Ears ears;
    while (true) {
        const std::size_t n = corners.size();
        std::size_t best = 0;
        double best_shape = -std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < (n == 3 ? 1 : n); ++i) {
            if (n > 3 && !is_ear(t, {corners.data(), n}, i)) continue;
            const double found = shape(corners[i], corners[(i + 1) % n], corners[(i + 2) % n]);
            if (!(found > best_shape)) continue;
            best = i;
            best_shape = found;
        }
        ears.first.push_back(best);
        ears.worst = std::min(ears.worst, best_shape);
        if (n == 3) return ears;
        erase(corners, (best + 1) % n);
    }
}

/// Triangulate a star by its ears; returns a half-edge of the new triangles. Two slots go DEAD.
HalfEdge fill_polygon(Triangulation& t, const StarPolygon& polygon, const Ears& ears);

/// Join the vertex v, which is inside, to all edges of the rim; slots for two triangles are added.
void fill_star(Triangulation& t, const StarPolygon& polygon, Vertex v);

/// Remove the vertex at the start of e and triangulate its star anew, ear by ear.
///
/// Returns a half-edge of the new triangles, or NIL when the vertex cannot go: its star meets the
/// hull or the border, or a fixed edge ends there. Two slots go DEAD. There are segments.
HalfEdge remove_vertex(Triangulation& t, HalfEdge e);

}  // namespace surfmesh
