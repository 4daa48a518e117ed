"""Points of a planar domain that lie so near to each other that they are one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from surfmesh.errors import DomainError, shown
from surfmesh.geometry.boxes import diagonal
from surfmesh.geometry.planar.segment_graph import Line

SAME = 1e-9
"""Of the diagonal: points nearer to each other are one, a thousandth of the shortest segments that
are promised to survive."""
ROUNDING = 1e-12
"""Of the diagonal: points that are merged from no farther away are not worth a word."""


def positive_distance(name: str, given: Any) -> float:
    """A positive finite number. Raises DomainError."""
    try:
        distance = float(given)
    except (TypeError, ValueError, OverflowError):
        distance = np.nan
    if not 0.0 < distance < np.inf:
        raise DomainError(f"{name} is a positive distance, not {shown(given)}")
    return distance


def merging_distance(lines: Sequence[Line], merge: float | None) -> float:
    """The distance below which points are one."""
    points = np.concatenate([line.points for line in lines])
    if merge is not None:
        return positive_distance("merge", merge)
    return SAME * diagonal(points)


def merged_points(lines: Sequence[Line], merge: float) -> list[str]:
    """A sentence about points that differ and yet are one, by more than rounding."""
    from scipy.spatial import cKDTree

    points = np.concatenate([line.points for line in lines])
    starts = np.cumsum([0, *(len(line.points) for line in lines)])
    rounding = ROUNDING * diagonal(points)
    places, first = np.unique(points, axis=0, return_index=True)
    pairs = cKDTree(places).query_pairs(merge, output_type="ndarray")
    apart = np.linalg.norm(places[pairs[:, 1]] - places[pairs[:, 0]], axis=1)
    pairs, apart = pairs[apart > rounding], apart[apart > rounding]
    if not len(pairs):
        return []
    count = len(np.unique(pairs[:, 1]))
    given = int(first[pairs[0]].max())
    line = int(np.searchsorted(starts, given, side="right")) - 1
    many = "1 point lies" if count == 1 else f"{count:,} points lie"
    return [
        f"{many} within {apart.max():.3g} of another and {'is' if count == 1 else 'are'} merged "
        f"with it, first {lines[line].label}, point {given - starts[line]} (merge={merge:.3g})"
    ]
