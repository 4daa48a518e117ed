"""Circles whose radii are drawn at random, each fitted in closed form (2.3): a slow twin.

Where a circle overlaps another, its support is pushed out along the front:

              other              the support grows from (a, b) to (a, other): the circle P touches
          P .                    both; b is left in the polygon a, b, other, P, which is
       /     `  .  other         triangulated
      a --- b --- '
"""

import math
from collections.abc import Iterable, Iterator

from surfmesh.reference.field_packing import FieldPacking, Limits
from surfmesh.reference.plane_triangulation import NIL, Edge
from surfmesh.reference.size_tensors import SizeTensor, circle, common_step, dot, length

TOLERATED = 0.02  # overlap that is let pass, of the sum of the two radii
LOOK_AHEAD = 32  # drawn radii among which one is sought that spans a wide gap
PUSHES, POCKET = 9, 8  # most circles, and edges, of the polygon that is left over (2.3.3)
GROWN = 5.0  # a circle may grow by this to touch three, while it stays the smallest of the four
NEARLY = 1.25  # got over drawn radius, or drawn over got, of a circle that touches three
LEAST_HEIGHT = 0.3  # of its radius: how far a circle between two distant ones stands off

PLACED, CLOSED, USELESS = NIL, -2, -3  # what came of a trial; CLOSED: its polygon, without it
Circle = tuple[complex, float]


