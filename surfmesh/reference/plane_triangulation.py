"""A triangulation of the whole plane: beyond each hull edge a-b lies a ghost triangle (b, a, NIL).

              c           triangles[t] = (a, b, c), counter-clockwise
             / \\          left[a, b] = left[b, c] = left[c, a] = t
            / t \\         apex(a, b) = c
           a --- b        around(a, b) = [b, c, ...], counter-clockwise

No search crosses a barrier: an edge of the front, or a segment of the boundary.
"""

from collections.abc import Iterable

from surfmesh.reference.size_tensors import SizeTensor, cross, dot, mean, orient, shape

NIL = -1  # the vertex at infinity, or none
Edge = tuple[int, int]
Triangle = tuple[int, int, int]
DEAD = (NIL, NIL, NIL)  # a number without a triangle


def sides(triangle: Triangle) -> tuple[Edge, Edge, Edge]:
    a, b, c = triangle
    return (a, b), (b, c), (c, a)


def replaced(triangle: Triangle, old: int, new: int) -> Triangle:
    a, b, c = (new if v == old else v for v in triangle)
    return a, b, c


class Triangulation:
    def __init__(self, points: list[complex], sizes: list[SizeTensor]) -> None:
        """Of three points, counter-clockwise."""
        self.points, self.sizes = points, sizes
        self.triangles: list[Triangle] = 4 * [DEAD]
        self.left: dict[Edge, int] = {}
        self.barriers: set[Edge] = set()  # in both directions
        for t, corners in enumerate([(0, 1, 2), (1, 0, NIL), (2, 1, NIL), (0, 2, NIL)]):
            self.write(t, corners)

    def write(self, t: int, triangle: Triangle) -> None:
        self.triangles[t] = triangle
        self.left.update((side, t) for side in sides(triangle))

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

    def side(self, a: int, b: int, p: complex) -> float:
        """> 0 where p is left of a -> b, exactly; an edge to infinity has all points on its left."""
        return 1.0 if NIL in (a, b) else orient(self.points[a], self.points[b], p)

    def shape(self, *corners: int) -> float:
        """alpha in the mean metric of the corners."""
        h, (a, b, c) = mean(*(self.sizes[v] for v in corners)), (self.points[v] for v in corners)
        return shape(h.solve(b - a), h.solve(c - a))

    def locate(self, edge: Edge, p: complex, stop: bool = False) -> tuple[int, Edge | None]:
        """Walk from an edge to the triangle of p; or, if asked to ``stop``, to a barrier.

        Of two ways on, which is tried first varies: no walk goes round for ever.
        """
        onward, dice = edge if self.side(*edge, p) < 0 else None, 12345
        while True:
            if onward is not None:
                if stop and onward in self.barriers:
                    return NIL, onward
                edge = onward[1], onward[0]
            dice = (dice * 1103515245 + 12345) & 0x7FFFFFFF
            ways = [(edge[1], self.apex(*edge)), (self.apex(*edge), edge[0])]
            ways = ways if dice & 0x10000 else ways[::-1]
            onward = next((way for way in ways if self.side(*way, p) < 0), None)
            if onward is None:
                return self.left[edge], None

    def in_circle(self, triangle: Triangle, p: complex, h: SizeTensor) -> bool:
        """Is p in the circumcircle, in the metric of h? A ghost's is what lies beyond its edge."""
        if NIL in triangle:
            a, b = next(side for side in sides(triangle) if NIL not in side)
            return self.side(a, b, p) > 0
        a, b, c = (h.solve(self.points[v] - p) for v in triangle)
        return dot(a, a) * cross(b, c) - dot(b, b) * cross(a, c) + dot(c, c) * cross(a, b) > 0.0

    def open_cavity(
        self, t: int, p: complex, h: SizeTensor, wide: bool = True
    ) -> tuple[list[int], list[Edge]]:
        """The triangles that a vertex at p, in t, replaces (Bowyer-Watson), and the rim.

        Not ``wide``: only what its place demands. No rim: p does not see all of it.
        """
        cavity = [t]
        for t in cavity:  # which grows
            for a, b in sides(self.triangles[t]):
                beyond, on_edge = self.left[b, a], self.side(a, b, p) == 0
                if beyond in cavity or (a, b) in self.barriers:
                    continue
                if on_edge or (wide and self.in_circle(self.triangles[beyond], p, h)):
                    c = self.apex(b, a)
                    if on_edge or (self.side(a, c, p) > 0 and self.side(c, b, p) > 0):
                        cavity.append(beyond)
        edges = [side for t in cavity for side in sides(self.triangles[t])]
        rim = [(a, b) for a, b in edges if self.left[b, a] not in cavity]
        seen = len(rim) == len(cavity) + 2 and all(self.side(a, b, p) > 0 for a, b in rim)
        return cavity, rim if seen else []

    def fill_cavity(self, cavity: list[int], rim: list[Edge], p: complex, h: SizeTensor) -> int:
        """Put the star of a new vertex at p in the place of the cavity. Returns the vertex."""
        v, fresh = len(self.points), len(self.triangles)
        self.points.append(p)
        self.sizes.append(h)
        self.erase(cavity)
        self.triangles += [DEAD, DEAD]
        for t, (a, b) in zip([*cavity, fresh, fresh + 1], rim):
            self.write(t, (a, b, v))
        return v

    def swap(self, a: int, b: int) -> bool:
        """Replace a-b by d-c, if the quadrilateral is strictly convex at a and b.

              c              c
            / | \\          /   \\
           a  |  b   ->   a --- b      (drawn turned: the triangles become a, d, c and b, c, d)
            \\ | /          \\   /
              d              d
        """
        c, d = self.apex(a, b), self.apex(b, a)
        if NIL in (a, b, c, d):
            return False
        if self.side(a, d, self.points[c]) <= 0 or self.side(b, c, self.points[d]) <= 0:
            return False
        s, t = self.left.pop((a, b)), self.left.pop((b, a))
        self.write(s, replaced(self.triangles[s], b, d))
        self.write(t, replaced(self.triangles[t], a, c))
        return True

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
            self.write(numbers.pop(), (a, b, c))
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
