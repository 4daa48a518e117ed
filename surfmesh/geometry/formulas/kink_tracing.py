"""Where the guides of a formula are zero: lines in (u, v), traced on a grid, crossing by crossing.

        +-----o-----+          o  a zero on an edge of the grid, exact
        |  + / -    |
        +---o-------+

Cells without a change of sign, whose interval bounds admit a zero, are looked into; lines nearer
to each other than the grid get lines of the grid of their own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.formulas.parametric import ParametricSurface
from surfmesh.geometry.formulas.tape import Tape

GRID = 96  # cells each way
MARGIN = 1e-9  # of the domain: how far inside its sides signs are read
HALVINGS = 60  # of an edge of the grid, for a zero on it
LOOKS, DEPTH = 64, 14  # cells without a change of sign that are looked into, and how deep
MOST_LINES = 96  # of the grid, more than GRID
MOST_POINTS = 40_000  # of all lines together: more are not followed
NEWTON = 12


@dataclass(frozen=True)
class KinkLine:
    """A piece of one kink line."""

    uv: NDArray[np.float64]  # (k, 2) points on it, in order, both ends included
    guide: int  # row of ``Guides``
    closed: bool  # the last point is the first


class Guides:
    """The functions whose zeros are the kinks, with their derivatives."""

    def __init__(self, surface: ParametricSurface) -> None:
        self.surface = surface
        tape = surface.guides()
        self.tape = Tape(2, (), (), 0, ()) if tape is None else tape  # without kinks: of nothing
        self.count = len(self.tape.outputs) // 3
        self.lo, self.hi = np.array(surface.domain, float).T
        self.width = self.hi - self.lo

    def values(self, guide: int, uv: NDArray) -> NDArray[np.float64]:
        """(n, 3): g, dg/du, dg/dv at uv (n, 2)."""
        return self.tape.evaluate(uv)[guide]

    def on_line(self, guide: int, uv: NDArray, within: float) -> NDArray[np.float64]:
        """Points (n, 2) moved onto the zeros of a guide, by no more than ``within`` of the domain.

        Where that fails the points are as they were.
        """
        found = uv.copy()
        for _ in range(NEWTON):
            with np.errstate(all="ignore"):  # whatever is not finite moves nothing
                g, g_u, g_v = (self.values(guide, found) * [1.0, *self.width]).T
                step = np.stack([g_u, g_v], axis=1) * (g / (g_u**2 + g_v**2))[:, None]
            found = found - np.nan_to_num(step, posinf=0.0, neginf=0.0) * self.width
            found = np.clip(found, self.lo, self.hi)
        far = np.abs((found - uv) / self.width).max(axis=1) > within
        found[far] = uv[far]
        return found


def traced_lines(guides: Guides) -> list[KinkLine]:
    """The zeros of all guides, those that several have once; none where there are too many."""
    u, v = _grid_lines(guides)
    lines: list[KinkLine] = []
    for guide in range(guides.count):
        for points, closed in _traced(guides, guide, u, v):
            if not _known(guides, guide, points):
                lines.append(KinkLine(points, guide, closed))
        if sum(len(line.uv) for line in lines) > MOST_POINTS:
            return []
    return lines


def _grid_lines(guides: Guides) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Fractions 0 to 1 of the domain along u and along v; uneven, so that no line lies on one."""
    inner = np.arange(1, GRID)
    golden = 0.5 * (np.sqrt(5.0) - 1.0)
    even = (inner + 0.4 * ((inner * golden) % 1.0 - 0.5)) / GRID
    fraction = np.concatenate([[MARGIN], even, [1.0 - MARGIN]])
    more: tuple[list[float], list[float]] = ([], [])
    lo = np.stack(np.meshgrid(fraction[:-1], fraction[:-1], indexing="ij"), -1).reshape(-1, 2)
    hi = np.stack(np.meshgrid(fraction[1:], fraction[1:], indexing="ij"), -1).reshape(-1, 2)
    for guide in range(guides.count):
        suspects = _may_vanish(guides, guide, lo, hi)
        suspects = suspects[~_changes_sign(guides, guide, lo[suspects], hi[suspects])]
        if len(suspects) > LOOKS:
            suspects = suspects[np.linspace(0, len(suspects) - 1, LOOKS).astype(int)]
        for place in _other_side(guides, guide, lo[suspects], hi[suspects]):
            for axis in (0, 1):
                if all(abs(place[axis] - x) > 1e-9 for x in more[axis]):
                    more[axis].append(place[axis])
    u, v = (np.unique(np.concatenate([fraction, extra[:MOST_LINES]])) for extra in more)
    return u, v


def _may_vanish(guides: Guides, guide: int, lo: NDArray, hi: NDArray) -> NDArray[np.int64]:
    lower, upper = guides.tape.bounds(guides.lo + lo * guides.width, guides.lo + hi * guides.width)
    return np.flatnonzero((lower[:, 3 * guide] < 0.0) & (upper[:, 3 * guide] > 0.0))


def _corners(lo: NDArray, hi: NDArray) -> NDArray[np.float64]:
    """(n, 5, 2) the corners of cells and their middles."""
    a, b = lo, hi
    mixed = np.stack([a[:, 0], b[:, 1]], 1), np.stack([b[:, 0], a[:, 1]], 1)
    return np.stack([a, b, *mixed, 0.5 * (a + b)], axis=1)


def _changes_sign(guides: Guides, guide: int, lo: NDArray, hi: NDArray) -> NDArray[np.bool_]:
    places = _corners(lo, hi)[:, :4]
    g = guides.values(guide, guides.lo + places.reshape(-1, 2) * guides.width)[:, 0]
    positive = (g > 0.0).reshape(-1, 4)
    return np.logical_and(positive.any(axis=1), ~positive.all(axis=1))


