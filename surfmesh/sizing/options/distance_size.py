"""Sizes that grow with the distance from lines and points."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from surfmesh.errors import SizingError, shown
from surfmesh.geometry.planar.segment_distance import SegmentDistance
from surfmesh.geometry.surface import Surface, stated_sizes
from surfmesh.sizing.options.positive import positive


@dataclass(frozen=True, eq=False)
class DistanceSize:
    """A size law: ``near`` at the geometry, rising evenly to ``far`` at the distance ``reach``.

        size
        far  |        ,--------     min(1, d / reach) of the way from near to far
             |     ,'
        near |  ,'
             +--+-----+-------- d
                0   reach

    geometry: what has a method ``distance`` (a PlanarDomain), or polylines: one array (k, 2) or
    (k, 3) or several; a polyline of one point is that point. (p, 1, 3) are p points. near, far:
    edge lengths at the geometry, and at ``reach`` and beyond. All in model units.

    Raises ``SizingError`` for numbers that are not positive, and for other geometry.
    """

    geometry: Any
    near: float
    far: float
    reach: float

    def __post_init__(self) -> None:
        for name in ("near", "far", "reach"):
            object.__setattr__(self, name, positive(name, getattr(self, name)))
        if hasattr(self.geometry, "geom_type"):
            raise SizingError("a shapely geometry must be made a PlanarDomain, or arrays, first")
        if not hasattr(self.geometry, "distance"):
            object.__setattr__(self, "geometry", polylines(self.geometry))

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """Wanted edge lengths (n,) at points (n, 3), or (n, 2) in the plane z = 0."""
        fraction = np.minimum(self.distance(points) / self.reach, 1.0)
        return self.near + fraction * (self.far - self.near)

    def distance(self, points: np.ndarray) -> np.ndarray:
        """Distance to the geometry, (n, 2) or (n, 3) -> (n,)."""
        points = np.asarray(points, dtype=float)
        if points.ndim != 2 or points.shape[1] not in (2, 3):
            raise SizingError(f"points have shape {points.shape}, not (n, 2) or (n, 3)")
        if hasattr(self.geometry, "distance"):
            return self.geometry.distance(points)
        return self._distance(_in_space(points))

    @cached_property
    def _distance(self) -> SegmentDistance:
        starts, ends = [], []
        for line in self.geometry:
            last = max(1, len(line) - 1)  # a single point is a segment to itself
            starts.append(line[:last])
            ends.append(line[-last:])
        return SegmentDistance(np.concatenate(starts), np.concatenate(ends))


def default_options(surface: Surface) -> dict[str, Any]:
    """The surface's own sizing defaults; its table ``distance`` becomes a size law."""
    options = dict(stated_sizes(surface))
    table = options.pop("distance", None)
    if table is not None:
        options["size"] = DistanceSize(surface, **table)
    return options


def polylines(given: Any) -> tuple[np.ndarray, ...]:
    """One array (k, 2) or (k, 3) or several, as arrays (k, 3). Raises ``SizingError``."""
    if isinstance(given, (str, bytes)) or not isinstance(given, Iterable):
        raise SizingError(
            f"distances are to a PlanarDomain or to arrays (k, 2) or (k, 3), not {shown(given)}"
        )
    try:
        lines = [np.array(line, dtype=float) for line in given]
    except (TypeError, ValueError, OverflowError):
        raise SizingError(f"the geometry is not made of arrays: {shown(given)}") from None
    if lines and all(line.ndim == 1 for line in lines):
        lines = [np.array(lines)] if len({len(line) for line in lines}) == 1 else lines
    if not lines:
        raise SizingError("the geometry to measure distances from is empty")
    for number, line in enumerate(lines):
        if line.ndim != 2 or line.shape[1] not in (2, 3) or not len(line):
            raise SizingError(f"polyline {number} has shape {line.shape}, not (k, 2) or (k, 3)")
        if not np.isfinite(line).all():
            raise SizingError(f"polyline {number} has a point that is not finite")
    return tuple(_in_space(line) for line in lines)


def _in_space(points: np.ndarray) -> np.ndarray:
    if points.shape[1] == 3:
        return points
    return np.column_stack([points, np.zeros(len(points))])
