"""Lines in (u, v) along which a formula surface is bent sharply: kinks of abs, max, min and sign.

A kink of abs(f) lies where f = 0, of max(f, g) where f - g = 0: the guides of the formula. Their
zero sets are cut where the lines of two guides meet; pieces between ends and meetings whose two
sides are alike are no kinks (max(u, v, 0) has none on u = v < 0).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import SurfaceError
from surfmesh.geometry.differential.infinite_speed import bent_axes_of
from surfmesh.geometry.formulas.kink_tracing import (
    GRID,
    MARGIN,
    NEWTON,
    Guides,
    KinkLine,
    traced_lines,
)
from surfmesh.geometry.formulas.parametric import ParametricSurface
from surfmesh.geometry.small_matrices import least_squares
from surfmesh.geometry.surface import Surface

_CORNERS = np.array([(i / 4.0, j / 4.0) for i in range(5) for j in range(5)])
STEP = 1e-6  # of the domain: how far beside a line the two sides are compared
BENT = 1e-5  # of the slopes: so much they differ at a kink
SHORTEST = 1e-9  # of the domain: pieces of lines, and distances that are round-off
TORN = 1e-6  # of the extent: what jumps by less is round-off
NEAR = 3.0  # cells: a meeting lies so near to where the lines were seen to cross


def kink_lines(surface: Surface) -> list[KinkLine]:
    """The kinks of a surface, cut where they meet; none where it has no formulas, or too many.

    Raises SurfaceError where the surface is torn: a step has no mesh.
    """
    if not isinstance(surface, ParametricSurface) or surface.loops:
        return []
    guides = Guides(surface)
    if not guides.count:
        return []
    pieces = _cut_at_meetings(guides, traced_lines(guides), NEAR * (1.0 / GRID))
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
    slope: NDArray[np.float64] | None = None
    for _ in range(NEWTON):
        g = np.array([guides.values(guide, found[None])[0] for guide in (one, two)])
        if not np.isfinite(g).all():
            return None
        here = g[:, 1:] * guides.width
        determinant = here[0, 0] * here[1, 1] - here[0, 1] * here[1, 0]
        if abs(determinant) > 1e-12 * np.prod(np.linalg.norm(here, axis=1)):
            slope = here  # else on a kink of a guide itself, as of ||u| - |v||: that beside it
        if slope is None:
            return None
        found = found - least_squares(slope, g[:, 0], 0.0) * guides.width
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
        if begin is not None and end is not None and _goes_round(guides, begin, run, end, near):
            continue
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


def _goes_round(guides: Guides, begin: NDArray, run: NDArray, end: NDArray, near: float) -> bool:
    """Is a piece the way between two crossings that are one meeting: three lines at a point?"""
    if np.abs((end - begin) / guides.width).max() > SHORTEST:
        return False
    return bool((np.abs((run - begin) / guides.width) <= near).all())


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
