"""Section 2: circles whose sizes are read from a field, packed along the generation front.

The front is one loop of circles with what is done on its left. What lies outside, a coarse
triangulation of its vertices, tells which circles are near, which are seen, and which polygon is
left over. To advance is to hand a triangle over:

    place: circle v on the edge a -> b          close: the corner at b is filled
            v                                                  c
           / \\                                                / \\
          / new \\   a -> v -> b                      a -----/ new |    a -> c, b leaves
         a ----- b                                     \\      b
"""

import math
from collections.abc import Callable
from heapq import heappop, heappush
from typing import NamedTuple

from surfmesh.reference.plane_triangulation import NIL, Cavity, Edge, Triangulation
from surfmesh.reference.size_tensors import SizeTensor, common_step, cross, dot, length, mean

CLOSENESS, FIT_STEPS = 0.98, 8  # beta1 beta2 above which a fit is accepted (2.3.2)
CLOSE_BELOW = 1.40  # a corner a, b, c is filled straight away when l(a, c) is below this
OVERLAP = 0.65  # a circle nearer than this refuses the candidate
TANGENT_RANGE = 0.8, 1.25  # of the wanted radius: circles tangent to three that are taken (2.3.3)
GOOD_SHAPE = 0.8  # two triangles better than this are left as they are


class Limits(NamedTuple):
    origin: complex = 0j
    circles: float = math.inf
    distance: float = math.inf  # from the origin
    box: tuple[complex, complex] = (complex(-1e150, -1e150), complex(1e150, 1e150))  # its corners


