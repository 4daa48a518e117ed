"""Noding: segments that meet anywhere are cut there, until they meet at common ends only.

     b                     b                      Points closer than the tolerance are one, a
     |         d           |   ,e---d             vertex near a segment cuts it (a T), what
     |     ,--'       ->   | ,--'                 overlaps becomes one segment with several
     c---'                 c---'                  uses, and a proper crossing is a new vertex
     |                     |                      or is refused.
     a                     a

Every cut bends a segment a little, which can bring it to something else: it is all done
again with what has changed, until nothing changes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NoReturn

import numpy as np
import shapely

from surfmesh._core.triangulation import CROSSING, find_meetings
from surfmesh.errors import DomainError
from surfmesh.geometry.boxes import diagonal

MERGE = 1e-12
"""Of the diagonal: points closer than this are one. A crossing is computed to about 1e-15 of
it, so that what meets in one point gets one vertex; and it is a millionth of the shortest
segments that are promised to survive."""
MERGE_ULPS = 16.0
"""In last places of the largest coordinate, the same where this is more: far from the origin
a point that is meant to lie on a line is off it by one or two."""
NEAR = 0.25
"""Of the merging distance: a vertex nearer to a segment cuts it. As vertices are four times as
far apart, the pieces are always shorter than the segment was, and cutting comes to an end."""
ROUNDS = 40
"""Rounds before giving up; two or three are usual, each can only bend segments by MERGE."""
QUERIES = 128
"""Segments looked up at a time: bounds the memory where thousands meet in one point."""
MOST_CROSSINGS = 2_000_000
"""More crossings than this in one round are a mistake, not a drawing."""

# flag of a pair, which of the two is cut, and by which end of the other
_NEAR = ((1, 1, 0, 0), (2, 1, 0, 1), (4, 0, 1, 0), (8, 0, 1, 1))


@dataclass(frozen=True)
class Noding:
    """Segments that meet at common ends only."""

    points: np.ndarray
    """(n, 2) float, those given in lexicographic order, then the crossings."""
    segments: np.ndarray
    """(s, 2) int32, the smaller point first, sorted, without duplicates."""
    uses: np.ndarray
    """(u, 2) int32, rows (segment, given segment): which given segments run along which."""
    lone: np.ndarray
    """(p,) int32, places given that end no segment."""


Refusal = Callable[[int, int, np.ndarray], Exception]


def noded(
    points: np.ndarray, segments: np.ndarray, places: np.ndarray, refusal: Refusal | None,
    merge: float = 0.0,
) -> Noding:  # fmt: skip
    """Cut segments where they meet.

    points: (n, 2) finite, of moderate size. segments: (m, 2) int, pairs of points. places:
    (p,) int, points that become vertices. refusal: makes the exception for a proper crossing
    of two given segments at a place; None cuts them there. merge: points nearer than this are
    one, unless rounding asks for more.

    Raises that exception, or DomainError when no end is found or there are far too many
    crossings.
    """
    exponent = size_exponent(points)
    points = np.ldexp(points, -exponent)  # exact, and makes domains of all sizes alike
    merge = max(_merging_distance(points), float(np.ldexp(merge, -exponent)))
    points, number = _lexicographic(points)
    ends, given, lone = number[segments], np.arange(len(segments)), np.unique(number[places])
    checked_use = np.zeros(len(ends), bool)
    checked_lone = np.zeros(len(lone), bool)
    for turn in range(ROUNDS):
        number, moved = _merging(points, merge)
        checked_use &= ~moved[ends].any(axis=1)
        checked_lone &= ~moved[lone]
        ends, (lone, first) = number[ends], np.unique(number[lone], return_index=True)
        checked_lone = checked_lone[first]
        kept = ends[:, 0] != ends[:, 1]
        ends, given, checked_use = np.sort(ends[kept], axis=1), given[kept], checked_use[kept]
        unique, use = np.unique(ends[:, 0] * len(points) + ends[:, 1], return_inverse=True)
        segments = np.stack([unique // len(points), unique % len(points)], axis=1)
        kept = _once_or_twice(use, given)
        use, given, checked_use = use[kept], given[kept], checked_use[kept]
        free = ~np.isin(lone, segments)
        lone, checked_lone = lone[free], checked_lone[free]
        checked = np.bincount(use[checked_use], minlength=len(segments)) > 0
        pieces = np.concatenate([segments, np.stack([lone, lone], axis=1)])
        fresh = ~np.concatenate([checked, checked_lone])
        # a crossing that only appears later comes from the bending of cuts, and is no mistake
        refused = None
        if refusal is not None and turn == 0:
            refused = _of_segments(refusal, use, given, exponent)
        cut, vertex, crossings = _cuts(points, pieces, fresh, NEAR * merge, refused)
        if not cut.size:
            points = np.ldexp(points, exponent)
            return _compact(points, segments, np.stack([use, given], axis=1), lone)
        points = np.concatenate([points, crossings])
        ends, given, checked_use = _cut(points, segments, cut, vertex, use, given)
        checked_lone[:] = True
    x, y = np.ldexp(points[vertex[0]], exponent)
    raise DomainError(
        f"the segments do not come to rest after {ROUNDS} rounds of cutting near "
        f"({x:.9g}, {y:.9g}); move apart what nearly touches there"
    )


def _of_segments(
    refusal: Refusal, use: np.ndarray, given: np.ndarray, exponent: int
) -> Callable[[np.ndarray, np.ndarray], NoReturn]:
    """The refusal of a pair of cut segments, by the given ones that run along them."""

    def refuse(pair: np.ndarray, place: np.ndarray) -> NoReturn:
        first, second = (int(given[use == segment].min()) for segment in pair)
        raise refusal(first, second, np.ldexp(place, exponent))

    return refuse


def size_exponent(points: np.ndarray) -> int:
    """The power of two that is the size of the bounding box of points (n, 2)."""
    return int(np.frexp(np.ptp(points, axis=0).max())[1])


def _merging_distance(points: np.ndarray) -> float:
    """The distance below which two of the points (n, 2) are one."""
    return max(MERGE * diagonal(points), MERGE_ULPS * float(np.spacing(np.abs(points).max())))


def first_meeting(points: np.ndarray, segments: np.ndarray, lone: np.ndarray) -> tuple | None:
    """Two segments (or the segment of a lone point) that meet other than at a common end.

    Decided exactly. Returns (first, second), or None; numbers from len(segments) on are lone
    points.
    """
    points = np.ldexp(points, -size_exponent(points))
    pieces = np.concatenate([segments, np.stack([lone, lone], axis=1)]).astype(np.int64)
    for pairs, _, _ in _meetings(points, pieces, np.ones(len(pieces), bool), 0.0):
        return tuple(pairs[0].tolist())
    return None


def _lexicographic(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distinct points sorted by x, then y, so that no direction or start of a loop matters."""
    points = points + 0.0  # no negative zeros
    order = np.lexsort((points[:, 1], points[:, 0]))
    points = points[order]
    different = np.ones(len(points), bool)
    different[1:] = (points[1:] != points[:-1]).any(axis=1)
    number = np.empty(len(points), np.int64)
    number[order] = np.cumsum(different) - 1
    return points[different], number


