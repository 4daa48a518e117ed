"""The boundary of a surface in (u, v): sides and trimming loops cut to unit metric length.

Step 1 of section 3: identify the segments. A side that coincides with another is cut once, and
its nodes appear twice in (u, v) under one number; the nodes of a side that is a single point
in 3D all have one number.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from itertools import pairwise

import numpy as np

from surfmesh.errors import SizingError, SurfaceError
from surfmesh.geometry.components import components
from surfmesh.geometry.differential.sides import SideTopology
from surfmesh.geometry.inside_loops import is_inside
from surfmesh.geometry.rings import ring_area
from surfmesh.geometry.surface import Surface
from surfmesh.sizing.field.size_field import SizeField

_WALK = (1, 1, -1, -1)
SAME_STOP = 1e-9
"""Of a side: stops so near to each other, or to a corner, are one."""

_CLOSED_SEGMENTS = 3
"""Fewest segments of a side that is a closed curve in 3D, fewer are not a polygon."""

RIM_ROUNDS, RIM_MARGIN, MANY_SEGMENTS = 8, 0.98, 64
"""How often a rim is cut anew; what is aimed at, as a fraction of ``chord``; from so many segments
those that sag too much are halved, rather than all made shorter."""

RIM_SAMPLES = (0.25, 0.5, 0.75)


@dataclass(frozen=True)
class BoundaryLoops:
    """Nodes and segments in (u, v), the inside on the left of every segment."""

    uv: np.ndarray
    """(k, 2) float, exact surface parameters of the nodes."""
    segments: np.ndarray
    """(s, 2) int32, pairs of nodes."""
    identity: np.ndarray
    """(k,) int64: the first node that is the same point in 3D, for most nodes itself."""
    inner: np.ndarray = field(default_factory=lambda: np.empty((0, 2), np.int32))
    """(j, 2) int32, pairs of nodes of segments within the domain: the surface is on both sides."""
    points: np.ndarray | None = None
    """(k, 3) where the nodes lie in space; None: on the surface. Edges of CAD models lie on their
    faces with some tolerance only."""

    @property
    def joined(self) -> int:
        """How many nodes are identified with others."""
        return len(self.identity) - len(np.unique(self.identity))


def boundary_loops(
    surface: Surface, sides: SideTopology, field: SizeField, stops: np.ndarray | None = None
) -> BoundaryLoops:
    """Cut the sides, or the trimming loops, to unit metric length.

    Without loops the sides of the (u, v) rectangle are the boundary. A loop within an odd
    number of others is a hole, in whichever direction it is given. stops: (j, 2) points on the
    sides of the rectangle that shall be nodes. Raises ``SurfaceError`` for
    a loop without area or outside the domain.
    """
    loops = [np.asarray(loop, float) for loop in surface.loops]
    for number, loop in enumerate(loops):
        _check_loop(surface, number, loop)
    parts: list[tuple[np.ndarray, np.ndarray]] = []
    if not loops:
        parts.append(_sides_loop(surface, sides, field, stops))
    for loop in loops:
        is_hole = is_inside([other for other in loops if other is not loop], loop[:1])[0]
        if (ring_area(loop) > 0.0) == is_hole:
            loop = loop[::-1]  # the inside is on the left of every segment
        uv = np.concatenate(
            [
                cut_rim(surface, field, start, end, minimum=1)[1][:-1]
                for start, end in zip(loop, np.roll(loop, -1, axis=0))
            ]
        )
        parts.append((uv, np.arange(len(uv))))
    segments, identity, first = [], [], 0
    for uv, same in parts:
        ring = first + np.arange(len(uv))
        segments.append(np.stack([ring, np.roll(ring, -1)], axis=1))
        identity.append(first + same)
        first += len(uv)
    return BoundaryLoops(
        np.concatenate([uv for uv, _ in parts]),
        np.concatenate(segments).astype(np.int32),
        np.concatenate(identity),
    )


def _check_loop(surface: Surface, number: int, loop: np.ndarray) -> None:
    low, high = np.array(surface.domain).T
    outside = ((loop < low) | (loop > high)).any(axis=1)
    if outside.any():
        u, v = loop[outside.argmax()]
        raise SurfaceError(
            f"loop {number} of {surface.name!r} leaves the (u, v) domain at ({u:g}, {v:g})"
        )
    if abs(ring_area(loop)) <= 1e-14 * np.prod(high - low):
        raise SurfaceError(f"loop {number} of {surface.name!r} encloses no area")


def _sides_loop(
    surface: Surface, sides: SideTopology, field: SizeField, stops: np.ndarray | None
) -> tuple[np.ndarray, np.ndarray]:
    """The rectangle walked counter-clockwise: uv (k, 2), identity (k,)."""
    along = _side_parameters(surface, sides, field, _stops_on_sides(sides, stops))
    uv, start = [], [0]
    for side in range(4):
        t = along[side][:: _WALK[side]][:-1]  # the next side brings the last corner
        uv.append(sides.points(side, t))
        start.append(start[-1] + len(t))
    total = start[-1]

    def node(side: int) -> np.ndarray:
        """Loop nodes of a side in the order of its rising parameter."""
        walked = (start[side] + np.arange(len(along[side]))) % total
        return walked[:: _WALK[side]]

    same: list[np.ndarray] = [np.empty((0, 2), np.int64)]
    for side in range(4):
        if sides.collapsed[side]:
            same.append(np.column_stack((node(side)[:-1], node(side)[1:])))
        elif sides.partner[side] > side:
            other = node(sides.partner[side])
            other = other[::-1] if sides.reversed[side] else other
            same.append(np.column_stack((node(side), other)))
    return np.concatenate(uv), components(total, np.concatenate(same)).astype(np.int64)


def _stops_on_sides(sides: SideTopology, stops: np.ndarray | None) -> list[np.ndarray]:
    """Rising parameters (n,) of each side at which nodes are wanted, ends left out."""
    found: list[np.ndarray] = [np.empty(0)] * 4
    if stops is None or not len(stops):
        return found
    low, high = np.array(sides.domain).T
    t = (stops - low) / (high - low)
    for side in range(4):
        along, fixed = (0, 1) if side in (0, 2) else (1, 0)
        there = np.abs(t[:, fixed] - (0.0, 1.0, 1.0, 0.0)[side]) <= SAME_STOP
        found[side] = t[there, along]
    own = list(found)
    for side, partner in enumerate(sides.partner):
        if partner >= 0:
            other = 1.0 - own[partner] if sides.reversed[side] else own[partner]
            found[side] = np.concatenate([own[side], other])
    for side in range(4):
        t = np.sort(found[side])
        t = t[(t > SAME_STOP) & (t < 1.0 - SAME_STOP)]
        found[side] = t[np.diff(t, prepend=-1.0) > SAME_STOP]
    return found


Cut = Callable[[np.ndarray, np.ndarray, int], tuple[np.ndarray, np.ndarray]]


def _through(
    cut: Cut, start: np.ndarray, end: np.ndarray, minimum: int, stops: np.ndarray
) -> np.ndarray:
    """What ``cut(start, end, minimum)`` gives for each part of a line between stops, put together.

    Returns t (n + 1,) from 0 to 1.
    """
    if not len(stops):
        return cut(start, end, minimum)[0]
    t = np.concatenate([[0.0], stops, [1.0]])
    parts = [np.zeros(1)]
    least = -(-minimum // (len(t) - 1))
    for a, b in pairwise(t):
        part = cut(start + a * (end - start), start + b * (end - start), least)[0]
        inner = a + (b - a) * part[1:]
        inner[-1] = b
        parts.append(inner)
    return np.concatenate(parts)


def _side_parameters(
    surface: Surface, sides: SideTopology, field: SizeField, stops: list[np.ndarray]
) -> list[np.ndarray]:
    """Rising parameters of the nodes of each side, both ends included."""
    along: list[np.ndarray] = []
    rim, line = partial(cut_rim, surface, field), partial(cut_line, field)
    for side in range(4):
        partner = sides.partner[side]
        if 0 <= partner < side:
            t = along[partner]
            along.append(1.0 - t[::-1] if sides.reversed[side] else t)
        else:
            start, end = sides.points(side, np.array([0.0, 1.0]))
            minimum = _CLOSED_SEGMENTS if partner >= 0 or _ends_meet(sides, side) else 1
            if partner < 0 and not sides.collapsed[side]:
                along.append(_through(rim, start, end, minimum, stops[side]))
            else:
                along.append(_through(line, start, end, minimum, stops[side]))
    return along


def _ends_meet(sides: SideTopology, side: int) -> bool:
    """Are the two ends of a side one point, because the neighbouring sides are joined?"""
    before, after = (side - 1) % 4, (side + 1) % 4
    return sides.partner[before] == after


def cut_line(
    field: SizeField, start: np.ndarray, end: np.ndarray, minimum: int
) -> tuple[np.ndarray, np.ndarray]:
    """Cut a straight line of (u, v) into segments of equal metric length near 1.

    Returns t (n + 1,) from 0 to 1 and uv (n + 1, 2), whose ends are exact.
    """
    samples = 64
    while True:
        t = np.linspace(0.0, 1.0, samples + 1)
        xy = field.chart.to_plane(start + t[:, None] * (end - start))
        step = field.metric_lengths(0.5 * (xy[1:] + xy[:-1]), xy[1:] - xy[:-1])
        metric = np.zeros(samples + 1)
        np.cumsum(step, out=metric[1:])
        if not metric[-1] <= field.sizing.limit:
            raise SizingError(
                f"about {metric[-1]:.3g} edges are asked for along one side, more than the limit "
                f"of {field.sizing.limit:,} triangles: ask for larger sizes there, or raise limit"
            )
        if samples >= 16 * metric[-1] or samples >= 1 << 22:
            break
        samples = 1 << int(np.ceil(np.log2(min(20 * metric[-1], 1 << 22))))
    segments = max(minimum, round(metric[-1]))
    if metric[-1] > 0.0:
        t = np.interp(np.linspace(0.0, metric[-1], segments + 1), metric, t)
    else:
        t = np.linspace(0.0, 1.0, segments + 1)
    t[0], t[-1] = 0.0, 1.0
    uv = start + t[:, None] * (end - start)
    uv[-1] = end
    return t, uv


def cut_rim(
    surface: Surface, field: SizeField, start: np.ndarray, end: np.ndarray, minimum: int
) -> tuple[np.ndarray, np.ndarray]:
    """Like ``cut_line``, with more segments while one sags by more than ``chord``.

    A few segments may be half as long again as wanted, and between samples a rim may bend more.
    None becomes shorter than about ``min_size``.
    """
    t, uv = cut_line(field, start, end, minimum)
    chord = field.sizing.straight_chord
    if chord is None:
        return t, uv
    least = field.sizing.min_size or 0.0
    for _ in range(RIM_ROUNDS):
        sag, length = _sags(surface, uv)
        far = (sag > RIM_MARGIN * chord) & (length > max(1.4 * least, chord))
        if not far.any():
            break
        if 4 * np.count_nonzero(far) > len(far) and len(far) < MANY_SEGMENTS:
            factor = np.sqrt(sag[far].max() / (RIM_MARGIN * chord))
            t, uv = cut_line(field, start, end, int(np.ceil(min(factor, 2.0) * len(far))))
        else:
            t = np.sort(np.concatenate([t, 0.5 * (t[1:] + t[:-1])[far]]))
            uv = start + t[:, None] * (end - start)
            uv[-1] = end
    return t, uv


def _sags(surface: Surface, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Largest distance (n,) of a line in (u, v) from its chord between nodes uv (n + 1, 2), and
    the length (n,) of the chord."""
    (ends,) = surface.evaluate(uv, 0)
    chords = np.diff(ends, axis=0)
    length = np.linalg.norm(chords, axis=1)
    squared = np.maximum(length**2, np.finfo(float).tiny)
    sag = np.zeros(len(length))
    for t in RIM_SAMPLES:
        (point,) = surface.evaluate(uv[:-1] + t * np.diff(uv, axis=0), 0)
        way = point - ends[:-1]
        along = np.clip(np.einsum("ij,ij->i", way, chords) / squared, 0.0, 1.0)
        sag = np.fmax(sag, np.linalg.norm(way - along[:, None] * chords, axis=1))
    return sag, length
