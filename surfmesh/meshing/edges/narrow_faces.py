"""Faces that are narrower than the chord all along: two sides, and what joins them at the ends.

      a ----------- a ----------- a          sides a and b, nowhere farther apart than the narrow
      |  start                    |  end     width; an end is a short chain of edges, or a tip in
      b ----------- b ----------- b          which the sides meet

    strip, fillet, chamfer    ends are short edges       crescent, lens    ends are tips
    tube, needle hole, torus  both sides are the seam    flat ring         two loops, no ends

Triangles of good shape in such a face would be as small as it is narrow, and its neighbours would
be flooded with them. It has no inside to be meshed: see ``strip_triangulation``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations
from math import pi

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadFace, CadModel
from surfmesh.cad.model.model_arrays import ModelArrays
from surfmesh.meshing.edges.edge_samples import EdgeSamples, NarrowFace
from surfmesh.sizing.options.defaults import DEFAULT_CHORD
from surfmesh.sizing.options.sizing import Sizing

NARROW = 1.0
"""Faces are narrow up to this fraction of ``chord``: any triangle across them lies within it."""

OF_SIZE = 0.25
"""And up to this fraction of the sizes that are asked for in so many words."""

OF_SIZE_ALONE = 0.1
"""Where nothing but a size is asked for, faces are narrow up to this fraction of it."""

ROUND = 1.1 * pi
"""Ends, and ways across, are at most so many narrow widths long: round a tube."""

SURELY = 1.0 + 1e-9
"""For sums that are rounded in another order."""

MOST_COEDGES = 40
"""Faces of more edges are not looked at: pairs of ends are many."""

MOST_CANDIDATES = 200
"""Ways to take a loop apart that are tried."""

ACROSS = 9
"""Points on the way from one side to the other."""

TIE = 1e-6
"""Relative difference of squared distances that is none."""

AT_ONCE = 100_000
"""Pairs of a point and a segment that are looked at together."""

FOOT_STEPS = 4
"""Of Newton's method, to the closest point of a curve."""


@dataclass(frozen=True)
class Chain:
    """Coedges one after the other, sampled: polygon with edge numbers and parameters.

    points (n, 3); edge (n,) and its normalised parameter t (n,) where a segment starts, and t_end
    (n,) where it ends; coedge (n,) the place of its coedge.
    """

    points: np.ndarray
    coedge: np.ndarray
    edge: np.ndarray
    t: np.ndarray
    t_end: np.ndarray


FEW = 9
"""Points of a side that are looked at before all are."""

EMPTY = 1e-10
"""Of the diagonal: a face whose mean width is below encloses nothing, and is no sliver."""


def narrow_width(sizing: Sizing, diagonal: float, points: np.ndarray) -> float:
    """What is narrow on a face with these size requests; points (n, 3): samples of its edges."""
    if sizing.gap is not None:
        return 0.0  # triangles across are asked for
    width = NARROW * (sizing.chord or DEFAULT_CHORD * diagonal)
    sizes = []
    if isinstance(sizing.size, float):
        sizes.append(sizing.size)
        if sizing.chord is None and sizing.angle is None:
            width = max(width, OF_SIZE_ALONE * sizing.size)
    sizes += [sizing.max_size] if sizing.max_size else []
    if sizing.has_law and len(points):
        sizes.append(float(sizing.law_sizes(points).min()))
    return min([width, *(OF_SIZE * size for size in sizes)])


def may_be_narrow(arrays: ModelArrays, width: np.ndarray) -> np.ndarray:
    """Numbers of the faces that lengths and areas do not show to be wider; width: (f,)."""
    length = np.where(arrays.collapsed, 0.0, arrays.length)[arrays.coedge_edge]
    count = np.diff(arrays.first_of_face)
    around = np.bincount(arrays.coedge_face, length, len(count))
    return np.flatnonzero((count > 0) & ~(2.0 * arrays.area > SURELY * ROUND * width * around))


