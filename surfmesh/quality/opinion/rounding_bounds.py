"""How far two computations of one figure can lie apart by rounding alone.

Bounds to first order in the unit of rounding, for any order of the sums (Higham, Accuracy and
Stability of Numerical Algorithms, 2002, sections 3.1 and 4.2): m terms add up with an error below
m eps times the sum of their absolute values. Points are those of ``placed``: both sides work on
the very same differences of coordinates.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

EPS = float(np.finfo(float).eps)
ALPHA = 40.0 * EPS
"""Of alpha = 2 sqrt(3) |u x v| / sum of squared edges, on two sides: |u x v| is off by up to
8 eps |u| |v|, and |u| |v| is at most half of that sum."""
_COSINE = 32.0 * EPS  # of an angle: times longest over shortest side, see ``angle_bounds``
_TERM = 64.0 * EPS  # of a signed tetrahedron: six products of three coordinates, on two sides
_HERON = 12.0 * EPS  # of s (s - a) (s - b) (s - c), times s^4
_BLOCK = 1 << 16  # triangles looked at together, to bound the memory

_TINY = float(np.finfo(float).tiny)


class Placed(NamedTuple):
    """A mesh near the origin and of about unit size; no triangle has changed its shape."""

    points: NDArray[np.float64]  # (n, 3) = (points of the mesh - shift) / 2**exponent
    triangles: NDArray[np.int32]  # (m, 3)
    exponent: int


class Bounds(NamedTuple):
    """Of the placed mesh."""

    area: float
    volume: float
    heron: float  # to add for volumes whose areas follow from the lengths of sides alone
    cosine: NDArray[np.float64]  # (m,) of the cosines of angles


def no_bounds(count: int) -> Bounds:
    """Of a mesh of ``count`` triangles whose lengths are not looked at."""
    return Bounds(0.0, 0.0, 0.0, np.zeros(count))


def placed(points: NDArray[np.float64], triangles: NDArray[np.int32]) -> Placed:
    """Moved where that rounds nothing, and scaled by a power of two.

    Along an axis where largest <= 2 * smallest coordinate, the differences from the smallest
    are exact (Sterbenz' lemma); elsewhere coordinates are below twice the extent as they are.
    """
    used = np.zeros(len(points), bool)
    used[triangles] = True
    low, high = points[used].min(axis=0), points[used].max(axis=0)
    nearest = np.where(low > 0.0, low, np.where(high < 0.0, high, 0.0))
    farthest = np.maximum(np.abs(low), np.abs(high))
    shift = np.where(farthest <= 2.0 * np.abs(nearest), nearest, 0.0)
    moved = points - shift
    _, exponent = np.frexp(np.abs(moved[used]).max())
    return Placed(np.ldexp(moved, -int(exponent)), triangles, int(exponent))


def bounds(mesh: Placed) -> Bounds:
    """For areas and volumes in any order of summation, and for angles of each triangle."""
    count = len(mesh.triangles)
    used = np.zeros(len(mesh.points), bool)
    used[mesh.triangles] = True
    reach = np.abs(mesh.points[used]).max(axis=0)  # (3,)
    total = crossed = squared = heron = 0.0
    cosine = np.empty(count)
    for start in range(0, count, _BLOCK):
        a, b, c = (mesh.points[corner] for corner in mesh.triangles[start:][:_BLOCK].T)
        u, v = b - a, c - a
        cross = np.abs(np.cross(u, v))
        area = 0.5 * np.sqrt((cross * cross).sum(axis=1))
        sides = np.sqrt(np.stack([(d * d).sum(axis=1) for d in (u, v, v - u)]))
        term = cross @ reach  # at least three times the tetrahedron to any point within reach
        total += float(area.sum())
        crossed += float(term.sum())
        squared += float((sides * sides).sum())
        heron += float((_heron(sides, area) * term / np.maximum(2.0 * area, _TINY)).sum())
        shortest, longest = sides.min(axis=0), sides.max(axis=0)
        cosine[start : start + _BLOCK] = _COSINE * longest / np.maximum(shortest, _TINY)
    return Bounds(
        area=EPS * (count * total + 4.0 * squared),
        volume=count * (EPS * crossed + _TERM * float(reach.prod())),
        heron=heron,
        cosine=np.minimum(cosine, 2.0),
    )


def _heron(sides: NDArray[np.float64], area: NDArray[np.float64]) -> NDArray[np.float64]:
    """(m,) error of an area by Heron's formula: the half sums less a side cancel in slivers."""
    half = 0.5 * sides.sum(axis=0)
    error = _HERON * half**4  # of the squared area
    return np.minimum(np.sqrt(error), error / np.maximum(area, _TINY))


def angle_bounds(degrees: NDArray[np.float64], cosine: NDArray[np.float64]) -> NDArray[np.float64]:
    """Degrees (m,) that angles may be off when their cosines are off by so much.

    An arc cosine loses half the digits near 0 and 180 degrees. The largest angle is known to
    eps times longest over shortest side: of two long sides that are equal to rounding, either
    may be taken for the longest.
    """
    at = np.cos(np.radians(degrees))
    lower, upper = (np.clip(at + step, -1.0, 1.0) for step in (-cosine, cosine))
    return np.degrees(np.arccos(lower) - np.arccos(upper))
