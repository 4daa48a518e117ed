"""Curves and surfaces at a fixed distance from others, with exact derivatives.

    curve      c + d m / |m|     m = c' x a in space, (c'_y, -c'_x) in the plane
    surface    r + d n           n = N / |N|, N = r_u x r_v

They are evaluated by the compiled core (``src/surfaces/offset_surface.hpp``, ``offset_curve.hpp``).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from surfmesh._core import surfaces
from surfmesh.errors import SurfaceError
from surfmesh.geometry.cad_surfaces.curves import CoreCurve, PlainCurve
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.cad_surfaces.plain_data import frozen_array


@dataclass(frozen=True, eq=False, repr=False)
class OffsetCurve(PlainCurve):
    """A curve beside another. Where that one has no tangent, the offset is that close by."""

    curve: CoreCurve
    distance: float
    direction: np.ndarray | None = None  # (3,) a, for a curve in space; None in the plane
    limits: tuple[float, float] | None = None  # the part in use; see `Curve.with_limits`

    kind = "offset"

    def __post_init__(self) -> None:
        if (self.direction is None) != (self.curve.dimension == 2):
            raise SurfaceError("an offset curve has a direction in space, and none in the plane")
        if self.direction is not None:
            self._set(direction=frozen_array(self.direction))
        if self.limits is not None:
            self._set(curve=self.curve.with_limits(*self.limits))
        core = self.curve.core
        self._set(core=surfaces.offset_curve(core, self.distance, self.direction, self.limits))

    @property
    def period(self) -> float | None:
        return self.curve.period

    def with_limits(self, first: float, last: float) -> Self:
        return replace(self, limits=(float(first), float(last)))


@dataclass(frozen=True, eq=False, repr=False)
class OffsetSurface(FaceSurface):
    """A surface beside another, which must know its third derivatives.

    Where that one has no normal (a pole), r lies on the limit of the normal from inside the
    domain, and the derivatives are those a little further inside.
    """

    basis: FaceSurface
    distance: float  # along r_u x r_v

    kind = "offset"

    @property
    def periods(self) -> tuple[float | None, float | None]:
        return self.basis.periods

    @property
    def pieces(self) -> int:
        return self.basis.pieces

    def evaluate(self, uv: np.ndarray, order: int = 0) -> tuple[np.ndarray, ...]:
        """As every surface, for order 0 to 2; raises SurfaceError for 3."""
        if order > 2:
            raise SurfaceError(f"{self.name}: an offset surface has derivatives to order 2 only")
        return super().evaluate(uv, order)

    def _made(self) -> surfaces.Surface:
        if self.basis.domain != self.domain:
            self._set(basis=self.basis.with_domain(self.domain))
        return surfaces.offset_surface(self.basis.core, self.distance)