def _merging(points: np.ndarray, merge: float) -> tuple[np.ndarray, np.ndarray]:
    """For each point the one that it is one with, within ``merge``, and whether that is another.

    Point by point: whichever is not taken yet takes all that are near it. So no point moves by
    more than ``merge``, however dense a line of points is.
    """
    from scipy.spatial import cKDTree

    number = np.arange(len(points))
    close = cKDTree(points).query_pairs(merge, output_type="ndarray")
    taken = np.zeros(len(points), bool)
    for first, second in close[np.lexsort((close[:, 1], close[:, 0]))].tolist():
        if not taken[first] and not taken[second]:
            taken[second] = True
            number[second] = first
    return number, number != np.arange(len(points))


def _once_or_twice(use: np.ndarray, given: np.ndarray) -> np.ndarray:
    """Uses of a segment that matter: one of an odd number by the same line, two of an even."""
    key = use * (given.max(initial=0) + 1) + given
    _, first, times = np.unique(key, return_index=True, return_counts=True)
    return np.repeat(first, 2 - times % 2)


def _meetings(
    points: np.ndarray, pieces: np.ndarray, fresh: np.ndarray, tolerance: float
) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Pairs of pieces, one of them fresh, that meet: pairs (k, 2), flags (k,), places (k, 2)."""
    # the tree proposes by bounding boxes, the core decides: faster than any predicate of shapely
    reach = tolerance + 4.0 * float(np.spacing(np.abs(points).max()))
    low, high = points[pieces].min(axis=1) - reach, points[pieces].max(axis=1) + reach
    boxes = shapely.box(*low.T, *high.T)
    tree = shapely.STRtree(boxes)
    wanted = np.flatnonzero(fresh)
    for start in range(0, len(wanted), QUERIES):
        block = wanted[start : start + QUERIES]
        asked, found = tree.query(boxes[block])
        asked = block[asked]
        once = (asked < found) | ~fresh[found]
        pairs = np.stack([asked[once], found[once]], axis=1)
        pairs.sort(axis=1)
        flags, places = find_meetings(points, pieces, pairs, tolerance)
        meet = flags > 0
        if meet.any():
            pairs, flags, places = pairs[meet], flags[meet], places[meet]
            order = np.lexsort((pairs[:, 1], pairs[:, 0]))
            yield pairs[order], flags[order], places[order]


def _cuts(
    points: np.ndarray,
    pieces: np.ndarray,
    fresh: np.ndarray,
    tolerance: float,
    refuse: Callable[[np.ndarray, np.ndarray], None] | None,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Which segments are to be cut at which vertices, and the vertices that are new.

    Returns cut (c,), vertex (c,), crossings (x, 2); crossing k is vertex len(points) + k.
    """
    empty = np.empty(0, np.int64)
    cut, vertex, crossings, count = [empty], [empty], [np.empty((0, 2))], len(points)
    for pairs, flags, places in _meetings(points, pieces, fresh, tolerance):
        proper = flags == CROSSING
        if refuse is not None and proper.any():
            k = int(proper.argmax())
            refuse(pairs[k], places[k])
        for bit, segment, other, end in _NEAR:
            near = (flags & bit) > 0
            cut.append(pairs[near, segment])
            vertex.append(pieces[pairs[near, other], end])
        new = count + np.arange(np.count_nonzero(proper))
        cut += [pairs[proper, 0], pairs[proper, 1]]
        vertex += [new, new]
        crossings.append(places[proper])
        count += len(new)
        if count > len(points) + MOST_CROSSINGS:
            raise DomainError(
                f"the segments cross more than {MOST_CROSSINGS} times; simplify the lines"
            )
    return np.concatenate(cut), np.concatenate(vertex), np.concatenate(crossings)


