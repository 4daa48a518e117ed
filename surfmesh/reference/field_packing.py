"""Circles whose sizes are read from a field, each fitted by iteration (2.3)."""

import math
from collections.abc import Callable

from surfmesh.reference.generation_front import Front, Limits
from surfmesh.reference.plane_triangulation import NIL, Edge
from surfmesh.reference.size_tensors import SizeTensor, common_step, cross, length, mean, orient

CLOSENESS, FIT_STEPS = 0.98, 8  # beta1 beta2 above which a fit is accepted (2.3.2)
CLOSE_BELOW = 1.40  # a corner a, b, c is filled straight away when l(a, c) is below this
OVERLAP = 0.65  # a circle nearer than this refuses the candidate
TANGENT_RANGE = 0.8, 1.25  # of the wanted radius: circles tangent to three that are taken (2.3.3)
NEIGHBOURS_WITHIN, TOUCHED_WITHIN = 1.4, 0.08  # l of neighbours; |l - 1| that is touch enough


class FieldPacking(Front):
    def __init__(self, size: Callable[[complex], SizeTensor], limits: Limits) -> None:
        """Three circles of the sizes wanted, touching each other about the origin (2.3.1)."""
        self.size = size
        angles = (2.0 * math.pi * k / 3.0 - 0.5 * math.pi for k in range(3))
        corners = [complex(math.cos(a), math.sin(a)) / math.sqrt(3.0) for a in angles]
        points = [limits.origin + size(limits.origin).times(corner) for corner in corners]
        super().__init__(points, [size(p) for p in points], limits)

    def step(self, a: int, b: int) -> bool:
        apex = self.apex(b, a)
        far = {self.prev[a]: b, self.next[b]: a}.get(apex)  # the circle across a corner
        if far is not None:
            if self.measure(self.points[far], self.sizes[far], apex)[0] < CLOSE_BELOW:
                return self.close_corner(a, b)
        p, h = self.fit_to_two(a, b)
        cavity, other = self.look((b, a), (a, b), p, h)
        if cavity.rim and self.left[b, a] in cavity.numbers:
            other, better = self.relax_against_neighbours(cavity.rim, (a, b), p, h, OVERLAP)
            if other == NIL:
                if better is not None and self.is_rim_visible(cavity.rim, better):
                    p, h = better, self.size(better)
                self.place(a, b, cavity, p, h)
                return True
        other = apex if other == NIL else other
        return self.push_out(a, b, other, p) or self.close_corner(a, b)

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

    def relax_against_neighbours(
        self, rim: list[Edge], support: Edge, p: complex, h: SizeTensor, reach: float
    ) -> tuple[int, complex | None]:
        """The nearest circle below ``reach`` (f_ij < 0 is l < 1; 2.3.3); a place that suits all.

        Between two circles of the front there is seldom room for exactly one more: one
        Gauss-Newton step on the sum of (l - 1)^2 over the neighbours shares the misfit.
        """
        nearest, shortest, crowded = NIL, reach, False
        row_x = row_y = right = 0j  # of the normal equations
        for v in (a for a, _ in rim if a != NIL):
            l, g = self.measure(p, h, v)
            if l >= NEIGHBOURS_WITHIN:
                continue
            if v not in support:
                crowded = crowded or abs(l - 1.0) > TOUCHED_WITHIN
                nearest, shortest = (v, l) if l < shortest else (nearest, shortest)
            row_x, row_y, right = row_x + g.real * g, row_y + g.imag * g, right + (1.0 - l) * g
        move = common_step(row_x, right.real, row_y, right.imag, 1e-12) if crowded else None
        return nearest, None if move is None else p + move

    def is_rim_visible(self, rim: list[Edge], p: complex) -> bool:
        """May the cavity be filled from p? It sees the rim, and the hull stays convex."""
        hull = {}
        for a, b in rim:
            if NIL in (a, b):
                hull[b] = a  # it would run hull[NIL] -> p -> the other
                ghost = self.triangles[self.left[b, a]]  # the next one along the hull
                if self.in_circle(ghost, p, self.sizes[0]):
                    return False
            elif self.side(a, b, p) <= 0:
                return False
        last = next((b for b in hull if b != NIL), NIL)
        return not hull or self.side(last, hull[NIL], p) > 0

    def push_out(self, a: int, b: int, other: int, p: complex) -> bool:
        """The support grows to the circle in the way: try the one tangent to all three (2.3.3)."""
        found = self.fit_to_three(a, b, other, p) if other not in (NIL, a, b) else None
        if found is None or not TANGENT_RANGE[0] < found[2] < TANGENT_RANGE[1]:
            return False
        p, h, r = found
        if orient(self.points[a], self.points[b], p) >= 0:
            return False
        cavity, _ = self.look((b, a), (a, b), p, h)
        if self.left[b, a] not in cavity.numbers or not cavity.rim:
            return False
        nearest, _ = self.relax_against_neighbours(cavity.rim, (a, b), p, h, 0.9 * r)
        return nearest == NIL and self.place(a, b, cavity, p, h) != NIL

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
