"""The edge length that the curvature of a rim allows, the part within the surface included.

A rim is a space curve: between two nodes h apart it sags by h^2 k / 8 from its chord, where k is
its own curvature. The surface's normal curvature is only a part of that: a flat disc has none.

       .--- rim ---.        k^2 = (normal curvature along the rim)^2 + (geodesic curvature)^2
     o-- mesh edge --o
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from surfmesh._core import sizing as core
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.differential.sides import SideTopology
from surfmesh.geometry.surface import Surface
from surfmesh.sizing.rules.chord_rule import ChordRule
from surfmesh.sizing.rules.rule import DirectedLimits, DirectedRule, Places
from surfmesh.sizing.rules.size_limits import SizeLimits, along_lines

FIRST_SAMPLES, SAMPLES_AN_EDGE, MOST_SAMPLES = 1024, 4, 1 << 16
"""Points of all loops that are looked at first; then so many for each edge, and of one line."""


class RimSizes(NamedTuple):
    """Sizes that hold along a rim only, at n points of it: bounds as ``SizeLimits`` are."""

    sizes: np.ndarray  # (n,) model units, infinite where the rim is straight
    tangent: np.ndarray  # (n, 3) unit

    def chosen(self, rows: np.ndarray) -> "RimSizes":
        return RimSizes(self.sizes[rows], self.tangent[rows])

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """The sizes at the n points themselves, which the other methods are asked about too."""
        return self.sizes

    def along(self, points: np.ndarray, directions: np.ndarray) -> np.ndarray:
        """Largest sizes (k, n) in k unit directions (k, n, 3)."""
        cosine = np.abs(np.einsum("kni,ni->kn", directions, self.tangent))
        return self.sizes / np.maximum(cosine, np.finfo(float).eps)

    def tightest(self, points: np.ndarray, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The smallest size (n,) in any direction, and that direction (n, 3)."""
        return self.sizes, self.tangent


def rim_sizes(surface: Surface, uv: np.ndarray, step: np.ndarray, chord: float) -> RimSizes:
    """Of the straight lines of (u, v) through uv (n, 2) in the directions ``step`` (n, 2).

    ``chord``: model units. Infinite where the line has no speed, as at a pole.
    """
    sizes, tangent = core.rim_sizes(
        as_core_surface(surface), np.ascontiguousarray(uv), np.ascontiguousarray(step), chord
    )
    return RimSizes(sizes, tangent)


@dataclass(frozen=True)
class RimRule(DirectedRule):
    """``chord`` along an open side of the (u, v) rectangle."""

    surface: Surface
    chart: Chart
    side: int
    chord: float

    def __str__(self) -> str:
        return f"{self.stated_as} at the rim's own curvature"

    @property
    def stated_as(self) -> ChordRule:
        return ChordRule(self.chord)

    def limits(self, at: Places) -> tuple[np.ndarray, DirectedLimits]:
        width, height = self.chart.extent
        across, place = ((1, 0.0), (0, width), (1, height), (0, 0.0))[self.side]
        rows = np.flatnonzero(at.xy[:, across] == place)
        if not len(rows):
            return rows, RimSizes(np.empty(0), np.empty((0, 3)))
        step = np.zeros((len(rows), 2))
        step[:, 1 - across] = 1.0
        return rows, rim_sizes(self.surface, at.uv[rows], step, self.chord)


@dataclass(frozen=True)
class LoopRule(DirectedRule):
    """``chord`` along trimming loops."""

    chord: float
    near_loops: SizeLimits

    def __str__(self) -> str:
        return f"{self.stated_as} at a trimming loop's own curvature"

    @property
    def stated_as(self) -> ChordRule:
        return ChordRule(self.chord)

    def limits(self, at: Places) -> tuple[np.ndarray, DirectedLimits]:
        return np.arange(len(at.points)), self.near_loops


class Rims:
    """Where a surface of formulas ends: open sides of its (u, v) rectangle, or trimming loops."""

    def __init__(self, surface: Surface, sides: SideTopology) -> None:
        self.surface = surface
        loops = [np.asarray(loop, float) for loop in surface.loops]
        lines = [np.stack([loop, np.roll(loop, -1, axis=0)], axis=1) for loop in loops]
        self.lines = np.concatenate(lines) if lines else np.empty((0, 2, 2))
        """(s, 2, 2) start and end of the segments of the loops, in (u, v)"""
        self.open = [] if lines else [
            side for side in range(4) if sides.partner[side] < 0 and not sides.collapsed[side]
        ]  # fmt: skip

    def rules(
        self, chart: Chart, chord: float, slope: float,
        allowed: Callable[[np.ndarray], np.ndarray], narrow: bool,
    ) -> Iterator[DirectedRule]:  # fmt: skip
        """One for each open side; one for the loops, where these bend more than the surface does.

        allowed: sizes (n,) by the curvature of the surface at uv (n, 2). narrow: the limits of
        loops hold along them, not across them.
        """
        for side in self.open:
            yield RimRule(self.surface, chart, side, chord)
        limits = self._on_loops(chord, slope, allowed, narrow)
        if limits is not None:
            yield LoopRule(chord, limits)

    def _on_loops(
        self, chord: float, slope: float, allowed: Callable[[np.ndarray], np.ndarray], narrow: bool
    ) -> SizeLimits | None:
        if not len(self.lines):
            return None
        parts = np.full(len(self.lines), max(2, FIRST_SAMPLES // len(self.lines)))
        points, uv, found = self._sampled(parts, chord)
        line = np.repeat(np.arange(len(parts)), parts)
        speed = np.linalg.norm(points[1] - points[0], axis=1)  # lengths of the parts
        wanted = np.bincount(line, SAMPLES_AN_EDGE * speed / found.sizes, len(parts))
        parts = np.maximum(parts, np.ceil(np.minimum(wanted, MOST_SAMPLES)).astype(np.int64))
        points, uv, found = self._sampled(parts, chord)
        rows = np.flatnonzero(found.sizes < allowed(uv))
        if not len(rows):
            return None
        found = found.chosen(rows)
        tensors = along_lines(found.tangent, found.sizes) if narrow else None
        return SizeLimits(points[2][rows], found.sizes, slope, uv[rows], metric_root_3d=tensors)

    def _sampled(
        self, parts: np.ndarray, chord: float
    ) -> tuple[list[np.ndarray], np.ndarray, RimSizes]:
        """Points (n, 3) at start, end and middle of so many equal parts of each line, the
        parameters (n, 2) and the sizes of the middles."""
        line = np.repeat(np.arange(len(parts)), parts)
        place = np.arange(len(line)) - np.repeat(np.cumsum(parts) - parts, parts)
        start, end = self.lines[line].transpose(1, 0, 2)
        uv = [start + ((place + t) / parts[line])[:, None] * (end - start) for t in (0.0, 1.0, 0.5)]
        points = [self.surface.evaluate(each, 0)[0] for each in uv]
        return points, uv[2], rim_sizes(self.surface, uv[2], end - start, chord)
