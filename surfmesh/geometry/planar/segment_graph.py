"""Loops, lines and points of a planar domain as one graph of segments, and what is inside.

A region of the plane lies in a loop when a path from infinity to it crosses the segments of
the loop an odd number of times. It is inside the domain when more outer loops than holes lie
around it: an island in a hole is an outer loop again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NoReturn

import numpy as np

from surfmesh.errors import DomainError
from surfmesh.geometry.number_range import RANGE
from surfmesh.geometry.planar.noding import MERGE, first_meeting, noded


@dataclass(frozen=True, eq=False)
class Line:
    """One loop, polyline or point as it was given."""

    label: str
    """As in "outer loop 0"."""
    points: np.ndarray
    """(k, 2) float, finite."""
    closed: bool = False
    """A segment joins the last point to the first."""
    loop: int = -1
    """Number of the loop, or -1 for constraints and points."""


@dataclass(frozen=True, eq=False, kw_only=True)
class SegmentGraph:
    """Segments that meet at common ends only, and the loops that run along them."""

    points: np.ndarray
    """(n, 2) float, in model units; every one ends a segment or is a lone point."""
    segments: np.ndarray
    """(s, 2) int32, pairs of points, the smaller first, without duplicates."""
    lone_points: np.ndarray
    """(p,) int32, demanded points that end no segment."""
    loop_segments: np.ndarray
    """(k, 2) int32, rows (segment, loop): the segments that a loop runs along an odd number of
    times. At each point an even number of them meet."""
    loop_is_hole: np.ndarray
    """(L,) bool."""
    given: np.ndarray
    """(s,) int32, the first given segment that runs along each segment."""
    labels: tuple[str, ...]
    """Names of the given lines."""
    label_start: np.ndarray
    """(lines + 1,) int32, number of the first given segment of each line."""

    def origin(self, segment: int) -> str:
        """Where a segment comes from, as in "outer loop 0, segment 3"."""
        return _origin(self.labels, self.label_start, int(self.given[segment]))

    def broken_invariant(self) -> str | None:
        """The first broken invariant in words, or None."""
        n, s = len(self.points), len(self.segments)
        if not np.isfinite(self.points).all():
            return "a point is not finite"
        if len(np.unique(self.points, axis=0)) != n:
            return "two points are at one place"
        for name, numbers, limit in (
            ("segments", self.segments, n),
            ("lone_points", self.lone_points, n),
            ("loop_segments", self.loop_segments[:, 0], s),
            ("loops", self.loop_segments[:, 1], len(self.loop_is_hole)),
        ):
            if numbers.size and not 0 <= numbers.min() <= numbers.max() < limit:
                return f"{name}: a number is out of range"
        if (self.segments[:, 0] >= self.segments[:, 1]).any():
            return "a segment does not have its smaller point first"
        if len(np.unique(self.segments, axis=0)) != s:
            return "a segment is there twice"
        if np.isin(self.lone_points, self.segments).any():
            return "a lone point ends a segment"
        if len(np.union1d(self.segments, self.lone_points)) != n:
            return "a point is not used"
        ends = self.segments[self.loop_segments[:, 0]].astype(np.int64)
        keys = self.loop_segments[:, 1:2] * np.int64(n) + ends
        key, count = np.unique(keys, return_counts=True)
        if (count % 2).any():
            loop, point = divmod(int(key[(count % 2).argmax()]), n)
            return f"loop {loop} is not closed at point {point}"
        met = first_meeting(self.points, self.segments, self.lone_points)
        if met is not None:
            first, second = (self.origin(k) if k < s else "a lone point" for k in met)
            return f"{first} and {second} meet other than at a common end"
        return None


def segment_graph(
    lines: Sequence[Line],
    loop_is_hole: Sequence[bool],
    split: bool = False,
    merge: float = 0.0,
) -> SegmentGraph:
    """Make one graph of lines that touch, overlap and cross.

    split: cut crossing segments at the crossing; otherwise they are refused. merge: distance,
    model units, below which points are one; never less than rounding.

    Raises DomainError when segments cross and are not to be split (it names both and the
    place), for a loop that encloses no area, and for coordinates that are too large.
    """
    points = np.concatenate([line.points for line in lines])
    _refuse_extremes(lines, points)
    pieces, counts = _segments_given(lines)
    label_start = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
    labels = tuple(line.label for line in lines)
    sizes = np.array([len(line.points) for line in lines])
    # the first point of what is no loop stays, even when all of it is one point
    stays = (np.cumsum(sizes) - sizes)[[line.loop < 0 for line in lines]]

    def refusal(one: int, other: int, place: np.ndarray) -> DomainError:
        named = [_origin(labels, label_start, k) for k in sorted((one, other))]
        return DomainError(
            f"{named[0]} crosses {named[1]} at ({place[0]:.9g}, {place[1]:.9g}); "
            'end one of them there, or pass crossings="split"'
        )

    found = noded(points, pieces, stays, None if split else refusal, merge)
    segment, given = found.uses.T
    loop = np.repeat([line.loop for line in lines], counts)[given]
    loop_segments = _loop_segments(segment, loop)
    without_area = np.setdiff1d(np.arange(len(loop_is_hole)), loop_segments[:, 1])
    if len(without_area):
        _refuse_loop_without_area(lines, int(without_area[0]), merge)
    _, first_use = np.unique(segment, return_index=True)
    arrays = {
        "points": found.points,
        "segments": found.segments,
        "lone_points": found.lone,
        "loop_segments": loop_segments,
        "loop_is_hole": np.array(loop_is_hole, bool),
        "given": given[first_use],
        "label_start": label_start,
    }
    for array in arrays.values():
        array.setflags(write=False)
    graph = SegmentGraph(**arrays, labels=labels)
    met = first_meeting(found.points, found.segments, found.lone)
    if met is not None:
        one, other = (graph.origin(k) if k < len(found.segments) else "a point" for k in met)
        raise DomainError(
            f"{one} and {other} still meet after cutting; move apart what nearly touches there"
        )
    return graph


def _segments_given(lines: Sequence[Line]) -> tuple[np.ndarray, list[int]]:
    """Pairs of points (s, 2), numbered through all lines, and how many each line has."""
    pieces, counts, first = [], [], 0
    for line in lines:
        index = first + np.arange(len(line.points))
        some = len(index) if line.closed else len(index) - 1
        pieces.append(np.stack([index, np.roll(index, -1)], axis=1)[:some])
        counts.append(some)
        first += len(index)
    return np.concatenate(pieces), counts


def _refuse_loop_without_area(lines: Sequence[Line], loop: int, merge: float) -> NoReturn:
    label = next(line.label for line in lines if line.loop == loop)
    raise DomainError(
        f"{label} encloses no area: it runs to and fro along one line, or is smaller than "
        f"{merge or MERGE:.3g}{'' if merge else ' of the domain'}, within which points are "
        "merged; leave it out, or give it as a constraint"
    )


def _loop_segments(segment: np.ndarray, loop: np.ndarray) -> np.ndarray:
    """Rows (segment, loop) of uses (n,) that occur an odd number of times; -1 is no loop."""
    uses = np.stack([segment, loop], axis=1)[loop >= 0].reshape(-1, 2)
    row, times = np.unique(uses, axis=0, return_counts=True)
    return row[times % 2 == 1].astype(np.int32)


def _origin(labels: tuple[str, ...], label_start: np.ndarray, given: int) -> str:
    line = int(np.searchsorted(label_start, given, side="right")) - 1
    return f"{labels[line]}, segment {given - label_start[line]}"


def _refuse_extremes(lines: Sequence[Line], points: np.ndarray) -> None:
    for line in lines:
        large = np.abs(line.points).max(axis=1) > RANGE.coordinate
        if large.any():
            x, y = line.points[large.argmax()]
            raise DomainError(
                f"{line.label}: the point ({x:g}, {y:g}) is too far away to compute with; "
                "scale the domain"
            )
    if 0.0 < np.ptp(points, axis=0).max() < RANGE.extent:
        raise DomainError(
            f"the domain is only {np.ptp(points, axis=0).max():g} wide, too small to compute "
            "with; scale it"
        )
