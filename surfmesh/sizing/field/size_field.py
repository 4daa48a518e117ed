"""The size field of one surface: wanted sizes everywhere, ready for the core."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from surfmesh._core import elementary_functions
from surfmesh._core.fields import Background
from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.differential.sides import SideTopology
from surfmesh.geometry.surface import Surface
from surfmesh.sizing.field.field_builder import FieldBuilder
from surfmesh.sizing.field.size_law import SizeLaw, TensorLaw
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.rim_rule import Rims
from surfmesh.sizing.rules.size_limits import SizeLimits

COUNTABLE = 1e18
"""More circles or triangles than that are as many."""


@dataclass(frozen=True)
class SizeField:
    """Wanted sizes on one surface, ready for the core.

    ``background`` gives size tensors in the scaled plane of ``chart``.
    """

    chart: Chart
    background: Background
    law: SizeLaw | TensorLaw
    """What it is made from."""

    @property
    def sizing(self) -> Sizing:
        """What was asked for, defaults filled in."""
        return self.law.sizing

    @property
    def is_anisotropic(self) -> bool:
        """Do the sizes depend on the direction?"""
        return self.background.is_anisotropic

    def expected_vertices(self) -> int:
        """About how many circles cover the domain."""
        return self._expected_vertices

    @cached_property
    def _expected_vertices(self) -> int:
        width, height = self.chart.extent.tolist()
        return self.background.expected_circles(width, height)

    def sizes(self, xy: np.ndarray) -> np.ndarray:
        """Wanted edge lengths (n,) at points xy (n, 2) of the scaled plane, the shorter of two."""
        return self.background.scalar_sizes(xy)

    def metric_roots_3d(self, xy: np.ndarray) -> np.ndarray:
        """W (n, 6) at points xy (n, 2), for steps in space: see ``metric_roots``."""
        return self.background.metric_roots_3d(xy)

    def tensors(self, xy: np.ndarray) -> np.ndarray:
        """Size tensors (n, 3) at points xy (n, 2) of the scaled plane."""
        return self.background.sizes(xy)

    def metric_lengths(self, xy: np.ndarray, steps: np.ndarray) -> np.ndarray:
        """|H^-1 step| (n,) of small steps (n, 2) at points xy (n, 2) of the scaled plane."""
        a = self.background.metric_roots(xy)
        dx, dy = steps.T
        return elementary_functions.hypot(a[:, 0] * dx + a[:, 1] * dy, a[:, 1] * dx + a[:, 2] * dy)


def size_field(
    surface: Surface,
    sizing: Sizing,
    sides: SideTopology | None = None,
    limits: SizeLimits | None = None,
    rims: Rims | None = None,
    chart: Chart | None = None,
    coarseness: float = 1.0,
) -> SizeField:
    """Build the background for ``surface``; ``sides`` tells which sides are joined.

    ``limits``: upper bounds of the size near points, from an earlier round. ``rims``: where the
    surface ends, of a surface of formulas: the edges of a CAD model are cut before its faces.
    ``chart``: of the surface; None: it is made. ``coarseness``: sizes between nodes may be wrong by
    so many times more than in a field for a mesh.

    Raises ``SizingError`` when a size law gives something else than positive numbers, or when
    the wanted sizes need an unreasonable number of cells.
    """
    law = SizeLaw.of(surface, sizing, limits, rims, chart)
    return SizeField(law.chart, FieldBuilder(law, sides, coarseness).background(), law)


def plane_field(
    surface: Surface, tensors: Callable[[np.ndarray], np.ndarray], growth: float
) -> SizeField:
    """The background of size tensors over the box of a plane: ``tensors`` (n, 2) -> (n, 3).

    Raises ``SizingError`` when they need an unreasonable number of cells.
    """
    law = TensorLaw(surface, Sizing(size=1.0, growth=growth), tensors)
    return SizeField(law.chart, FieldBuilder(law).background(), law)