class FieldPacking(Triangulation):
    def __init__(self, size: Callable[[complex], SizeTensor], limits: Limits) -> None:
        """The front is a doubly linked list (2.1), at first of three circles."""
        self.size, self.limits = size, limits
        super().__init__(*self.first_three())
        if self.side(0, 1, self.points[2]) <= 0:
            raise ValueError(f"no three circles can be placed about {limits.origin}")
        self.next: dict[int, int] = {}
        self.prev: dict[int, int] = {}
        self.queue: list[tuple[float, int, int]] = []
        for a in range(3):
            self.link(a, (a + 1) % 3)

    def first_three(self) -> tuple[list[complex], list[SizeTensor]]:
        """Circles of the sizes wanted, touching each other about the origin (2.3.1)."""
        angles = (2.0 * math.pi * k / 3.0 - 0.5 * math.pi for k in range(3))
        corners = (complex(math.cos(a), math.sin(a)) / math.sqrt(3.0) for a in angles)
        scale, origin = self.size(self.limits.origin), self.limits.origin
        points = [origin + scale.times(corner) for corner in corners]
        return points, [self.size(p) for p in points]

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

    def step(self, a: int, b: int) -> bool:
        """Place a circle on the edge a -> b, or close a corner (2.3). False: it has to wait."""
        apex = self.apex(b, a)
        far = {self.prev[a]: b, self.next[b]: a}.get(apex)  # the circle across a corner
        if far is not None:
            if self.measure(self.points[far], self.sizes[far], apex)[0] < CLOSE_BELOW:
                return self.close_corner(a, b)
        p, h = self.fit_to_two(a, b)
        placed, other = self.try_at(a, b, p, h, OVERLAP)
        other = apex if other == NIL else other
        return placed or self.push_out(a, b, other, p) or self.close_corner(a, b)

    def measure(self, p: complex, h: SizeTensor, v: int) -> tuple[float, complex]:
        """The metric length l(p, v) and its gradient by p; the paper's k is 1 / l (2.3.1)."""
        metric = mean(h, self.sizes[v])
        u = metric.solve(p - self.points[v])
        return length(u), metric.solve(u / length(u))

    def fit_to_two(self, a: int, b: int) -> tuple[complex, SizeTensor]:
        """The circle that touches those of a and b, right of a -> b (2.3.2).

        Its size depends on where it ends up. From the apex of the equilateral triangle on: Newton
        on (l(p, a), l(p, b)) = (1, 1), the size read again at each step.
        """
        start, way = self.points[a], self.points[b] - self.points[a]
        metric = mean(self.sizes[a], self.sizes[b])
        base = metric.solve(way)
        height = math.sqrt(max(1.0 - 0.25 * length(base) * length(base), 0.25)) / length(base)
        p = 0.5 * (start + self.points[b]) + metric.times(-1j * base * height)
        best, closest = (p, self.sizes[a]), -1.0
        for _ in range(FIT_STEPS):
            h = self.size(p)
            (la, ga), (lb, gb) = self.measure(p, h, a), self.measure(p, h, b)
            closeness = min(la, 1.0 / la) * min(lb, 1.0 / lb)  # beta1 beta2
            if closeness > closest:
                best, closest = (p, h), closeness
            move = common_step(ga, 1.0 - la, gb, 1.0 - lb, 1e-3)
            if closeness > CLOSENESS or move is None:
                break
            p += move
            if cross(way, p - start) >= 0.0:  # inside the front
                break
        return best

    def look(self, edge: Edge, support: Edge, p: complex, h: SizeTensor) -> tuple[Cavity, int]:
        """Room for a circle at p, seen from an edge outside; or no rim and what hides it."""
        t, barrier = self.locate(edge, p)
        if barrier is None:
            return self.open_cavity(t, p, h), NIL
        return Cavity([], []), barrier[0] if barrier[0] not in support else barrier[1]

    def try_at(self, a: int, b: int, p: complex, h: SizeTensor, reach: float) -> tuple[bool, int]:
        """Place a circle, or tell which overlaps it: f < 0 is l < ``reach`` here (2.3.3)."""
        cavity, other = self.look((b, a), (a, b), p, h)
        if not cavity.rim or self.left[b, a] not in cavity.numbers:
            return False, other
        others = (v for v, _ in cavity.rim if v not in (NIL, a, b))
        near = [(reach, NIL), *((self.measure(p, h, v)[0], v) for v in others)]
        other = min(near, key=lambda pair: pair[0])[1]
        return other == NIL and self.place(a, b, cavity, p, h) != NIL, other

    def push_out(self, a: int, b: int, other: int, p: complex) -> bool:
        """The support grows to the circle in the way: try the one tangent to all three (2.3.3)."""
        found = self.fit_to_three(a, b, other, p) if other not in (NIL, a, b) else None
        if found is None or not TANGENT_RANGE[0] < found[2] < TANGENT_RANGE[1]:
            return False
        p, h, r = found
        return self.side(a, b, p) < 0 and self.try_at(a, b, p, h, 0.9 * r)[0]

    def fit_to_three(
        self, a: int, b: int, c: int, p: complex
    ) -> tuple[complex, SizeTensor, float] | None:
        """The circle tangent to three, by Newton on l(p, a) = l(p, b) = l(p, c) = r (2.3.3)."""
        for _ in range(FIT_STEPS):
            h = self.size(p)
            (la, ga), (lb, gb), (lc, gc) = (self.measure(p, h, v) for v in (a, b, c))
            r = (la + lb + lc) / 3.0
            if max(abs(la - r), abs(lb - r), abs(lc - r)) < 0.01 * r:
                return p, h, r
            move = common_step(ga - gb, lb - la, ga - gc, lc - la, 1e-6)
            if move is None:
                break
            p += move
        return None

    def place(self, a: int, b: int, cavity: Cavity, p: complex, h: SizeTensor) -> int:
        """Put a circle on the edge a -> b. Returns its vertex."""
        v = self.fill_cavity(cavity, p, h)
        self.barriers -= {(a, b), (b, a)}
        self.link(a, v)
        self.link(v, b)
        self.choose_diagonal(b, a, GOOD_SHAPE)
        return v

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
            for side in (b, a), (a, c), (c, b):  # of which a swap turns the next one
                swapped = not swapped and self.choose_diagonal(*side, GOOD_SHAPE)
        return True
