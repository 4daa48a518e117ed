"""Points, size tensors, and what is measured with them: length, shape, orientation.

A point, or a step between two, is a complex number x + iy. A size tensor H is symmetric and
positive definite; the circle of a vertex p is the ellipse |H^-1 (x - p)| <= 1/2. For a circle of
radius r H = 2 r Id, and all that follows is what the paper has.
"""

import math
from fractions import Fraction
from typing import NamedTuple


class SizeTensor(NamedTuple):
    """H = ((xx, xy), (xy, yy)), in units of the plane."""

    xx: float
    xy: float
    yy: float

    def times(self, step: complex) -> complex:
        """H step: from wanted lengths to the plane."""
        x, y = step.real, step.imag
        return complex(self.xx * x + self.xy * y, self.xy * x + self.yy * y)

    def solve(self, step: complex) -> complex:
        """H^-1 step: from the plane to wanted lengths."""
        x, y, det = step.real, step.imag, self.xx * self.yy - self.xy * self.xy
        return complex((self.yy * x - self.xy * y) / det, (self.xx * y - self.xy * x) / det)


def circle(radius: float) -> SizeTensor:
    return SizeTensor(2.0 * radius, 0.0, 2.0 * radius)


def mean(*tensors: SizeTensor) -> SizeTensor:
    return SizeTensor(*(sum(numbers) / len(tensors) for numbers in zip(*tensors)))


def dot(u: complex, v: complex) -> float:
    return u.real * v.real + u.imag * v.imag


def cross(u: complex, v: complex) -> float:
    return u.real * v.imag - u.imag * v.real


def length(step: complex) -> float:
    return math.sqrt(dot(step, step))


def shape(u: complex, v: complex) -> float:
    """alpha = 4 sqrt(3) area / (sum of squared edges) of the triangle with edges u and v (4)."""
    total = dot(u, u) + dot(v, v) + dot(u - v, u - v)
    return 2.0 * math.sqrt(3.0) * cross(u, v) / total if total > 0.0 else 0.0


def orient(a: complex, b: complex, c: complex) -> Fraction:
    """Twice the signed area of abc, exactly: > 0 for counter-clockwise."""
    (ax, ay), (bx, by), (cx, cy) = ((Fraction(p.real), Fraction(p.imag)) for p in (a, b, c))
    return (ax - cx) * (by - cy) - (ay - cy) * (bx - cx)


def common_step(g: complex, r: float, h: complex, s: float, least: float) -> complex | None:
    """The step d with g.d = r and h.d = s; None where g and h are all but parallel."""
    det = cross(g, h)
    if abs(det) < least * (abs(g.real * h.imag) + abs(g.imag * h.real)) or det == 0.0:
        return None
    return complex((h.imag * r - g.imag * s) / det, (g.real * s - h.real * r) / det)
