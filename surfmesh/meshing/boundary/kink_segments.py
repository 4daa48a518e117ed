"""Kink lines of a surface cut to metric length: segments that the mesh follows within."""

from dataclasses import replace
from itertools import pairwise

import numpy as np

from surfmesh.geometry.formulas.kink_tracing import Guides, KinkLine
from surfmesh.geometry.formulas.parametric import ParametricSurface
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.boundary.boundary_loops import BoundaryLoops
from surfmesh.sizing.field.size_field import SizeField

SAG = 0.5
"""Of ``chord``: how far a segment may lie from the kink, in its middle."""

DOUBLINGS = 8
"""Of the number of segments of one line, until they sag no more."""

SAMPLED = 4.0
"""Samples for each metric length."""

SAME = 1e-9
"""Of the domain: ends of lines so near to each other are one node."""

CLOSED_SEGMENTS = 3
"""Of a line that returns to its start, at least."""

_NONE = np.empty((0, 2))


def sides_met(surface: Surface, lines: list[KinkLine]) -> np.ndarray:
    """(j, 2) ends of kink lines that lie on the sides of the (u, v) rectangle."""
    ends = np.concatenate([line.uv[[0, -1]] for line in lines if not line.closed] or [_NONE])
    low, high = np.array(surface.domain).T
    t = (ends - low) / (high - low)
    return ends[(np.minimum(t, 1.0 - t) <= SAME).any(axis=1)]


def with_kinks(
    loops: BoundaryLoops, surface: ParametricSurface, lines: list[KinkLine], field: SizeField
) -> BoundaryLoops:
    """The boundary, with segments along kink lines that begin and end at nodes of it."""
    guides = Guides(surface)
    uv = [*loops.uv]
    segments: list[tuple[int, int]] = []
    rim = len(uv)
    ends: list[int] = []  # nodes at which lines begin and end

    def node(place: np.ndarray) -> int:
        known = [*range(rim), *ends]
        apart = np.abs((np.array([uv[k] for k in known]) - place) / guides.width).max(axis=1)
        nearest = int(apart.argmin())
        if apart[nearest] <= SAME:
            return known[nearest]
        uv.append(place)
        ends.append(len(uv) - 1)
        return ends[-1]

    for line in lines:
        points = cut_kink(surface, guides, line, field)
        first = node(points[0])
        last = first if line.closed else node(points[-1])
        inner = list(range(len(uv), len(uv) + len(points) - 2))
        uv.extend(points[1:-1])
        chain = [first, *inner, last]
        segments += [(a, b) for a, b in pairwise(chain) if a != b]
    more = np.arange(len(loops.identity), len(uv))
    return replace(
        loops, uv=np.array(uv), inner=np.array(segments, np.int32).reshape(-1, 2),
        identity=np.concatenate([loops.identity, more]),
    )  # fmt: skip


def cut_kink(surface: Surface, guides: Guides, line: KinkLine, field: SizeField) -> np.ndarray:
    """Points (n + 1, 2) of a line at equal metric lengths near 1, on the kink, ends included."""
    fine, length = _metric(line, field)
    segments = max(CLOSED_SEGMENTS if line.closed else 1, round(length[-1]))
    chord = field.sizing.straight_chord
    for _ in range(DOUBLINGS):
        points = _spread(guides, line, fine, length, segments)
        if chord is None or _sag(surface, guides, line, fine, length, points) <= SAG * chord:
            break
        segments *= 2
    return points


def _metric(line: KinkLine, field: SizeField) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 2) along a line, near to each other, and the metric length (n,) up to each."""
    fine = line.uv
    while True:
        xy = field.chart.to_plane(fine)
        step = field.metric_lengths(0.5 * (xy[1:] + xy[:-1]), np.diff(xy, axis=0))
        length = np.concatenate([[0.0], np.cumsum(step)])
        if step.max() <= 1.0 / SAMPLED or len(fine) > 1 << 16:
            return fine, length
        place = np.linspace(0.0, len(fine) - 1.0, 2 * len(fine) - 1)
        fine = np.stack([np.interp(place, np.arange(len(fine)), x) for x in fine.T], axis=1)


def _at(fine: np.ndarray, length: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    return np.stack([np.interp(wanted, length, x) for x in fine.T], axis=1)


def _spread(
    guides: Guides, line: KinkLine, fine: np.ndarray, length: np.ndarray, segments: int
) -> np.ndarray:
    points = _at(fine, length, np.linspace(0.0, length[-1], segments + 1))
    points[1:-1] = guides.on_line(line.guide, points[1:-1], 0.05)
    points[0], points[-1] = line.uv[0], line.uv[-1]
    return points


def _sag(
    surface: Surface, guides: Guides, line: KinkLine, fine: np.ndarray, length: np.ndarray,
    points: np.ndarray,
) -> float:  # fmt: skip
    """Largest distance of the kink from the chords of its segments, at their middles."""
    segments = len(points) - 1
    middle = _at(fine, length, (np.arange(segments) + 0.5) * length[-1] / segments)
    middle = guides.on_line(line.guide, middle, 0.05)
    ((ends,), (between,)) = surface.evaluate(points, 0), surface.evaluate(middle, 0)
    start, along = ends[:-1], np.diff(ends, axis=0)
    squared = np.maximum(np.einsum("ij,ij->i", along, along), np.finfo(float).tiny)
    t = np.clip(np.einsum("ij,ij->i", between - start, along) / squared, 0.0, 1.0)
    return float(np.linalg.norm(between - start - t[:, None] * along, axis=1).max(initial=0.0))
