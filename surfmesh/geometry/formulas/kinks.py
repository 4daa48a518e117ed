"""Lines in (u, v) along which a formula surface is bent sharply: kinks of abs, max, min and sign.

A kink of abs(f) lies where f = 0, of max(f, g) where f - g = 0: the guides of the formula. Their
zero sets are traced on a grid, crossing by crossing,

        +-----o-----+          o  a zero on an edge of the grid, exact
        |  + / -    |          J  where the lines of two guides meet: both are zero there
        +---o-------+
        |  J--------o          pieces between ends and meetings whose two sides are alike are no
        +-----------+          kinks (max(u, v, 0) has none on u = v < 0)

Cells without a change of sign, whose interval bounds admit a zero, are looked into; lines nearer
to each other than the grid get lines of the grid of their own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import SurfaceError
from surfmesh.geometry.differential.infinite_speed import bent_axes_of
from surfmesh.geometry.formulas.parametric import ParametricSurface
from surfmesh.geometry.formulas.tape import Tape
from surfmesh.geometry.surface import Surface

GRID = 96  # cells each way
MARGIN = 1e-9  # of the domain: how far inside its sides signs are read
HALVINGS = 60  # of an edge of the grid, for a zero on it
LOOKS, DEPTH = 64, 14  # cells without a change of sign that are looked into, and how deep
MOST_LINES = 96  # of the grid, more than GRID
MOST_POINTS = 40_000  # of all lines together: more are not followed
STEP = 1e-6  # of the domain: how far beside a line the two sides are compared
BENT = 1e-5  # of the slopes: so much they differ at a kink
SHORTEST = 1e-9  # of the domain: pieces of lines, and distances that are round-off
TORN = 1e-6  # of the extent: what jumps by less is round-off
_CORNERS = np.array([(i / 4.0, j / 4.0) for i in range(5) for j in range(5)])
NEWTON = 12
NEAR = 3.0  # cells: a meeting lies so near to where the lines were seen to cross


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


def kink_lines(surface: Surface) -> list[KinkLine]:
    """The kinks of a surface, cut where they meet; none where it has no formulas, or too many.

    Raises SurfaceError where the surface is torn: a step has no mesh.
    """
    if not isinstance(surface, ParametricSurface) or surface.loops:
        return []
    guides = Guides(surface)
    if not guides.count:
        return []
    u, v = _grid_lines(guides)
    lines: list[KinkLine] = []
    for guide in range(guides.count):
        for points, closed in _traced(guides, guide, u, v):
            if not _known(guides, guide, points):
                lines.append(KinkLine(points, guide, closed))
        if sum(len(line.uv) for line in lines) > MOST_POINTS:
            return []
    cell = max(1.0 / GRID, 1e-12)
    pieces = _cut_at_meetings(guides, lines, NEAR * cell)
    kept: list[KinkLine] = []
    for piece in pieces:
        _refuse_jump(guides, piece)
        followed = _is_bent(guides, piece) or _is_too_fast(guides, piece)
        if _is_long(guides, piece) and followed:
            if not _is_there(guides, piece, kept):
                kept.append(piece)
    return kept


def _is_too_fast(guides: Guides, line: KinkLine) -> bool:
    """Does it run along a u or a v at which the speed has no bound? No triangle lies across it."""
    for column, axis in enumerate(bent_axes_of(guides.surface)):
        if axis is not None:
            places = axis.places[1:-1]
            apart = np.abs(line.uv[:, column, None] - places) / guides.width[column]
            if (apart.max(axis=0) <= SHORTEST).any():
                return True
    return False


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


def _is_long(guides: Guides, line: KinkLine) -> bool:
    return bool(np.abs(np.ptp(line.uv, axis=0) / guides.width).max() > SHORTEST)


def _is_there(guides: Guides, line: KinkLine, others: list[KinkLine]) -> bool:
    """Is there a piece of another guide already between the same ends?"""
    ends = line.uv[[0, -1]]
    middle = guides.on_line(line.guide, line.uv[len(line.uv) // 2][None], 1.0)
    for other in others:
        for theirs in (other.uv[[0, -1]], other.uv[[-1, 0]]):
            if np.abs((theirs - ends) / guides.width).max() < SHORTEST:
                g = np.abs(guides.values(other.guide, middle)[0])
                if g[0] <= SHORTEST * (g[1:] * guides.width).sum():
                    return True
    return False


def _cut_at_meetings(guides: Guides, lines: list[KinkLine], near: float) -> list[KinkLine]:
    """The lines with their meetings as points, cut there; ends on a side lie on it exactly."""
    cuts: list[list[tuple[int, float, NDArray]]] = [[] for _ in lines]
    for one in range(len(lines)):
        for two in range(one):
            for i, s, j, t, place in _crossings(lines[one].uv, lines[two].uv, guides.width):
                both = _meeting(guides, lines[one].guide, lines[two].guide, place, near)
                if both is not None:
                    cuts[one].append((i, s, both))
                    cuts[two].append((j, t, both))
    pieces = []
    for line, own in zip(lines, cuts):
        pieces += _pieces(guides, line, sorted(own, key=lambda cut: cut[:2]), near)
    return pieces


def _crossings(a: NDArray, b: NDArray, width: NDArray) -> list[tuple]:
    """(i, s, j, t, place) where segment i of ``a`` crosses segment j of ``b``."""
    p, r = a[:-1] / width, np.diff(a, axis=0) / width
    q, w = b[:-1] / width, np.diff(b, axis=0) / width
    found = []
    for i in range(len(p)):
        cross = r[i, 0] * w[:, 1] - r[i, 1] * w[:, 0]
        between = q - p[i]
        with np.errstate(divide="ignore", invalid="ignore"):
            s = (between[:, 0] * w[:, 1] - between[:, 1] * w[:, 0]) / cross
            t = (between[:, 0] * r[i, 1] - between[:, 1] * r[i, 0]) / cross
        for j in np.flatnonzero((s >= 0.0) & (s < 1.0) & (t >= 0.0) & (t < 1.0)):
            found.append((i, float(s[j]), int(j), float(t[j]), a[i] + s[j] * (a[i + 1] - a[i])))
    return found


def _meeting(
    guides: Guides, one: int, two: int, place: NDArray, near: float
) -> NDArray[np.float64] | None:
    """The point (2,) where both guides are zero, by Newton's method from ``place``."""
    found = place.copy()
    for _ in range(NEWTON):
        g = np.array([guides.values(guide, found[None])[0] for guide in (one, two)])
        slope = g[:, 1:] * guides.width
        if not np.isfinite(g).all():
            return None
        determinant = slope[0, 0] * slope[1, 1] - slope[0, 1] * slope[1, 0]
        if not abs(determinant) > 1e-12 * np.prod(np.linalg.norm(slope, axis=1)):
            return None
        found = found - np.linalg.solve(slope, g[:, 0]) * guides.width
        found = np.clip(found, guides.lo, guides.hi)
    apart = np.abs((found - place) / guides.width).max()
    return found if apart <= near else None


