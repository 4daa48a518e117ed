"""The chart of a surface, the scaled plane (x, y): u and v stretched so that speeds are about one.

x is a function of u alone, with dx/du the mean over v of |r_u|, and y likewise of v, but for an
axis that runs to elongated poles, which is scaled. The core makes it, see
src/surfaces/chart_making.hpp, and evaluates it; here is what is known of a surface before it is
sampled, and the way to bent parameters, for which SciPy inverts the incomplete beta function.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from surfmesh._core import surfaces
from surfmesh._core.surfaces import CHART_SAMPLES, CHART_SAMPLES_OF_PIECE
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.differential.infinite_speed import STRAIGHT, BentAxes, bent_axes_of, is_bent
from surfmesh.geometry.surface import Domain, Surface, smooth_pieces, steady_axes


@dataclass(frozen=True)
class Chart:
    """Coordinates of one surface: its (u, v) and the scaled plane (x, y), axis by axis."""

    core: surfaces.Chart = field(repr=False)
    """The same as the core has it, between the plane and (u, v) or bent parameters."""
    bent: BentAxes = STRAIGHT
    """Where speeds have no bound."""

    def __reduce__(self) -> tuple[Callable[..., Chart], tuple]:
        axes = self.core.u, self.core.v
        arrays = tuple((axis.extent, axis.knots, axis.slopes) for axis in axes)
        return _of_arrays, (arrays, self.bent, self.core.scaling)

    @classmethod
    def of(cls, surface: Surface) -> Chart:
        bent = bent_axes_of(surface)
        pieces = smooth_pieces(surface)
        samples = CHART_SAMPLES
        if pieces is not None:
            samples = min(CHART_SAMPLES_OF_PIECE * pieces + 1, CHART_SAMPLES)
        made = surfaces.Chart.of(
            as_core_surface(surface), steady_axes(surface), _pieces(bent), samples,
            to_poles=not len(surface.loops),
        )  # fmt: skip
        return cls(made, bent)

    @classmethod
    def uniform(cls, domain: Domain, speeds: tuple[float, float]) -> Chart:
        """For a surface whose |r_u| and |r_v| are the same everywhere: nothing is sampled."""
        return cls(surfaces.Chart.uniform(domain, speeds))

    @property
    def extent(self) -> np.ndarray:
        """Width and height of the domain in the scaled plane."""
        return np.array([self.core.u.extent, self.core.v.extent])

    def to_plane(self, uv: np.ndarray) -> np.ndarray:
        """uv (n, 2) -> xy (n, 2)."""
        if is_bent(self.bent):
            uv = np.array(uv, float)
            for k, axis in enumerate(self.bent):
                if axis is not None:
                    uv[:, k] = axis.bent(uv[:, k])
        return self.core.to_plane(np.ascontiguousarray(uv, float))

    def to_uv(self, xy: np.ndarray) -> np.ndarray:
        """xy (n, 2) -> uv (n, 2)."""
        return self.to_uv_and_rates(xy)[0]

    def rates(self, xy: np.ndarray) -> np.ndarray:
        """(du/dx, dv/dy) at xy (n, 2) -> (n, 2)."""
        return self.to_uv_and_rates(xy)[1]

    def to_uv_and_rates(self, xy: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """xy (n, 2) -> uv (n, 2) and (du/dx, dv/dy) (n, 2).

        Linear outside the domain, constant where the parameter is bent.
        """
        return self.core.to_uv_and_rates(np.ascontiguousarray(xy, float))


def _pieces(bent: BentAxes) -> tuple[np.ndarray | None, np.ndarray | None]:
    """What the core is told of bent axes."""
    u, v = (None if axis is None else axis.pieces() for axis in bent)
    return u, v


def _of_arrays(arrays: tuple, bent: BentAxes, scaling: tuple | None) -> Chart:
    """The chart that was taken apart for another process."""
    u, v = (
        surfaces.ChartAxis(extent, knots, slopes, own)
        for (extent, knots, slopes), own in zip(arrays, _pieces(bent), strict=True)
    )
    return Chart(surfaces.Chart(u, v, scaling), bent)
