"""The generation front: one loop of circles with what is done on its left (2.1, 2.2, 2.4).

What lies inside the front is final. What lies outside, a coarse triangulation of the front's
vertices, tells which circles are near, which are seen, and which polygon is left over. To advance
is to hand a triangle over from outside:

    place: circle p on the edge a -> b          close: the corner at b is filled, c = next[b]
            p                                                  c
           / \\                                                / \\
          / new \\   a -> p -> b                      a -----/ new |    a -> c, b leaves
         a ----- b                                     \\      b
"""

import math
from dataclasses import dataclass
from heapq import heappop, heappush

from surfmesh.reference.plane_triangulation import NIL, Edge, Triangulation
from surfmesh.reference.size_tensors import SizeTensor, dot, length, orient

GOOD_SHAPE = 0.8  # two triangles better than this are left as they are


@dataclass(frozen=True)
class Limits:
    """Where a packing starts and where it ends."""

    origin: complex = 0j
    count: float = math.inf  # of circles
    distance: float = math.inf  # from the origin
    box: tuple[float, float, float, float] = (-1e150, -1e150, 1e150, 1e150)  # x0, y0, x1, y1


class Front(Triangulation):
    def __init__(self, points: list[complex], sizes: list[SizeTensor], limits: Limits) -> None:
        """The triangle of three circles about the origin (2.3.1)."""
        if orient(*points) <= 0:
            raise ValueError(f"no three circles can be placed about {limits.origin}")
        super().__init__(points, sizes)
        self.limits = limits
        self.next: dict[int, int] = {}  # a doubly linked list
        self.prev: dict[int, int] = {}
        self.queue: list[tuple[float, int, int]] = []
        for a in range(3):
            self.link(a, (a + 1) % 3)

    def link(self, a: int, b: int) -> None:
        self.next[a], self.prev[b] = b, a
        self.barriers |= {(a, b), (b, a)}
        self.put(a, b)

    def put(self, a: int, b: int) -> None:
        """The edge nearest to the origin comes first (2.2)."""
        middle = 0.5 * (self.points[a] + self.points[b]) - self.limits.origin
        heappush(self.queue, (dot(middle, middle), a, b))

    def step(self, a: int, b: int, forced: bool) -> bool:
        """Advance at the edge a -> b (2.3). False: it has to wait. ``forced``: all edges wait."""
        raise NotImplementedError

    def advance(self) -> None:
        """Take steps at the edge that is next until the limits are reached (2.4)."""
        forced = False
        while self.queue:
            waiting, moves = [], 0
            while self.queue:
                if len(self.points) >= self.limits.count:
                    return
                _, a, b = heappop(self.queue)
                if self.next.get(a) != b or not self.is_within(a, b):
                    continue
                if not self.step(a, b, forced):
                    waiting.append((a, b))
                    continue
                moves, forced = moves + 1, False
                if self.next.get(a) == b:
                    self.put(a, b)
            if waiting and forced:
                raise ValueError("the front cannot go on")
            forced = moves == 0  # then what is not good must do
            for a, b in waiting:
                if self.next.get(a) == b:
                    self.put(a, b)

    def is_within(self, a: int, b: int) -> bool:
        """Shall the front go on at a -> b (2.4)? Near the origin, and meeting the box."""
        p, q, (x0, y0, x1, y1) = self.points[a], self.points[b], self.limits.box
        if length(0.5 * (p + q) - self.limits.origin) > self.limits.distance:
            return False
        if max(p.real, q.real) < x0 or min(p.real, q.real) > x1:
            return False
        if max(p.imag, q.imag) < y0 or min(p.imag, q.imag) > y1:
            return False
        normal, middle = (p - q) * 1j, complex(0.5 * (x0 + x1), 0.5 * (y0 + y1))
        reach = 0.5 * (abs(normal.real) * (x1 - x0) + abs(normal.imag) * (y1 - y0))
        return abs(dot(normal, middle - p)) <= reach

    def done(self) -> list[int]:
        """The numbers of the triangles inside the front."""
        return self.patch(self.left[a, b] for a, b in self.next.items())

    def look(
        self, edge: Edge, support: Edge, p: complex, h: SizeTensor
    ) -> tuple[list[int], list[Edge], int]:
        """Room for a circle at p, seen from an edge outside: cavity, rim; or a circle in the way."""
        t, barrier = self.locate(edge, p, stop=True)
        if barrier is not None:
            return [], [], barrier[0] if barrier[0] not in support else barrier[1]
        return *self.open_cavity(t, p, h), NIL

    def place(
        self, a: int, b: int, cavity: list[int], rim: list[Edge], p: complex, h: SizeTensor
    ) -> int:
        """Put a circle on the edge a -> b. Returns its vertex."""
        v = self.fill_cavity(cavity, rim, p, h)
        self.barriers -= {(a, b), (b, a)}
        self.link(a, v)
        self.link(v, b)
        self.settle(b, a)
        return v

    def settle(self, a: int, b: int) -> bool:
        """Of the two diagonals between done triangles, take the one with the better worst shape."""
        if (a, b) in self.barriers:
            return False
        c, d = self.apex(a, b), self.apex(b, a)
        old = min(self.shape(a, b, c), self.shape(b, a, d))
        if old > GOOD_SHAPE or min(self.shape(a, d, c), self.shape(b, c, d)) <= old + 1e-3:
            return False
        return self.swap(a, b)

    def close_corner(self, a: int, b: int) -> bool:
        """Hand over the triangle outside a -> b if its apex is a neighbour on the front."""
        c = self.apex(b, a)
        if c not in (self.next[b], self.prev[a]):
            return False
        gone = b if c == self.next[b] else a
        start, end = self.prev.pop(gone), self.next.pop(gone)
        self.barriers -= {(start, gone), (gone, start), (gone, end), (end, gone)}
        self.link(start, end)
        if self.shape(b, a, c) < GOOD_SHAPE:
            swapped = False
            for side in (b, a), (a, c), (c, b):
                swapped = not swapped and self.settle(*side)  # a swap has turned the next side
        return True

    def close_first_corner(self, a: int) -> bool:
        """Close the first corner from a on: every pocket between front and hull has an ear."""
        b = a
        while self.apex(self.next[b], b) != self.next[self.next[b]]:
            b = self.next[b]
            if b == a:
                return False
        return self.close_corner(b, self.next[b])