def _pieces(guides: Guides, line: KinkLine, cuts: list, near: float) -> list[KinkLine]:
    uv, closed = line.uv.copy(), line.closed
    if not closed:
        for end in (0, -1):
            uv[end] = _onto_side(guides, line.guide, uv[end])
    if not cuts:
        return [KinkLine(uv, line.guide, closed)]
    stops: list[NDArray] = [place for _, _, place in cuts]
    runs, first, lead = [], 0, None
    for i, _, place in cuts:
        run = uv[first : i + 1]
        runs.append((lead, run, place))
        first, lead = i + 1, place
    last = (lead, uv[first:], None)
    if closed:  # the last run goes on into the first
        tail = np.concatenate([last[1][:-1], runs[0][1]])
        runs[0] = (lead, tail, runs[0][2])
    else:
        runs.append(last)
    made = []
    for begin, run, end in runs:
        inner = run
        for stop in stops:  # what lies beside a meeting may lie on the wrong side of it
            apart = np.abs((inner - stop) / guides.width).max(axis=1)
            ends_there = begin is stop or end is stop
            inner = inner[apart > (0.5 * near / NEAR if ends_there else 1e-12)]
        parts = [*([begin[None]] if begin is not None else []), inner,
                 *([end[None]] if end is not None else [])]  # fmt: skip
        points = np.concatenate(parts)
        if begin is None and len(inner) and (inner[0] != run[0]).any():
            points = np.concatenate([run[:1], points])
        if end is None and len(inner) and (inner[-1] != run[-1]).any():
            points = np.concatenate([points, run[-1:]])
        if len(points) > 1:
            made.append(KinkLine(points, line.guide, False))
    return made