class RandomPacking(FieldPacking):
    def __init__(self, radii: Iterator[float], limits: Limits) -> None:
        self.radii, self.drawn = radii, [next(radii) for _ in range(3)]
        super().__init__(circle, limits)  # sizes are drawn: no field is asked

    def first_three(self) -> tuple[list[complex], list[SizeTensor]]:
        """Circles of the drawn radii, touching each other about the origin (2.3.1)."""
        ra, rb, rc = self.drawn
        p, q, d = ra + rc, rb + rc, ra + rb
        x = 0.5 * (d + (p - q) * (p + q) / d)
        corners = [0j, complex(d), complex(x, math.sqrt(max(p * p - x * x, 0.0)))]
        shift = self.limits.origin - sum(corners) / 3.0
        return [c + shift for c in corners], [circle(r) for r in self.drawn]

    def step(self, a: int, b: int) -> bool:
        r = self.draw(0.55 * self.gap(a, b))
        if self.grow_to_three(a, b, r) or self.push_out(a, b, r) or self.next.get(a) != b:
            return True  # or a polygon was closed in part
        c = self.apex(b, a)
        far = {self.prev[a]: b, self.next[b]: a}.get(c)  # the circle across a corner
        return far is not None and self.gap(far, c) < 2.0 * r and self.close_corner(a, b)

    def draw(self, least: float) -> float:
        """The next radius; where the gap is too wide for it, a later one goes first."""
        n = len(self.points)
        self.drawn += (next(self.radii) for _ in range(n + LOOK_AHEAD - len(self.drawn)))
        k = next((k for k in range(n, n + LOOK_AHEAD) if self.drawn[k] >= least), n)
        self.drawn[n], self.drawn[k] = self.drawn[k], self.drawn[n]
        return self.drawn[n]

    def radius(self, v: int) -> float:
        return 0.5 * self.sizes[v].xx

    def gap(self, a: int, b: int) -> float:
        """f = d - (r1 + r2), negative where the circles overlap (2.3.3)."""
        return length(self.points[b] - self.points[a]) - self.radius(a) - self.radius(b)

    def touch_two(self, a: int, b: int, r: float) -> Circle:
        """The circle of radius r, or of more if the gap is wide, that touches a and b (2.3.2)."""
        way, r = self.points[b] - self.points[a], max(r, 0.55 * self.gap(a, b))
        d, p, q = length(way), self.radius(a) + r, self.radius(b) + r
        along = 0.5 * (d + (p - q) * (p + q) / d)
        height = math.sqrt(max(p * p - along * along, (LEAST_HEIGHT * r) ** 2))
        return self.points[a] + complex(along, -height) * way / d, r

    def touch_three(self, a: int, b: int, c: int) -> Circle | None:
        """The circle outside those of a, b and c that touches all three (Apollonius; 2.3.3).

        Of |P| = r + ra, |P - B| = r + rb, |P - C| = r + rc, seen from a, the differences of the
        squares leave P = still + r moving; then |P| = r + ra is a quadratic equation for r.
        """
        B, C = self.points[b] - self.points[a], self.points[c] - self.points[a]
        ra, rb, rc = self.radius(a), self.radius(b), self.radius(c)
        eb, ec = dot(B, B) - (rb - ra) * (rb + ra), dot(C, C) - (rc - ra) * (rc + ra)
        still = common_step(B, 0.5 * eb, C, 0.5 * ec, 1e-9)
        moving = common_step(B, ra - rb, C, ra - rc, 1e-9)
        if still is None or moving is None:
            return None
        k2, k1, k0 = dot(moving, moving) - 1.0, dot(still, moving) - ra, dot(still, still) - ra * ra
        root = math.sqrt(max(k1 * k1 - k2 * k0, 0.0))
        roots = [k0 / divisor for divisor in (-k1 + root, -k1 - root) if divisor != 0.0]
        r = min((r for r in roots if r > 0.0), default=0.0)
        exists = k1 * k1 >= k2 * k0 and r > 0.0
        return (self.points[a] + still + r * moving, r) if exists else None

    def grow_to_three(self, a: int, b: int, wanted: float) -> bool:
        """Try the circle that touches a, b and the one across, if that is a little larger (2.2)."""
        c = self.apex(b, a)
        found = self.touch_three(a, b, c) if c != NIL else None
        if found is None or found[1] >= min(self.radius(v) for v in (a, b, c)):
            return False
        larger = wanted < found[1] < GROWN * wanted
        return larger and self.try_circle((b, a), (a, b), found) in (PLACED, CLOSED)

    def push_out(self, a: int, b: int, wanted: float) -> bool:
        """Fit the circle to a and b; push the support out until nothing overlaps (2.3.3)."""
        first, last, edge, moved = a, b, (b, a), False  # the support (m - q, m + p)
        for _ in range(PUSHES):
            other = self.try_circle(edge, (first, last), self.touch_two(first, last, wanted))
            if other == PLACED:
                return True
            if other == CLOSED:
                edge, moved = (self.next[first], first), True
                continue
            if other in (USELESS, first, last):
                break
            found = self.touch_three(first, last, other)
            if found is not None and max(wanted / found[1], found[1] / wanted) < NEARLY:
                if self.try_circle(edge, (first, last), found) in (PLACED, CLOSED):
                    return True
            if self.path(last, other):
                last = other
            elif self.path(other, first):
                first = other
            else:
                break
        return moved

    def path(self, a: int, b: int) -> list[int]:
        """The circles of the front from a to b; none for more than ``POCKET`` edges."""
        path = [a]
        while path[-1] != b and len(path) <= POCKET:
            path.append(self.next.get(path[-1], NIL))
        return path if path[-1] == b else []

    def try_circle(self, edge: Edge, support: Edge, new: Circle) -> int:
        """Place a circle if nothing is in the way. Returns PLACED, CLOSED, USELESS, or what is.

        edge: between the two circles of the support, seen from outside.
        """
        (a, b), (p, r) = support, new
        other = self.most_overlapped((self.prev[a], self.next[b], self.apex(*edge)), p, r)
        if other not in (NIL, a, b):
            return other
        cavity, other = self.look(edge, support, p, circle(r))
        if not cavity.rim:
            return other if other != NIL else USELESS
        other = self.most_overlapped(set(range(len(self.points))).difference(support), p, r)
        if other != NIL:
            return other
        base = a  # an edge of the front between a and b that the new circle sees
        while (self.next[base], base) not in cavity.rim:
            base = self.next[base]
            if base == b:
                return CLOSED if self.close_polygon(a, b) else USELESS
        v = self.place(base, self.next[base], cavity, p, circle(r))
        self.close_polygon(a, v)
        self.close_polygon(v, b)
        return PLACED

    def most_overlapped(self, circles: Iterable[int], p: complex, r: float) -> int:
        """The circle that one of radius r at p overlaps most, by d / (r1 + r2); or NIL (2.3.3)."""
        known = (v for v in circles if v != NIL)
        reached = ((length(self.points[v] - p) / (r + self.radius(v)), v) for v in known)
        return min([(1.0 - TOLERATED, NIL), *reached])[1]

    def close_polygon(self, a: int, b: int) -> bool:
        """Triangulate the polygon between the front from a to b and the edge a-b, ear by ear."""
        closed = False
        while len(path := self.path(a, b)) > 2:
            corners = zip(path, path[1:], path[2:])
            ear = next((c for c in corners if self.apex(c[1], c[0]) == c[2]), None)
            closed = ear is not None and self.close_corner(ear[0], ear[1])
            if not closed:
                break
        return closed
