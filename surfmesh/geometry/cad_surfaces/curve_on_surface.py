"""A curve in space that a surface makes of a p-curve: c(t) = r(u(p), v(p)), p linear in t.

c'  = r_u u' + r_v v'
c'' = r_uu u'^2 + 2 r_uv u' v' + r_vv v'^2 + r_u u'' + r_v v''
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from surfmesh.geometry.cad_surfaces.curves import Curve
from surfmesh.geometry.cad_surfaces.plain_data import PlainData
from surfmesh.geometry.surface import Surface


@dataclass(frozen=True, eq=False, repr=False)
class CurveOnSurface(PlainData):
    """surface: r(u, v). pcurve: in its (u, v), with the parameter p = shift + rate t."""

    surface: Surface
    pcurve: Curve
    shift: float
    rate: float

    kind = "on surface"
    period: ClassVar[float | None] = None
    dimension = 3

    def evaluate(self, t: np.ndarray, order: int = 0) -> tuple[np.ndarray, ...]:
        """(n,) float -> (n, 3) float arrays: (c, c', c'')[: order + 1]; order is at most 2."""
        p = self.shift + self.rate * np.asarray(t, float).reshape(-1)
        uv = self.pcurve.evaluate(p, order)
        r = self.surface.evaluate(uv[0], order)
        results = [r[0]]
        if order > 0:
            du, dv = (self.rate * uv[1]).T[..., None]
            results.append(r[1] * du + r[2] * dv)
        if order > 1:
            d2u, d2v = (self.rate**2 * uv[2]).T[..., None]
            bent = r[3] * du**2 + 2.0 * r[4] * du * dv + r[5] * dv**2
            results.append(bent + r[1] * d2u + r[2] * d2v)
        return tuple(results)

    def with_limits(self, first: float, last: float) -> Self:
        """Itself: the p-curve has the limits."""
        return self
