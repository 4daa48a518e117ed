"""Features of a surface that lie between the samples of a cell, where its derivatives are bounded.

Where the surface can bound them over a cell (formulas can, by interval arithmetic), a cell may hide
something while the bound admits a curvature that would at least halve the size.
"""

from typing import NamedTuple

import numpy as np

from surfmesh._core import elementary_functions
from surfmesh.geometry.differential.infinite_speed import at_infinite_speed, bent_axes_of
from surfmesh.geometry.formulas.interval import width_along
from surfmesh.geometry.surface import BoundedSurface
from surfmesh.sizing.field.size_law import SizeLaw

HIDDEN_RISE = 0.25
"""Of ``chord``: what rises less within a cell is no feature."""

CELLS_AT_ONCE = 50_000
"""Cells of which bounds are taken at a time: they take much memory."""


class SeenCells(NamedTuple):
    """Cells, with what is known at their nine nodes."""

    low: np.ndarray  # (n, 2) corners in the chart
    high: np.ndarray  # (n, 2)
    normal: np.ndarray  # (n, 3) at the middle
    root: np.ndarray  # (n, 9, 3) I^(1/2) in the scaled plane
    smallest: np.ndarray  # (n,) of the nine sizes

    def parts(self) -> "list[SeenCells]":
        """A part of them at a time."""
        starts = range(0, len(self.low), CELLS_AT_ONCE)
        cuts = (slice(k, k + CELLS_AT_ONCE) for k in starts)
        return [SeenCells(*(array[cut] for array in self)) for cut in cuts]

    def corners(self, law: SizeLaw) -> tuple[np.ndarray, np.ndarray]:
        """(n, 2), (n, 2) in (u, v)."""
        return law.chart.to_uv(self.low), law.chart.to_uv(self.high)


def may_bend(law: SizeLaw, cells: SeenCells) -> np.ndarray:
    """Cells (n,) whose second derivatives may be such that half the size is needed."""
    parts = [_may_bend(law, part) for part in cells.parts()]
    return np.concatenate(parts) if parts else np.zeros(0, bool)


def may_rise(law: SizeLaw, chord: float, cells: SeenCells) -> np.ndarray:
    """Cells (n,) in which the surface may lie off its tangent plane by a fraction of chord.

    By the mean value or by its values, which hold across kinks and jumps too.
    """
    parts = [_may_rise(law, chord, part) for part in cells.parts()]
    return np.concatenate(parts) if parts else np.zeros(0, bool)


def _may_bend(law: SizeLaw, cells: SeenCells) -> np.ndarray:
    lo, hi = cells.corners(law)
    bounds = law.surface.derivative_bounds(lo, hi)
    if bounds is None:
        return np.zeros(len(cells.low), bool)
    normal = np.abs(cells.normal)
    du, dv = law.chart.rates(0.5 * (cells.low + cells.high)).T
    second = np.maximum(np.abs(bounds[0]), np.abs(bounds[1]))[:, 2:]
    second *= np.stack([du * du, du * dv, dv * dv], axis=1)[:, :, None]
    with np.errstate(over="ignore", invalid="ignore"):
        form = np.einsum("nki,ni->nk", second, normal)  # |L|, |M|, |N| at most
    root = cells.root
    e = (root[..., 0] ** 2 + root[..., 1] ** 2).max(axis=1)
    g = (root[..., 1] ** 2 + root[..., 2] ** 2).max(axis=1)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        bound = np.sqrt(
            (form[:, 0] / e) ** 2 + 2.0 * form[:, 1] ** 2 / (e * g) + (form[:, 2] / g) ** 2
        )
    possible = law.from_curvature(np.where(np.isnan(bound), np.inf, bound))
    hides = possible < 0.5 * cells.smallest
    # beside a rim of infinite speed there is no bound at any depth: there the report looks
    return hides & ~at_infinite_speed(bent_axes_of(law.surface), lo, hi)


def _may_rise(law: SizeLaw, chord: float, cells: SeenCells) -> np.ndarray:
    if not isinstance(law.surface, BoundedSurface):
        return np.zeros(len(cells.low), bool)
    lo, hi = cells.corners(law)
    lower, upper = law.surface.all_bounds(lo, hi)
    normal = cells.normal[:, None]
    half = 0.5 * (hi - lo)
    with np.errstate(invalid="ignore", over="ignore"):
        value = width_along(lower[:, 0], upper[:, 0], normal)[:, 0]
        slopes = [width_along(lower[:, k], upper[:, k], normal)[:, 0] for k in (1, 2)]
        bent = half[:, 0] * slopes[0] + half[:, 1] * slopes[1]
    # no size could follow what is narrower than the least of them: the report finds it
    step = np.abs(cells.high - cells.low)
    root = cells.root[:, 4]
    wide = elementary_functions.hypot(root[:, 0], root[:, 1]) * step[:, 0] > law.clamp[0]
    wide |= elementary_functions.hypot(root[:, 1], root[:, 2]) * step[:, 1] > law.clamp[0]
    return wide & ~(np.fmin(value, bent) <= HIDDEN_RISE * chord)