def narrow_face(
    model: CadModel, face: CadFace, samples: EdgeSamples, width: float
) -> NarrowFace | None:
    """The sides and ends of a face that is narrower than ``width`` everywhere, or else None."""
    coedges = list(face.coedges)
    lengths = np.array([
        model.edges[c.edge].length if samples.first[c.edge] < samples.first[c.edge + 1] else 0.0
        for c in coedges
    ])  # fmt: skip
    around = lengths.sum()
    if not coedges or len(coedges) > MOST_COEDGES or not width > 0.0:
        return None
    if 2.0 * face.area > ROUND * width * around or face.area <= EMPTY * model.diagonal * around:
        return None
    if len(face.loops) == 2:
        first = len(face.loops[0])
        sides = tuple(range(first)), tuple(range(first, len(coedges)))
        return _checked(model, face, coedges, samples, NarrowFace(sides, closed=True), width)
    if len(face.loops) != 1:
        return None
    for candidate in _candidates(lengths, width):
        found = _checked(model, face, coedges, samples, candidate, width)
        if found is not None:
            return found
    return None


def _candidates(lengths: np.ndarray, width: float) -> Iterator[NarrowFace]:
    """Ways to take a loop apart in two sides and two ends, the longest ends first."""
    count = len(lengths)
    runs = []  # (start, number of coedges) of chains that are short enough to be an end
    for start in range(count):
        total = 0.0
        for number in range(count - 1):
            if total <= ROUND * width:
                runs.append((start, number, total))
            total += lengths[(start + number) % count]
    found = []
    whole = lengths.sum()
    for (i, m, one), (k, n, other) in combinations(runs, 2):
        first, second = (k - i - m) % count, (i - k - n) % count
        if first < 1 or second < 1 or first + second + m + n != count:
            continue
        sides = [
            tuple((at + step) % count for step in range(number))
            for at, number in ((i + m, first), (k + n, second))
        ]
        a, b = (lengths[list(side)].sum() for side in sides)
        if not min(a, b) > 0.0 or abs(a - b) > 0.3 * max(a, b) + ROUND * width:
            continue
        if one + other > 0.8 * whole:
            continue
        ends = [
            tuple((at + step) % count for step in range(number)) for at, number in ((k, n), (i, m))
        ]
        poles = sum(lengths[k] == 0.0 for end in ends for k in end)
        order = -(one + other), -poles, abs(a - b)
        found.append((order, NarrowFace((sides[0], sides[1]), (ends[0], ends[1]))))
    found.sort(key=lambda row: row[0])
    return (narrow for _, narrow in found[:MOST_CANDIDATES])


def _checked(
    model: CadModel, face: CadFace, coedges: list[CadCoedge], samples: EdgeSamples,
    narrow: NarrowFace, width: float,
) -> NarrowFace | None:  # fmt: skip
    """The face with its width if its sides are nowhere farther apart than ``width``, else None."""
    first, second = (chain_of(coedges, samples, side) for side in narrow.sides)
    if first is None or second is None:
        return None
    both = (first, second), (second, first)
    for own, other in both:  # a few points tell most that are too far apart
        few = np.linspace(0, len(own.points) - 1, min(FEW, len(own.points))).astype(int)
        if not feet(model, own.points[few], other)[2].max() <= width:
            return None
    largest = 0.0
    for own, other in both:
        place, t, away = feet(model, own.points, other)
        if not away.max() <= width:
            return None
        ways = _ways_across(face, coedges, own, other, place, t)
        if not ways.max() <= ROUND * width:
            return None
        largest = max(largest, float(ways.max()))
    return NarrowFace(narrow.sides, narrow.ends, narrow.closed, largest)


def chain_of(
    coedges: list[CadCoedge], samples: EdgeSamples, places: tuple[int, ...]
) -> Chain | None:
    """The samples of some coedges in walking order; None where none of them has any."""
    points, at, edge, t, t_end = [], [], [], [], []
    last = None
    for place in places:
        coedge = coedges[place]
        own = samples.of(coedge.edge)
        order = slice(None, None, -1) if coedge.reversed else slice(None)
        p, s = samples.points[own][order], samples.t[own][order]
        if not len(p):
            continue
        points.append(p[:-1])
        at.append(np.full(len(p) - 1, place))
        edge.append(np.full(len(p) - 1, coedge.edge))
        t.append(s[:-1])
        t_end.append(s[1:])
        last = p[-1:]
    if last is None:
        return None
    return Chain(
        np.concatenate([*points, last]),
        *(np.concatenate(column) for column in (at, edge, t, t_end)),
    )


