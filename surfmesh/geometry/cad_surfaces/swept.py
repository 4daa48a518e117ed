"""Surfaces that a curve sweeps: along a line, or round an axis.

    extrusion     r(u, v) = c(u) + v d
    revolution    r(u, v) = c(v) turned by the angle u about the axis

They are evaluated by the compiled core (``src/surfaces/swept_surfaces.hpp``).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from surfmesh._core import surfaces
from surfmesh.geometry.cad_surfaces.curves import CoreCurve
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve, knot_spans
from surfmesh.geometry.cad_surfaces.offset import OffsetCurve
from surfmesh.geometry.cad_surfaces.plain_data import frozen_array


@dataclass(frozen=True, eq=False, repr=False)
class ExtrusionSurface(FaceSurface):
    curve: CoreCurve  # in space, its parameter is u
    direction: np.ndarray  # (3,) of unit length, so that v is a length

    kind = "extrusion"
    steady_axes = (False, True)

    @property
    def periods(self) -> tuple[float | None, float | None]:
        return self.curve.period, None

    @property
    def pieces(self) -> int:
        return _pieces(self.curve, *self.domain[0])

    def _made(self) -> surfaces.Surface:
        curve = self.curve.with_limits(*self.domain[0])
        self._set(curve=curve, direction=frozen_array(self.direction))
        return surfaces.extrusion(self.domain, curve.core, self.direction)


@dataclass(frozen=True, eq=False, repr=False)
class RevolutionSurface(FaceSurface):
    curve: CoreCurve  # in space, its parameter is v
    origin: np.ndarray  # (3,) a point of the axis
    axis: np.ndarray  # (3,) of unit length; u is counter-clockwise seen against it

    kind = "revolution"
    steady_axes = (True, False)

    @property
    def periods(self) -> tuple[float | None, float | None]:
        return 2.0 * pi, self.curve.period

    @property
    def pieces(self) -> int:
        return _pieces(self.curve, *self.domain[1])

    def _made(self) -> surfaces.Surface:
        curve = self.curve.with_limits(*self.domain[1])
        self._set(curve=curve, origin=frozen_array(self.origin), axis=frozen_array(self.axis))
        return surfaces.revolution(self.domain, curve.core, self.origin, self.axis)


def _pieces(curve: CoreCurve, first: float, last: float) -> int:
    if isinstance(curve, OffsetCurve):
        curve = curve.curve
    return knot_spans(curve.knots, first, last) if isinstance(curve, BSplineCurve) else 1
