"""Tips and necks of a face so thin that no ring of wanted edges fits round them.

   pole                  Where a tube closes with a cusp, or narrows to far less than its
  / | \\                  triangles are long, isotropic ones would become smaller without end.
 o--o--o  level 1        There rings of COLUMNS nodes stand at the nodes of the two edges (or
 |\\ |\\ |                 of the two images of a seam) that run along the tube, with long
 o--o--o  last level     triangles between them. What is left of the face, beyond the last
/   |   \\                ring, is meshed as all others are.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from surfmesh._core import elementary_functions, faces
from surfmesh.geometry.small_matrices import norm
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.edges.polygon_lengths import fractions_along
from surfmesh.meshing.faces.face_data import CoedgeNodes, FaceJob, boundary_of
from surfmesh.sizing.options.sizing import Sizing

COLUMNS = 6
"""Triangles round a full tube: so many normals turn from one to the next by 60 degrees."""

OF_CHORD = 0.3
"""And so many that the surface rises no higher over each than this fraction of the chord: triangles
are as far from it as they sag along the tube and across together."""

FEWEST = faces.FEWEST_STEPS  # 2.5
"""A level whose way round is less than so many steps along the edges is thin."""

THREAD = 1e-3
"""Of a step: where the way round is shorter only the nodes of the edges stand."""

BLUNT = 0.5
"""Radius of a tip over the distance from its pole: the sine of 30 degrees."""

LEAST_TURN = 0.5
"""Radians by which the way round turns: what turns less is a corner, not a tube."""

APART = faces.APART  # 1e-3
"""Images nearer than this fraction of the face's box are no two: an edge inside the face."""

WAY = faces.WAY_SAMPLES  # 33
"""Samples of the way round at a level."""


@dataclass(frozen=True)
class Tube:
    """What is cut out of a face between two pieces of its boundary, level by level.

    left: the nodes of the piece that comes towards the first level, right: of the one that leads
    away, both from the first level to the last. last: the last level as a piece of the boundary
    of what is left, from left to right; first: the other one, from right to left. None at a pole,
    where the level is one point.
    """

    left: CoedgeNodes
    right: CoedgeNodes
    left_slots: np.ndarray
    right_slots: np.ndarray
    last: CoedgeNodes | None
    first: CoedgeNodes | None
    columns: tuple[np.ndarray, ...]
    """(levels, 2) each: (u, v) of the nodes, column by column from left to right. From pole to pole
    the inner ones have a level of their own where the sides have none."""


@dataclass
class _Open:
    """A loop that is taken apart: its pieces, and the slots of their nodes."""

    pieces: list[CoedgeNodes]
    slots: list[np.ndarray]

    def part(self, at: int, first: int, last: int) -> tuple[CoedgeNodes, np.ndarray]:
        """The nodes of one piece from ``first`` to ``last``, both included."""
        return self.pieces[at].part(first, last), self.slots[at][first : last + 1]


def without_tubes(job: FaceJob) -> tuple[FaceJob, list[Tube], np.ndarray]:
    """The job with its thin tips and necks cut off; these; the old slot for each of the new job.

    The nodes of rings have no old slot: -1.
    """
    tubes: list[Tube] = []
    opened, slot = [], 0
    if job.surface.kind == "plane":
        return job, [], np.arange(sum(len(p.numbers) for loop in job.loops for p in loop))
    for pieces in job.loops:
        own = _Open(list(pieces), [])
        for piece in pieces:
            own.slots.append(slot + np.arange(len(piece.numbers)))
            slot += len(piece.numbers)
        opened.append(own)
    following = 1 + max(int(piece.numbers.max()) for loop in job.loops for piece in loop)
    done: list[_Open] = []
    while opened:
        loop = opened.pop(0)
        for cut in (_whole_cut, _tip_cut, _neck_cut):
            tube, rest = cut(job, loop, following)
            if tube is not None:
                break
        if tube is None:
            done.append(loop)
            continue
        tubes.append(tube)
        following += 2 * len(tube.columns)
        opened[:0] = rest
    if not tubes:
        return job, [], np.arange(slot)
    left = replace(job, boundary=boundary_of(loop.pieces for loop in done))
    kept = [slots for loop in done for slots in loop.slots]
    return left, tubes, np.concatenate([np.empty(0, np.int64), *kept])


