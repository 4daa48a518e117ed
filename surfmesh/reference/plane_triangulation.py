"""A triangulation of the whole plane: beyond each hull edge a-b lies a ghost triangle (b, a, NIL).

              c           triangles[t] = (a, b, c), counter-clockwise
             / \\          left[a, b] = left[b, c] = left[c, a] = t
            / t \\         apex(a, b) = c
           a --- b        around(a, b) = [b, c, ...], counter-clockwise

No search crosses a barrier: an edge of the front, or a segment of the boundary.
"""

from collections.abc import Iterable
from fractions import Fraction
from typing import NamedTuple

from surfmesh.reference.size_tensors import SizeTensor, cross, dot, mean, orient, shape

NIL = -1  # the vertex at infinity, or none
Edge = tuple[int, int]
Triangle = tuple[int, int, int]
DEAD = (NIL, NIL, NIL)  # a number without a triangle


class Cavity(NamedTuple):
    numbers: list[int]  # of triangles to be replaced
    rim: list[Edge]  # seen from inside


def sides(triangle: Triangle) -> tuple[Edge, Edge, Edge]:
    a, b, c = triangle
    return (a, b), (b, c), (c, a)


class Triangulation:
    def __init__(self, points: list[complex], sizes: list[SizeTensor]) -> None:
        """Of three points, counter-clockwise."""
        self.points, self.sizes = points, sizes
        self.triangles = [(0, 1, 2), (1, 0, NIL), (2, 1, NIL), (0, 2, NIL)]
        self.left = {side: t for t in range(4) for side in sides(self.triangles[t])}
        self.barriers: set[Edge] = set()  # in both directions

    def write(self, t: int, a: int, b: int, c: int) -> None:
        self.triangles[t] = a, b, c
        self.left[a, b] = self.left[b, c] = self.left[c, a] = t

    def erase(self, numbers: Iterable[int]) -> None:
        for t in numbers:
            for side in sides(self.triangles[t]):
                del self.left[side]
            self.triangles[t] = DEAD

    def apex(self, a: int, b: int) -> int:
        return next(c for c in self.triangles[self.left[a, b]] if c not in (a, b))

    def around(self, a: int, b: int) -> list[int]:
        star = [b]
        while (c := self.apex(a, star[-1])) != b:
            star.append(c)
        return star

    def side(self, a: int, b: int, p: complex) -> Fraction:
        """> 0 where p is left of a -> b, exactly; of an edge to infinity all points are."""
        return Fraction(1) if NIL in (a, b) else orient(self.points[a], self.points[b], p)

    def shape(self, *corners: int) -> float:
        """alpha in the mean metric of the corners."""
        h, (a, b, c) = mean(*(self.sizes[v] for v in corners)), (self.points[v] for v in corners)
        return shape(h.solve(b - a), h.solve(c - a))

    def locate(self, edge: Edge, p: complex) -> tuple[int, Edge | None]:
        """Walk from an edge to the triangle of p, or to the barrier before it.

        Of two ways on, which is tried first varies: no walk goes round for ever.
        """
        onward, dice = edge if self.side(*edge, p) < 0 else None, 12345
        while True:
            if onward in self.barriers:
                return NIL, onward
            edge = (onward[1], onward[0]) if onward else edge
            dice = (dice * 1103515245 + 12345) & 0x7FFFFFFF
            (a, b), c = edge, self.apex(*edge)
            ways = ((b, c), (c, a)) if dice & 0x10000 else ((c, a), (b, c))
            onward = next((way for way in ways if self.side(*way, p) < 0), None)
            if onward is None:
                return self.left[edge], None

    def in_circle(self, triangle: Triangle, p: complex, h: SizeTensor) -> bool:
        """Is p in the circumcircle, in the metric of h? A ghost's is what lies beyond its edge."""
        if NIL in triangle:
            return all(NIL in side or self.side(*side, p) > 0 for side in sides(triangle))
        a, b, c = (h.solve(self.points[v] - p) for v in triangle)
        return dot(a, a) * cross(b, c) - dot(b, b) * cross(a, c) + dot(c, c) * cross(a, b) > 0.0

    def open_cavity(self, t: int, p: complex, h: SizeTensor | None) -> Cavity:
        """What a vertex at p, in the triangle t, replaces (Bowyer-Watson).

        Without a metric: only what its place demands. No rim: p does not see all of it.
        """
        cavity = [t]
        for t in cavity:  # which grows
            for a, b in sides(self.triangles[t]):
                beyond, on_edge = self.left[b, a], self.side(a, b, p) == 0
                if beyond in cavity or (a, b) in self.barriers:
                    continue
                c, near = self.apex(b, a), h and self.in_circle(self.triangles[beyond], p, h)
                if on_edge or (near and self.side(a, c, p) > 0 and self.side(c, b, p) > 0):
                    cavity.append(beyond)
        edges = (side for t in cavity for side in sides(self.triangles[t]))
        rim = [(a, b) for a, b in edges if self.left[b, a] not in cavity]
        seen = len(rim) == len(cavity) + 2 and all(self.side(a, b, p) > 0 for a, b in rim)
        return Cavity(cavity, rim if seen else [])

    def fill_cavity(self, cavity: Cavity, p: complex, h: SizeTensor) -> int:
        """Put the star of a new vertex at p in the place of the cavity. Returns the vertex."""
        v, fresh = len(self.points), len(self.triangles)
        self.points.append(p)
        self.sizes.append(h)
        self.erase(cavity.numbers)
        self.triangles += [DEAD, DEAD]
        for t, (a, b) in zip([*cavity.numbers, fresh, fresh + 1], cavity.rim):
            self.write(t, a, b, v)
        return v

    def swap(self, a: int, b: int) -> bool:
        """Replace a-b by c-d, if the quadrilateral is strictly convex at a and b.

              c                c
            / | \\            /   \\
           a  |  b    ->    a --- b        drawn turned: the triangles become (a, d, c), (b, c, d)
            \\ | /            \\   /
              d                d
        """
        c, d = self.apex(a, b), self.apex(b, a)
        corners_are_seen = NIL not in (a, b, c, d) and self.side(a, d, self.points[c]) > 0
        if not corners_are_seen or self.side(b, c, self.points[d]) <= 0:
            return False
        for t, old, new in (self.left.pop((a, b)), b, d), (self.left.pop((b, a)), a, c):
            self.write(t, *(new if v == old else v for v in self.triangles[t]))
        return True

    def choose_diagonal(self, a: int, b: int, below: float = 1.0) -> bool:
        """Of the two diagonals at a-b take the one with the better worst shape, if that is low."""
        if (a, b) in self.barriers:
            return False
        c, d = self.apex(a, b), self.apex(b, a)
        old = min(self.shape(a, b, c), self.shape(b, a, d))
        new = min(self.shape(a, d, c), self.shape(b, c, d))
        return old <= below and new > old + 1e-3 and self.swap(a, b)

    def remove_vertex(self, v: int, first: int) -> Edge | None:
        """Triangulate the star of v, from its neighbour ``first`` on, without it: best ear first.

        Returns an edge of a new triangle; None where a barrier or the hull holds the vertex.
        """
        polygon = self.around(v, first)
        if any(u == NIL or (v, u) in self.barriers for u in polygon):
            return None
        numbers = [self.left[v, u] for u in polygon]
        self.erase(numbers)
        while (n := len(polygon)) > 2:
            i = 0 if n == 3 else max(range(n), key=lambda k: self._ear(polygon[k:] + polygon[:k]))
            a, b, c = polygon[i], polygon[(i + 1) % n], polygon[(i + 2) % n]
            self.write(numbers.pop(), a, b, c)
            polygon.remove(b)
        return a, b

    def _ear(self, polygon: list[int]) -> float:
        """alpha of the first three corners; -1 where they are no ear: turned, or not empty."""
        a, b, c, *others = polygon
        inside = (all(self.side(*e, self.points[v]) >= 0 for e in sides((a, b, c))) for v in others)
        return -1.0 if self.side(a, b, self.points[c]) <= 0 or any(inside) else self.shape(a, b, c)

    def patch(self, seeds: Iterable[int]) -> list[int]:
        """The triangles that are reached from the seeds without crossing a barrier, in order."""
        found = list(dict.fromkeys(seeds))
        for t in found:  # which grows
            ways = (side for side in sides(self.triangles[t]) if side not in self.barriers)
            found += {self.left[b, a] for a, b in ways}.difference(found)
        return sorted(found)
