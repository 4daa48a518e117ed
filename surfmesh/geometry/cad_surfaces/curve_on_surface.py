"""A curve in space that a surface makes of a p-curve: c(t) = r(u(p), v(p)), p linear in t.

c'  = r_u u' + r_v v'
c'' = r_uu u'^2 + 2 r_uv u' v' + r_vv v'^2 + r_u u'' + r_v v''

It is evaluated by the compiled core (``src/surfaces/curve_on_surface.hpp``).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Self

from surfmesh._core import surfaces
from surfmesh.geometry.cad_surfaces.curves import CoreCurve, PlainCurve
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface


@dataclass(frozen=True, eq=False, repr=False)
class CurveOnSurface(PlainCurve):
    """surface: r(u, v). pcurve: in its (u, v), with the parameter p = shift + rate t.

    It has derivatives up to the second.
    """

    surface: FaceSurface
    pcurve: CoreCurve
    shift: float
    rate: float

    kind = "on surface"
    period: ClassVar[float | None] = None

    def __post_init__(self) -> None:
        core = surfaces.curve_on_surface(self.surface.core, self.pcurve.core, self.shift, self.rate)
        self._set(core=core)

    def with_limits(self, first: float, last: float) -> Self:
        """Itself: the p-curve has the limits."""
        return self