def feet(
    model: CadModel, points: np.ndarray, chain: Chain
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Closest points of a chain to points (n, 3): segments, parameters of their edges, distances.

    First on the polygon of the samples, then on the curves themselves. The points run along the
    chain, the other way: where it is closed, this tells its end from its start.
    """
    about = np.linspace(1.0, 0.0, len(points))
    middle = (np.arange(len(chain.edge)) + 0.5) / len(chain.edge)
    start, way = chain.points[:-1], np.diff(chain.points, axis=0)
    square = np.maximum(np.einsum("ij,ij->i", way, way), np.finfo(float).tiny)
    place, along = np.empty(len(points), np.int64), np.empty(len(points))
    step = max(1, AT_ONCE // len(square))
    for k in range(0, len(points), step):
        at = slice(k, min(k + step, len(points)))
        off = points[at, None] - start
        ratio = np.clip(np.einsum("ijk,jk->ij", off, way) / square, 0.0, 1.0)
        off -= ratio[:, :, None] * way
        near = np.einsum("ijk,ijk->ij", off, off)
        tied = near <= near.min(axis=1)[:, None] * (1.0 + TIE) + TIE**2 * square.max()
        apart = np.where(tied, np.abs(middle - about[at, None]), np.inf)
        place[at] = apart.argmin(axis=1)
        along[at] = ratio[np.arange(len(ratio)), place[at]]
    t = (1.0 - along) * chain.t[place] + along * chain.t_end[place]
    away = np.empty(len(points))
    for edge in np.unique(chain.edge[place]).tolist():
        own = np.flatnonzero(chain.edge[place] == edge)
        t[own], away[own] = foot_on_edge(model, edge, points[own], t[own])
    return place, t, away


def foot_on_edge(
    model: CadModel, edge: int, points: np.ndarray, t: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Closest points of an edge to points (n, 3): parameters (n,), distances (n,).

    t: (n,) guesses.
    """
    own = model.edges[edge]
    best = np.clip(t, 0.0, 1.0)
    here = own.evaluate(best, 1)
    away = np.linalg.norm(here[0] - points, axis=1)
    for _ in range(FOOT_STEPS):
        speed = here[1] * (own.t1 - own.t0)
        square = np.maximum(np.einsum("ij,ij->i", speed, speed), np.finfo(float).tiny)
        step = np.einsum("ij,ij->i", points - here[0], speed) / square
        trial = np.clip(best + step, 0.0, 1.0)
        here = own.evaluate(trial, 1)
        now = np.linalg.norm(here[0] - points, axis=1)
        better = now < away
        best, away = np.where(better, trial, best), np.where(better, now, away)
        if not better.any():
            break
        here = own.evaluate(best, 1)
    return best, away


def _ways_across(
    face: CadFace, coedges: list[CadCoedge], own: Chain, other: Chain, place: np.ndarray,
    foot: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """Lengths (n,) in space of the ways in (u, v) from samples of one side to their feet."""
    n = len(place) - 1
    here, there = np.empty((n, 2)), np.empty((n, 2))
    for k in np.unique(own.coedge).tolist():
        at = own.coedge == k
        here[at] = coedges[k].uv(own.t[at])
    for k in np.unique(other.coedge[place[:n]]).tolist():
        at = other.coedge[place[:n]] == k
        there[at] = coedges[k].uv(foot[:n][at])
    t = np.linspace(0.0, 1.0, ACROSS)[:, None, None]
    uv = (1.0 - t) * here + t * there
    points = face.surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(ACROSS, n, 3)
    return np.linalg.norm(np.diff(points, axis=0), axis=2).sum(axis=0)