def _onto_side(guides: Guides, guide: int, end: NDArray) -> NDArray[np.float64]:
    """An end that lies ``MARGIN`` from a side, moved onto it along the line."""
    fraction = (end - guides.lo) / guides.width
    gap = np.minimum(fraction, 1.0 - fraction)
    axis = int(gap.argmin())
    if gap[axis] > 2.0 * MARGIN:
        return end
    place = end.copy()
    place[axis] = guides.lo[axis] if fraction[axis] < 0.5 else guides.hi[axis]
    for _ in range(NEWTON):
        g = guides.values(guide, place[None])[0]
        slope = g[2 - axis]
        if slope == 0.0 or not np.isfinite(g).all():
            break
        place[1 - axis] = np.clip(
            place[1 - axis] - g[0] / slope, guides.lo[1 - axis], guides.hi[1 - axis]
        )
    apart = abs(place[1 - axis] - end[1 - axis]) / guides.width[1 - axis]
    if apart > 1e-6:
        place[1 - axis] = end[1 - axis]
    return place


def _beside(guides: Guides, line: KinkLine, step: float) -> list[NDArray[np.float64]]:
    """Places (n, 2) on both sides of the middle of a line, at ``step`` of the domain from it."""
    if len(line.uv) > 2:
        middle = line.uv[1:-1]
    else:
        middle = guides.on_line(line.guide, line.uv.mean(axis=0)[None], 1.0)
    with np.errstate(all="ignore"):
        g = np.nan_to_num(guides.values(line.guide, middle)[:, 1:] * guides.width)
    across = g / np.maximum(np.abs(g).max(axis=1), 1e-300)[:, None]
    return [
        np.clip(middle + sign * step * across * guides.width, guides.lo, guides.hi)
        for sign in (1.0, -1.0)
    ]


def _refuse_jump(guides: Guides, line: KinkLine) -> None:
    """Raise SurfaceError where the two sides of a line do not come together in space."""
    (r,) = guides.surface.evaluate(guides.lo + _CORNERS * guides.width, 0)
    apart = []
    for step in (STEP, 1e-2 * STEP):
        first, second = (guides.surface.evaluate(p, 0)[0] for p in _beside(guides, line, step))
        apart.append(np.linalg.norm(first - second, axis=1))
    size = float(np.ptp(np.concatenate([r, first, second]), axis=0).max())
    torn = (apart[1] > 0.7 * apart[0]) & (apart[1] > TORN * size)
    if np.mean(torn) <= 0.5:
        return
    worst = int(np.argmax(np.where(torn, apart[1], 0.0)))
    u, v = _beside(guides, line, 0.0)[0][worst]
    raise SurfaceError(
        f"{guides.surface.name!r} jumps by {apart[1][worst]:.4g} along a line through (u, v) = "
        f"({u:.6g}, {v:.6g}): a step has no mesh; end the domain there, or make it a steep slope"
    )


def _is_bent(guides: Guides, line: KinkLine) -> bool:
    """Do the slopes of the surface differ on the two sides of a line, in its middle?"""
    sides = []
    for place in _beside(guides, line, STEP):
        slopes = guides.surface.evaluate(place, 1)[1:]
        sides.append(np.hstack([slope * w for slope, w in zip(slopes, guides.width)]))
    difference = np.linalg.norm(sides[0] - sides[1], axis=1)
    size = np.linalg.norm(sides[0], axis=1) + np.linalg.norm(sides[1], axis=1)
    return bool(np.mean(difference > BENT * size) > 0.5)