def _cut(
    points: np.ndarray,
    segments: np.ndarray,
    cut: np.ndarray,
    vertex: np.ndarray,
    use: np.ndarray,
    given: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Replace the segments ``cut`` by their pieces between the vertices, use by use.

    Returns ends (u, 2), given (u,) and whether the use was left whole (u,).
    """
    whole = np.ones(len(segments), bool)
    whole[cut] = False
    broken = np.flatnonzero(~whole)
    a, b = points[segments[cut, 0]], points[segments[cut, 1]]
    along = ((points[vertex] - a) * (b - a)).sum(axis=1)
    row = np.concatenate([broken, cut, broken])
    knot = np.concatenate([segments[broken, 0], vertex, segments[broken, 1]])
    far = np.full(len(broken), np.inf)
    order = np.lexsort((knot, np.concatenate([-far, along, far]), row))
    row, knot = row[order], knot[order]
    inner = row[1:] == row[:-1]
    pieces = np.stack([knot[:-1], knot[1:]], axis=1)[inner]
    count = np.bincount(row[1:][inner], minlength=len(segments))
    start = np.cumsum(count) - count

    kept, split = whole[use], np.flatnonzero(~whole[use])
    times = count[use[split]]
    step = np.arange(times.sum()) - np.repeat(np.cumsum(times) - times, times)
    piece = np.repeat(start[use[split]], times) + step
    ends = np.concatenate([segments[use[kept]], pieces[piece]])
    given = np.concatenate([given[kept], np.repeat(given[split], times)])
    return ends, given, np.arange(len(ends)) < np.count_nonzero(kept)


def _compact(
    points: np.ndarray, segments: np.ndarray, uses: np.ndarray, lone: np.ndarray
) -> Noding:
    """Drop the points that nothing uses."""
    used = np.zeros(len(points), bool)
    used[segments] = True
    used[lone] = True
    number = np.cumsum(used) - 1
    order = np.lexsort((uses[:, 1], uses[:, 0]))
    return Noding(
        points[used],
        number[segments].astype(np.int32),
        uses[order].astype(np.int32),
        number[lone].astype(np.int32),
    )
