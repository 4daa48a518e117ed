"""The row of vertices along a boundary, on the reference's triangulation: a slow twin.

It is not in the paper: before the nodes are inserted, vertices are put where equilateral triangles
over the segments have their apexes.
"""

import math

from surfmesh.reference.boundary_insertion import insert_node
from surfmesh.reference.plane_triangulation import NIL
from surfmesh.reference.size_tensors import length, mean, orient

APART, AROUND, LOWEST = 0.65, 0.6, 0.7


def apexes(size, nodes, sides):
    """Where isosceles triangles with unit legs on the left of the sides have their apexes."""
    for a, b in sides:
        start, end = nodes[a], nodes[b]
        h = size(0.5 * (start + end))
        base = h.solve(end - start)
        height = math.sqrt(max(1.0 - 0.25 * length(base) ** 2, LOWEST**2)) / length(base)
        yield 0.5 * (start + end) + height * h.times(1j * base)


def insert_row(plane, size, nodes, sides):
    """Insert the apexes, join those that are near each other, remove others around them."""
    plane.barriers.clear()
    row = set()
    near = plane.triangles[0][:2]
    for p in apexes(size, nodes, sides):
        t, h = plane.locate(near, p)[0], size(p)
        edge = _joined(plane, t, p, h, row)
        if edge is None:
            edge = insert_node(plane, plane.triangles[t][:2], p, h, row)
            row.add(edge[0])
        near = _clear_around(plane, *edge, row)


def _distance(plane, v, p, h):
    return length(mean(plane.sizes[v], h).solve(plane.points[v] - p))


def _joined(plane, t, p, h, row):
    """An earlier vertex of the row near p, moved half the way to it; and its neighbour."""
    a, b, c = plane.triangles[t]
    edges = [(a, b), (b, c), (c, a)]
    for v, w in edges + [(plane.apex(w, v), w) for v, w in edges]:
        if v in row and _distance(plane, v, p, h) < APART:
            star, old = plane.around(v, w), plane.points[v]
            plane.points[v] = 0.5 * (old + p)
            for q, r in zip(star, star[1:] + star[:1]):
                if NIL in (q, r) or orient(*(plane.points[k] for k in (v, q, r))) <= 0:
                    plane.points[v] = old
                    break
            return v, w
    return None


def _clear_around(plane, v, w, row):
    """Remove the vertices that are not of the row next to v and too near, from w on."""
    start = w
    while True:
        following = plane.apex(v, w)
        near = w not in row and w != NIL
        if near and _distance(plane, w, plane.points[v], plane.sizes[v]) < AROUND:
            edge = plane.remove_vertex(w, v)
            if edge is not None:
                triangle = plane.triangles[plane.locate(edge, plane.points[v])[0]]
                start = w = triangle[(triangle.index(v) + 1) % 3]
                continue
        w = following
        if w == start:
            return v, w