def _whole_cut(job: FaceJob, loop: _Open, following: int) -> tuple[Tube | None, list[_Open]]:
    """A loop from one pole to another and back that is thin all the way: nothing is left."""
    pieces = loop.pieces
    poles = [k for k, piece in enumerate(pieces) if piece.degenerate]
    if len(pieces) != 4 or len(poles) != 2 or poles[1] - poles[0] != 2:
        return None, []
    before, after = (poles[0] - 1) % 4, poles[0] + 1
    one, other = pieces[before].backwards(), pieces[after]
    if not _thin(job, *map(_with_middle, (one.uv, other.uv, one.points)))[1:-1].all():
        return None, []
    lines = [_with_middle(piece.uv) for piece in (one, other)]
    middle = [line[len(line) // 2] for line in lines]
    if _turn(job.surface, *middle) < LEAST_TURN:
        return None, []
    slots = loop.slots[before][::-1], loop.slots[after]
    return _tube(job, one, other, *slots, following, middle, (True, True)), []


def _is_pointed(surface: Surface, one: CoedgeNodes, other: CoedgeNodes, levels: int) -> bool:
    """Does the tip between two pieces, at its pole the end of one and the start of the other, turn
    as a tube does, and is it narrower than a blunt cone? A pole of a sphere is no tip."""
    ends = one.uv[-1 - levels], other.uv[levels]
    turn = _turn(surface, *ends)
    reach = norm(other.points[levels] - other.points[0])
    (way,) = _ways(surface, ends[0][None], ends[1][None])
    return turn >= LEAST_TURN and bool(way < BLUNT * turn * reach)


def _with_middle(line: np.ndarray) -> np.ndarray:
    """A line of two nodes gets a third."""
    return line if len(line) > 2 else np.array([line[0], 0.5 * (line[0] + line[1]), line[1]])


def _tip_cut(job: FaceJob, loop: _Open, following: int) -> tuple[Tube | None, list[_Open]]:
    """The first thin tip of a loop, and the loop without it."""
    count = len(loop.pieces)
    for at in range(count if count > 2 else 0):
        before, after = (at - 1) % count, (at + 1) % count
        one, other = loop.pieces[before], loop.pieces[after]
        if not loop.pieces[at].degenerate or one.degenerate or other.degenerate:
            continue
        most = min(len(one.numbers), len(other.numbers)) - 2  # a part of the face is left
        thin = _thin(job, one.uv[::-1], other.uv, one.points[::-1])[1 : most + 1]
        levels = int(np.argmin(thin)) if not thin.all() else len(thin)
        if not levels or not _is_pointed(job.surface, one, other, levels):
            continue
        end = len(one.numbers) - 1
        left, left_slots = loop.part(before, end - levels, end)
        right, right_slots = loop.part(after, 0, levels)
        tube = _tube(
            job, left.backwards(), right, left_slots[::-1], right_slots, following,
            (left.uv[0], right.uv[-1]), (True, False),
        )  # fmt: skip
        pieces, slots = loop.pieces.copy(), loop.slots.copy()
        pieces[before], slots[before] = loop.part(before, 0, end - levels)
        pieces[after], slots[after] = loop.part(after, levels, len(other.numbers) - 1)
        assert tube.last is not None  # noqa: S101  it is no pole
        pieces[at], slots[at] = tube.last, _ring_slots(left_slots[0], tube, right_slots[-1])
        return tube, [_Open(pieces, slots)]
    return None, []


def _neck_cut(job: FaceJob, loop: _Open, following: int) -> tuple[Tube | None, list[_Open]]:
    """The first thin neck between two images of a seam, and the loops on either side of it."""
    count = len(loop.pieces)
    ways = {_ends(piece.numbers): k for k, piece in enumerate(loop.pieces)}
    for before, one in enumerate(loop.pieces):
        after = ways.get(_ends(one.numbers[::-1]))
        if after is not None and after > before and _are_images(job, one, loop.pieces[after]):
            other = loop.pieces[after]
            span = _longest(_thin(job, one.uv[::-1], other.uv, other.points))
            end = len(other.numbers) - 1
            if span is None or span[0] < 1 or span[1] > end - 1 or span[0] == span[1]:
                continue
            low, high = span
            left, left_slots = loop.part(before, end - high, end - low)
            right, right_slots = loop.part(after, low, high)
            tube = _tube(
                job, left.backwards(), right, left_slots[::-1], right_slots, following,
                (left.uv[0], right.uv[-1]), (False, False),
            )  # fmt: skip
            beyond = [k % count for k in range(after + 1, before + count)]
            between = range(before + 1, after)
            assert tube.last is not None and tube.first is not None  # noqa: S101  no poles
            upper = [loop.part(after, high, end)]
            upper += [(loop.pieces[k], loop.slots[k]) for k in beyond]
            upper += [loop.part(before, 0, end - high)]
            upper += [(tube.last, _ring_slots(left_slots[0], tube, right_slots[-1]))]
            lower = [loop.part(before, end - low, end)]
            lower += [(loop.pieces[k], loop.slots[k]) for k in between]
            lower += [loop.part(after, 0, low)]
            lower += [(tube.first, _ring_slots(right_slots[0], tube, left_slots[-1]))]
            return tube, [_Open(*map(list, zip(*side))) for side in (upper, lower)]
    return None, []


def _ends(numbers: np.ndarray) -> tuple[int, ...]:
    return len(numbers), *numbers[:2].tolist(), *numbers[-2:].tolist()


def _are_images(job: FaceJob, one: CoedgeNodes, other: CoedgeNodes) -> bool:
    """Are they one edge, run there and back in two places of (u, v)?"""
    if one.degenerate or not np.array_equal(one.numbers[::-1], other.numbers):
        return False
    low, high = np.array(job.surface.domain).T
    away = np.abs(one.uv[::-1] - other.uv) > APART * (high - low)
    return bool(away.any(axis=1)[1:-1].all())


def _longest(thin: np.ndarray) -> tuple[int, int] | None:
    """First and last of the longest run."""
    edges = np.flatnonzero(np.diff(np.r_[0, thin.astype(np.int8), 0]))
    if not len(edges):
        return None
    runs = edges.reshape(-1, 2)
    first, after = runs[np.argmax(runs[:, 1] - runs[:, 0])].tolist()
    return first, after - 1


def _thin(job: FaceJob, left: np.ndarray, right: np.ndarray, points: np.ndarray) -> np.ndarray:
    """At which levels the way from left to right (n, 2) is too short for a ring of wanted edges.

    points: (m, 3) of the nodes on one side. For as many levels as both sides have.
    """
    count = min(len(left), len(right))
    length = _ways(job.surface, left[:count], right[:count])
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    step = np.minimum(np.r_[step[:1], step], np.r_[step, step[-1:]])[:count]
    return length < FEWEST * step


def _ways(surface: Surface, left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Lengths (n,) in space of the ways from left to right (n, 2)."""
    t = np.linspace(0.0, 1.0, WAY)[:, None]
    way = left[:, None] + t * (right - left)[:, None]
    rings = surface.evaluate(way.reshape(-1, 2), 0)[0].reshape(len(left), WAY, 3)
    return np.linalg.norm(np.diff(rings, axis=1), axis=2).sum(axis=1)


def _tube(
    job: FaceJob, left: CoedgeNodes, right: CoedgeNodes, left_slots: np.ndarray,
    right_slots: np.ndarray, following: int, round_way: Sequence[np.ndarray],
    poles: tuple[bool, bool],
) -> Tube:  # fmt: skip
    """The columns between two sides, and the rings at its ends where these are no poles.

    round_way: two ends (2,) of a way round, by whose turn the columns are counted.
    """
    surface = job.surface
    seam = np.array_equal(left.numbers, right.numbers)
    turn = _turn(surface, *round_way)
    count = int(np.ceil(COLUMNS * turn / (2.0 * np.pi) - 1e-6))
    count = max(count, 3 if seam else 1)
    uv, t, other = left.uv, fractions_along(left.points), fractions_along(right.points)
    if all(poles) and len(uv) == 2:
        uv, t = _with_middle(uv), np.array([0.0, 0.5, 1.0])
    beside = np.stack([np.interp(t, other, right.uv[:, k]) for k in (0, 1)], axis=1)
    length = _ways(surface, uv, beside)
    count = max(count, _columns_asked_for(job.sizing, float(length.max()), turn))
    inside = _wide_enough(surface, uv, length)
    inner = [(uv + k / count * (beside - uv))[inside] for k in range(1, count)]
    columns = (left.uv, *inner, right.uv)
    ends = [
        None if pole else _ring(surface, columns, level, left, right, following + more)
        for pole, level, more in zip(poles, (0, -1), (len(columns), 0))
    ]
    first = None if ends[0] is None else ends[0].backwards()
    return Tube(left, right, left_slots, right_slots, ends[1], first, columns)


def _columns_asked_for(sizing: Sizing, length: float, turn: float) -> int:
    """So many triangles round a way of this length and turn that they keep to chord and angle.

    An arc of radius R and angle a rises R (1 - cos a/2), at most R a^2 / 8, over its chord.
    """
    count = 1.0
    if sizing.chord is not None:
        count = math.sqrt(length * turn / (8.0 * OF_CHORD * sizing.chord))
    if sizing.angle is not None:
        count = max(count, turn / math.radians(sizing.angle))
    return math.ceil(count - 1e-6)


def _wide_enough(surface: Surface, left: np.ndarray, length: np.ndarray) -> np.ndarray:
    """The levels at which inner columns have nodes: the ends, and where the tube is no thread.

    length: (n,) of the way round at each.
    """
    (points,) = surface.evaluate(left, 0)
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    wide = length > THREAD * np.minimum(np.r_[step[:1], step], np.r_[step, step[-1:]])
    wide[[0, -1]] = True
    return wide


def _ring(
    surface: Surface, columns: tuple[np.ndarray, ...], level: int, left: CoedgeNodes,
    right: CoedgeNodes, following: int,
) -> CoedgeNodes:  # fmt: skip
    """One level as a piece of the boundary, from left to right, with numbers of its own."""
    uv = np.array([column[level] for column in columns])
    (points,) = surface.evaluate(uv, 0)
    points[0], points[-1] = left.points[level], right.points[level]
    numbers = following + np.arange(len(uv))
    numbers[0], numbers[-1] = left.numbers[level], right.numbers[level]
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    sizes = np.minimum(np.r_[step[:1], step], np.r_[step, step[-1:]])
    sizes[0] = min(sizes[0], left.sizes[level])
    sizes[-1] = min(sizes[-1], right.sizes[level])
    return CoedgeNodes(uv, numbers, points, sizes)


def _ring_slots(start: int, tube: Tube, end: int) -> np.ndarray:
    return np.r_[start, np.full(len(tube.columns) - 2, -1), end]


def _turn(surface: Surface, left: np.ndarray, right: np.ndarray) -> float:
    """By how much the way round turns, radians."""
    t = np.linspace(0.0, 1.0, WAY)[:, None]
    step = np.diff(surface.evaluate(left + t * (right - left), 0)[0], axis=0)
    step /= np.maximum(np.linalg.norm(step, axis=1), np.finfo(float).tiny)[:, None]
    cosine = np.einsum("ij,ij->i", step[1:], step[:-1])
    return (
        float(elementary_functions.acos(np.clip(cosine, -1.0, 1.0)).sum()) * (WAY - 1) / (WAY - 2)
    )
