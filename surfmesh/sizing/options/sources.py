"""Local sizes: near points and lines, within boxes and balls.

    size
         |              ,'   growth: per unit of distance the size grows as it does between
         |           ,'      neighbours of a mesh with that growth
    size +________,'
         +--------+-------- distance to the geometry
               radius              beyond ``reach`` nothing is asked for

Every source is a callable of points (n, 3) -> sizes (n,), infinite where it asks for nothing.
``slope`` bounds how fast its sizes change, ``marks`` (k, 3) lie where it is smallest: whoever
samples it can tell what may hide between two samples, and where to look first.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from surfmesh.errors import SizingError, shown
from surfmesh.geometry.planar.segment_distance import SegmentDistance
from surfmesh.sizing.options.distance_size import polylines
from surfmesh.sizing.options.positive import positive
from surfmesh.sizing.options.size_laws import as_numbers, checked_sizes
from surfmesh.truth_value import truth_value

MARK_STEP = 4.0
"""Marks along lines and within boxes are so many sizes apart,"""

MOST_MARKS = 4000
"""but no more than so many a source."""


class Source:
    """What all local sizes have in common: ``size`` that grows with the distance.

    size: wanted edge length. growth: ratio of neighbouring sizes away from the geometry, above 1.
    radius: up to this distance the size is ``size``. reach: farther away nothing is asked for;
    None: as far as the sizes have grown. Lengths are in model units.
    """

    size: float
    growth: float
    radius: float
    reach: float | None

    def _check(self) -> None:
        object.__setattr__(self, "size", positive("size", self.size))
        self._check_growth()

    def _check_growth(self) -> None:
        object.__setattr__(self, "growth", positive("growth", self.growth))
        if self.growth <= 1.0:
            raise SizingError(f"growth must be above 1, not {self.growth:g}")
        if self.reach is not None:
            object.__setattr__(self, "reach", positive("reach", self.reach))

    @property
    def slope(self) -> float:
        """Size per distance."""
        return 2.0 * (self.growth - 1.0) / (self.growth + 1.0)

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """Wanted edge lengths (n,) at points (n, 3)."""
        distance = self.distance(np.asarray(points, float))
        sizes = self.size + self.slope * np.maximum(distance - self.radius, 0.0)
        return sizes if self.reach is None else np.where(distance <= self.reach, sizes, np.inf)

    def distance(self, points: np.ndarray) -> np.ndarray:
        """Distances (n,) of points (n, 3) from the geometry, model units."""
        raise NotImplementedError

    @cached_property
    def marks(self) -> np.ndarray:
        """(k, 3) points where the size is smallest."""
        raise NotImplementedError

    def box(self, largest: float) -> tuple[np.ndarray, np.ndarray]:
        """Corners (3,), (3,) of a box outside of which nothing below ``largest`` is asked for."""
        away = self.radius + max(largest - self.size, 0.0) / self.slope
        away = min(away, np.inf if self.reach is None else self.reach)
        low, high = self._extent()
        return low - away, high + away

    def _extent(self) -> tuple[np.ndarray, np.ndarray]:
        return self.marks.min(axis=0), self.marks.max(axis=0)


@dataclass(frozen=True, eq=False)
class Near(Source):
    """``size`` within ``radius`` of points or polylines, growing with the distance from there.

    geometry: points (n, 3), a point (3,); or polylines: a list of arrays (k, 3). Two coordinates
    are taken in the plane z = 0. lines=True joins points (n, 3) to one polyline. size: wanted edge
    length. growth: ratio of neighbouring sizes away from it. reach: farther away nothing is asked
    for; None: as far as the sizes have grown. Lengths are in model units.

    Raises ``SizingError`` for numbers that are not positive and for other geometry.
    """

    geometry: Any
    size: float
    growth: float = 1.2
    radius: float = 0.0
    reach: float | None = None
    lines: bool = False

    def __post_init__(self) -> None:
        self._check()
        object.__setattr__(self, "lines", truth_value("lines", self.lines))
        is_scalar = np.isscalar(self.radius)
        if isinstance(self.radius, str) or not is_scalar or not (0.0 <= self.radius < np.inf):
            raise SizingError(f"radius must be a number from 0, not {shown(self.radius)}")
        given = self.geometry
        if isinstance(given, np.ndarray) or _is_points(given):
            numbers = as_numbers(given)
            if numbers is None:
                raise SizingError(f"the geometry is not made of points: {shown(given)}")
            rows = np.atleast_2d(numbers)
            given = [rows] if self.lines else [row[None] for row in rows]
        object.__setattr__(self, "geometry", polylines(given))

    def distance(self, points: np.ndarray) -> np.ndarray:
        return self._segments(points)

    @cached_property
    def _segments(self) -> SegmentDistance:
        starts = [line[: max(1, len(line) - 1)] for line in self.geometry]
        ends = [line[-max(1, len(line) - 1) :] for line in self.geometry]
        return SegmentDistance(np.concatenate(starts), np.concatenate(ends))

    @cached_property
    def marks(self) -> np.ndarray:
        """(k, 3) points where the size is smallest."""
        length = sum(float(_steps(line).sum()) for line in self.geometry)
        step = max(MARK_STEP * max(self.size, self.radius), length / MOST_MARKS)
        found = []
        for line in self.geometry:
            way = np.r_[0.0, np.cumsum(_steps(line))]
            at = np.union1d(way, np.linspace(0.0, way[-1], 1 + int(np.ceil(way[-1] / step))))
            found.append(np.stack([np.interp(at, way, line[:, k]) for k in range(3)], axis=1))
        return np.concatenate(found)

    def __repr__(self) -> str:
        points = sum(len(line) for line in self.geometry)
        what = "points" if points == len(self.geometry) else f"lines of {points} points"
        return f"Near({len(self.geometry)} {what}, size={self.size:g})"


@dataclass(frozen=True, eq=False)
class InBall(Source):
    """``size`` in the ball of ``radius`` about ``centre`` (3,), growing outside.

    reach: distance from the centre beyond which nothing is asked for; None: no end. Otherwise as
    ``Near``, ``SizingError`` included.
    """

    centre: Sequence[float]
    radius: float
    size: float
    growth: float = 1.2
    reach: float | None = None

    def __post_init__(self) -> None:
        self._check()
        object.__setattr__(self, "radius", positive("radius", self.radius))
        object.__setattr__(self, "centre", _point("centre", self.centre))

    def distance(self, points: np.ndarray) -> np.ndarray:
        return np.linalg.norm(points - np.asarray(self.centre), axis=1)

    @cached_property
    def marks(self) -> np.ndarray:
        """(k, 3) points where the size is smallest."""
        return np.asarray(self.centre)[None]

    def __repr__(self) -> str:
        return f"InBall({_listed(self.centre)}, radius={self.radius:g}, size={self.size:g})"


@dataclass(frozen=True, eq=False)
class InBox(Source):
    """``size`` in a box along the axes, growing outside.

    low, high: (3,) its corners with the smallest and the largest coordinates. reach: distance from
    the box beyond which nothing is asked for; None: no end. Otherwise as ``Near``, ``SizingError``
    included.
    """

    low: Sequence[float]
    high: Sequence[float]
    size: float
    growth: float = 1.2
    reach: float | None = None

    radius = 0.0

    def __post_init__(self) -> None:
        self._check()
        for name in ("low", "high"):
            object.__setattr__(self, name, _point(name, getattr(self, name)))
        low, high = self._extent()
        if (low > high).any():
            raise SizingError(
                f"a box from {_listed(self.low)} to {_listed(self.high)} is inside out"
            )

    def distance(self, points: np.ndarray) -> np.ndarray:
        low, high = self._extent()
        outside = np.maximum(np.maximum(low - points, points - high), 0.0)
        return np.linalg.norm(outside, axis=1)

    @cached_property
    def marks(self) -> np.ndarray:
        """(k, 3) points where the size is smallest."""
        low, high = self._extent()
        extent = high - low
        step = max(MARK_STEP * self.size, float(extent.max()) / 1000.0)
        while True:
            counts = np.ceil(extent / step).astype(int) + 1
            if counts.prod() <= MOST_MARKS:
                break
            step *= 1.3
        axes = [np.linspace(a, b, n) for a, b, n in zip(low, high, counts)]
        return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)

    def _extent(self) -> tuple[np.ndarray, np.ndarray]:
        return np.asarray(self.low), np.asarray(self.high)

    def __repr__(self) -> str:
        return f"InBox({_listed(self.low)}, {_listed(self.high)}, size={self.size:g})"


def source_sizes(sources: tuple[Callable, ...], points: np.ndarray) -> np.ndarray:
    """The smallest size (n,) that any source asks for at points (n, 3); infinite for none.

    Raises ``SizingError`` when a source gives something else than (n,) positive numbers.
    """
    least = np.full(len(points), np.inf)
    for source in sources:
        np.minimum(least, checked_sizes(source, points, "source"), out=least)
    return least


def reaching(
    sources: tuple[Callable, ...], low: np.ndarray, high: np.ndarray, largest: float
) -> tuple[Callable, ...]:
    """The sources that may ask for less than ``largest`` in the box from low (3,) to high (3,)."""
    found = []
    for source in sources:
        if isinstance(source, Source):
            first, last = source.box(largest)
            if (first > high).any() or (last < low).any():
                continue
        found.append(source)
    return tuple(found)


def _is_points(given: Any) -> bool:
    """Rows of numbers of one length, and not arrays of rows?"""
    if not isinstance(given, (list, tuple)) or not given:
        return False
    flat = all(np.ndim(row) == 1 for row in given)
    return all(np.isscalar(row) for row in given) or (flat and len({len(r) for r in given}) == 1)


def _steps(line: np.ndarray) -> np.ndarray:
    return np.linalg.norm(np.diff(line, axis=0), axis=1)


def _point(name: str, given: Any) -> np.ndarray:
    try:
        point = np.array(given, float)
    except (TypeError, ValueError, OverflowError):
        point = np.empty(0)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise SizingError(f"{name} must be three finite numbers, not {shown(given)}")
    return point


def _listed(point: Sequence[float] | np.ndarray) -> str:
    return "(" + ", ".join(f"{x:g}" for x in point) + ")"