def _other_side(guides: Guides, guide: int, lo: NDArray, hi: NDArray) -> list[NDArray]:
    """Places within cells of one sign where the guide has the other sign; one for each cell."""
    found: list[NDArray] = []
    if not len(lo):
        return found
    first = guides.values(guide, guides.lo + lo * guides.width)[:, 0] > 0.0
    cell = np.arange(len(lo))
    done = np.zeros(len(lo), bool)
    for _ in range(DEPTH):
        places = _corners(lo, hi)
        g = guides.values(guide, guides.lo + places.reshape(-1, 2) * guides.width)[:, 0]
        other = ((g > 0.0).reshape(-1, 5) != first[cell, None]) & (g != 0.0).reshape(-1, 5)
        for row in np.flatnonzero(other.any(axis=1)):
            if not done[cell[row]]:
                done[cell[row]] = True
                found.append(places[row, int(other[row].argmax())])
        keep = ~done[cell]
        lo, hi, cell = lo[keep], hi[keep], cell[keep]
        middle = 0.5 * (lo + hi)
        quarters = []
        for i in (0, 1):
            for j in (0, 1):
                corner = np.stack([(lo, middle)[i][:, 0], (lo, middle)[j][:, 1]], 1)
                quarters.append((corner, corner + 0.5 * (hi - lo)))
        lo, hi = (np.concatenate([q[k] for q in quarters]) for k in (0, 1))
        cell = np.tile(cell, 4)
        may = _may_vanish(guides, guide, lo, hi)[: 16 * LOOKS]
        lo, hi, cell = lo[may], hi[may], cell[may]
        if not len(lo):
            break
    return found


def _traced(
    guides: Guides, guide: int, u: NDArray, v: NDArray
) -> list[tuple[NDArray[np.float64], bool]]:
    """Chains (k, 2) of zeros of one guide, with whether they are closed."""
    grid = np.stack(np.meshgrid(u, v, indexing="ij"), -1)
    g = guides.values(guide, guides.lo + grid.reshape(-1, 2) * guides.width)[:, 0]
    positive = (g > 0.0).reshape(len(u), len(v))
    number = np.full((2, len(u), len(v)), -1)  # of the zero on the edge onwards along u, along v
    across_u = np.argwhere(positive[1:] != positive[:-1])
    across_v = np.argwhere(positive[:, 1:] != positive[:, :-1])
    number[0][tuple(across_u.T)] = np.arange(len(across_u))
    number[1][tuple(across_v.T)] = len(across_u) + np.arange(len(across_v))
    if len(across_u) + len(across_v) > MOST_POINTS or not len(across_u) + len(across_v):
        return []
    ends = [(grid[i, j], grid[i + 1, j]) for i, j in across_u]
    ends += [(grid[i, j], grid[i, j + 1]) for i, j in across_v]
    zero = _zeros(guides, guide, np.array(ends))
    return _chains(_links(number, positive), zero)


def _zeros(guides: Guides, guide: int, ends: NDArray) -> NDArray[np.float64]:
    """Zeros (n, 2) in (u, v) between the two ends (n, 2, 2), which differ in sign."""
    first, last = (guides.lo + ends[:, k] * guides.width for k in (0, 1))
    positive = guides.values(guide, first)[:, 0] > 0.0
    for _ in range(HALVINGS):
        middle = 0.5 * (first + last)
        same = (guides.values(guide, middle)[:, 0] > 0.0) == positive
        first, last = np.where(same[:, None], middle, first), np.where(same[:, None], last, middle)
    return 0.5 * (first + last)


def _links(number: NDArray, positive: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Pairs (n, 2) of zeros that follow each other through a cell."""
    below, above = number[0][:-1, :-1], number[0][:-1, 1:]
    left, right = number[1][:-1, :-1], number[1][1:, :-1]
    sides = np.stack([below, right, above, left], axis=-1).reshape(-1, 4)
    count = (sides >= 0).sum(axis=1)
    two = sides[count == 2]
    pairs = [np.sort(two, axis=1)[:, 2:]]
    four = np.flatnonzero(count == 4)  # a saddle: either way is right, the lines nearly cross
    pairs += [sides[four][:, [0, 1]], sides[four][:, [2, 3]]]
    return np.concatenate(pairs).astype(np.int64)


def _chains(links: NDArray, zero: NDArray) -> list[tuple[NDArray[np.float64], bool]]:
    """Zeros (n, 2) in the order in which they are linked."""
    beside: list[list[int]] = [[] for _ in range(len(zero))]
    for a, b in links.tolist():
        beside[a].append(b)
        beside[b].append(a)
    seen = np.zeros(len(zero), bool)
    chains = []
    ends = [k for k in range(len(zero)) if len(beside[k]) == 1]
    for start in [*ends, *range(len(zero))]:
        if seen[start] or not beside[start]:
            continue
        chain, place = [start], start
        seen[start] = True
        while onward := [k for k in beside[place] if not seen[k]]:
            place = onward[0]
            seen[place] = True
            chain.append(place)
        closed = len(chain) > 2 and start in beside[place]
        chains.append((zero[[*chain, start] if closed else chain], closed))
    return [(points, closed) for points, closed in chains if len(points) > 1]


def _known(guides: Guides, guide: int, points: NDArray) -> bool:
    """Is the line one of an earlier guide too?"""
    for earlier in range(guide):
        moved = guides.on_line(earlier, points, 1.0)
        apart = np.abs((moved - points) / guides.width).max(axis=1)
        g = np.abs(guides.values(earlier, points))
        slope = (g[:, 1:] * guides.width).sum(axis=1)
        if (apart < 1e-9).all() and (g[:, 0] <= 1e-9 * slope).all():
            return True
    return False
