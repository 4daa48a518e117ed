// A triangulation of the whole plane in flat arrays, with ghost triangles at the hull.
//
// Insertion opens a cavity of triangles around the new point and fills it with a star; walking,
// opening and filling never cross a *barrier*: a half-edge between two triangles of different
// region (the front), or one that is fixed (a boundary segment). Every real triangle is counter-
// clockwise, exactly, before and after each call. See values/conventions.hpp for half-edges.
#pragma once

#include <cstdint>

#include "fields/tensors.hpp"
#include "triangulation/predicates.hpp"
#include "values/array.hpp"
#include "values/conventions.hpp"
#include "values/size_tensor.hpp"

namespace surfmesh {

using Region = std::uint8_t;
inline constexpr Region TODO = 0, DONE = 1;       // while circles are packed: the front's two sides
inline constexpr Region OUTSIDE = 0, INSIDE = 1;  // once boundaries are inserted
inline constexpr Region DEAD = 255;               // a triangle slot that is no longer used

/// A half-edge that may be on the rim of the open cavity.
struct RimCandidate {
    HalfEdge e;
    Triangle beyond;  // the triangle on its other side
    double side;      // > 0 where the new point is on its left, exactly
};

/// A range of vertices, and one of triangles; see triangulation/parts.hpp.
struct Part {
    Vertex first_vertex, end_vertex;
    Triangle first_triangle, end_triangle;
};

struct Triangulation {
    Array<Point2> xy;           // of the vertices
    Array<SizeTensor> size;     // H of the vertices
    Array<Vertex> tri;          // three a triangle, NIL in a ghost triangle
    Array<HalfEdge> adj;        // three a triangle: twin half-edges
    Array<Region> region;       // of the triangles
    Array<std::uint8_t> fixed;  // three a triangle, or none while there are no segments
    Array<Part> parts;          // of a large domain: on which threads work side by side

    Array<Triangle> cavity;    // the open cavity
    Array<HalfEdge> rim;       // half-edges around it, seen from inside
    Array<std::int32_t> mark;  // of the triangles: number of the search that saw it
    std::int32_t search = 0;   // number of the current search

    [[nodiscard]] Vertex vertices() const { return static_cast<Vertex>(xy.size()); }
    /// How many triangles there are, dead ones included.
    [[nodiscard]] Triangle triangles() const { return static_cast<Triangle>(region.size()); }
    [[nodiscard]] bool has_segments() const { return !fixed.empty(); }

    Vertex add_vertex(Point2 place, SizeTensor tensor);
    Triangle add_triangle();
    void reserve(std::size_t vertices);

    Array<RimCandidate> candidates;  // scratch of ``open_cavity``

  private:
    friend void fill_cavity(Triangulation& t, Vertex p);
    Array<std::int32_t> link_;  // of the vertices, then of NIL: where a star goes on
};

constexpr HalfEdge next_half_edge(HalfEdge e) { return e % 3 == 2 ? e - 2 : e + 1; }
constexpr HalfEdge prev_half_edge(HalfEdge e) { return e % 3 == 0 ? e + 2 : e - 1; }

/// The next half-edge counter-clockwise around the start of e.
inline HalfEdge rotate_ccw(const Triangulation& t, HalfEdge e) { return t.adj[prev_half_edge(e)]; }

/// May no search cross half-edge e?
inline bool is_barrier(const Triangulation& t, HalfEdge e) {
    if (t.region[t.adj[e] / 3] != t.region[e / 3]) return true;
    return t.has_segments() && t.fixed[e] != 0;
}

/// Exact orientation of (a, b, p); an edge of the hull's infinite vertex sees all.
inline double side(const Triangulation& t, Vertex a, Vertex b, Point2 p) {
    return a < 0 || b < 0 ? 1.0 : orient(t.xy[a], t.xy[b], p);
}

struct Location {
    Triangle triangle;
    HalfEdge barrier;  // what is in the way, or NIL
};

/// Walk from half-edge ``start`` to the triangle of p. With ``stop`` the walk ends at a barrier.
Location locate(const Triangulation& t, HalfEdge start, Point2 p, bool stop = false);

/// Collect the triangles to remove for a new vertex at p with size tensor h; p lies in ``start``.
///
/// With ``wide`` the cavity holds the triangles whose metric circumcircle contains the point
/// (Bowyer-Watson), otherwise only what the point's place demands. Only triangles of the region
/// of ``start`` take part. False when the rim is not wholly visible from the point, exactly.
[[nodiscard]] bool open_cavity(Triangulation& t, Triangle start, Point2 p, SizeTensor h, bool wide);

/// May the open cavity be filled from p instead of the point it was opened for?
///
/// The whole rim must be visible. Where the cavity holds ghosts, the hull must stay convex: at
/// the new vertex, and at its two new neighbours, whose next hull edges stay hidden.
[[nodiscard]] bool is_rim_visible(const Triangulation& t, Point2 p);

/// Replace the open cavity by the star of vertex p; the triangle on rim i is ``cavity[i]``.
///
/// The triangle on rim edge x -> y becomes (x, y, p); each keeps the region of the cavity.
void fill_cavity(Triangulation& t, Vertex p);

}  // namespace surfmesh
