"""The generation front: one loop of circles with what is done on its left (2.1, 2.2, 2.4).

What lies outside, a coarse triangulation of the front's vertices, tells which circles are near,
which are seen, and which polygon is left over. To advance is to hand a triangle over:

    place: circle v on the edge a -> b          close: the corner at b is filled
            v                                                  c
           / \\                                                / \\
          / new \\   a -> v -> b                      a -----/ new |    a -> c, b leaves
         a ----- b                                     \\      b
"""

import math
from heapq import heappop, heappush
from typing import NamedTuple

from surfmesh.reference.plane_triangulation import NIL, Cavity, Edge, Triangulation
from surfmesh.reference.size_tensors import SizeTensor, dot, length, orient

GOOD_SHAPE = 0.8  # two triangles better than this are left as they are


class Limits(NamedTuple):
    origin: complex = 0j
    circles: float = math.inf
    distance: float = math.inf  # from the origin
    box: tuple[complex, complex] = (complex(-1e150, -1e150), complex(1e150, 1e150))  # its corners


class Front(Triangulation):
    def __init__(self, points: list[complex], sizes: list[SizeTensor], limits: Limits) -> None:
        """The triangle of three circles about the origin (2.3.1)."""
        if orient(*points) <= 0:
            raise ValueError(f"no three circles can be placed about {limits.origin}")
        super().__init__(points, sizes)
        self.limits = limits
        self.next: dict[int, int] = {}  # a doubly linked list (2.1)
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
        if self.next.get(a) == b:
            middle = 0.5 * (self.points[a] + self.points[b]) - self.limits.origin
            heappush(self.queue, (dot(middle, middle), a, b))

    def advance(self) -> None:
        """Take the step that is next until the limits are reached (2.4)."""
        waiting: list[Edge] = []
        moved = False
        while self.queue and len(self.points) < self.limits.circles:
            _, a, b = heappop(self.queue)
            if self.next.get(a) == b and self.is_within(a, b):
                if self.step(a, b):
                    moved = True
                    self.put(a, b)
                else:
                    waiting.append((a, b))
            if waiting and not self.queue:
                if not moved:
                    raise ValueError("all edges wait: the paper knows no way on")
                for edge in waiting:
                    self.put(*edge)
                waiting, moved = [], False

    def step(self, a: int, b: int) -> bool:
        """Place a circle on the edge a -> b, or close a corner (2.3). False: it has to wait."""
        raise NotImplementedError

    def is_within(self, a: int, b: int) -> bool:
        """Shall the front go on at a -> b (2.4)? Near the origin, and meeting the box."""
        (low, high), p, q = self.limits.box, self.points[a], self.points[b]
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        for axis in 1 + 0j, 1j, 1j * (p - q):
            reach = abs(axis.real) * half.real + abs(axis.imag) * half.imag
            s, t = dot(axis, p - middle), dot(axis, q - middle)
            if min(s, t) > reach or max(s, t) < -reach:
                return False
        return length(0.5 * (p + q) - self.limits.origin) <= self.limits.distance

    def done(self) -> list[int]:
        """The numbers of the triangles inside the front."""
        return self.patch(self.left[edge] for edge in self.next.items())

    def look(self, edge: Edge, support: Edge, p: complex, h: SizeTensor) -> tuple[Cavity, int]:
        """Room for a circle at p, seen from an edge outside; or no rim and what hides it."""
        t, barrier = self.locate(edge, p, stop=True)
        if barrier is None:
            return self.open_cavity(t, p, h), NIL
        return Cavity([], []), barrier[0] if barrier[0] not in support else barrier[1]

    def place(self, a: int, b: int, cavity: Cavity, p: complex, h: SizeTensor) -> int:
        """Put a circle on the edge a -> b. Returns its vertex."""
        v = self.fill_cavity(cavity, p, h)
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
        new = min(self.shape(a, d, c), self.shape(b, c, d))
        return old <= GOOD_SHAPE and new > old + 1e-3 and self.swap(a, b)

    def close_corner(self, a: int, b: int) -> bool:
        """Hand over the triangle outside a -> b if its apex is a neighbour on the front."""
        c = self.apex(b, a)
        if c not in (self.next[b], self.prev[a]):
            return False
        gone = b if c == self.next[b] else a
        start, end = self.prev.pop(gone), self.next.pop(gone)
        self.barriers -= {(start, gone), (gone, start), (gone, end), (end, gone)}
        self.link(start, end)
        swapped = self.shape(b, a, c) >= GOOD_SHAPE
        if not swapped:
            for side in (b, a), (a, c), (c, b):
                swapped = not swapped and self.settle(*side)  # a swap has turned the next side
        return True
