"""Surfaces that a curve sweeps: along a line, or round an axis.

    extrusion     r(u, v) = c(u) + v d
    revolution    r(u, v) = c(v) turned by the angle u about the axis

With q = c - o for a point o of the axis and its direction a, q splits into the part h along
the axis and the part p across it; turned by u it is h + cos u p + sin u (a x p).

Source: OCCT, Geom_SurfaceOfLinearExtrusion, Geom_SurfaceOfRevolution (parametrisations).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import pi

import numpy as np

from surfmesh.geometry.cad_surfaces.curves import Curve
from surfmesh.geometry.cad_surfaces.face_surface import (
    DERIVATIVES,
    FaceSurface,
    derivative_count,
    parameter_pairs,
)
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve, knot_spans
from surfmesh.geometry.cad_surfaces.offset import OffsetCurve
from surfmesh.geometry.cad_surfaces.plain_data import frozen_array


@dataclass(frozen=True, eq=False, repr=False)
class ExtrusionSurface(FaceSurface):
    curve: Curve  # in space, its parameter is u
    direction: np.ndarray  # (3,) of unit length, so that v is a length

    kind = "extrusion"

    def __post_init__(self) -> None:
        super().__post_init__()
        curve = self.curve.with_limits(*self.domain[0])
        self._set(curve=curve, direction=frozen_array(self.direction))

    @property
    def periods(self) -> tuple[float | None, float | None]:
        return self.curve.period, None

    @property
    def pieces(self) -> int:
        return _pieces(self.curve, *self.domain[0])

    def evaluate(self, uv: np.ndarray, order: int = 0) -> tuple[np.ndarray, ...]:
        uv = parameter_pairs(uv)
        along = self.curve.evaluate(uv[:, 0], order)
        results = np.zeros((derivative_count(order), len(uv), 3))
        for number, (k, l) in enumerate(DERIVATIVES[: len(results)]):
            if l == 0:
                results[number] = along[k]
        results[0] += uv[:, 1:] * self.direction
        if order:
            results[2] = self.direction
        return tuple(results)


@dataclass(frozen=True, eq=False, repr=False)
class RevolutionSurface(FaceSurface):
    curve: Curve  # in space, its parameter is v
    origin: np.ndarray  # (3,) a point of the axis
    axis: np.ndarray  # (3,) of unit length; u is counter-clockwise seen against it
    _parts: tuple[np.ndarray, ...] = field(init=False)  # (3, 3) each

    kind = "revolution"

    def __post_init__(self) -> None:
        super().__post_init__()
        curve = self.curve.with_limits(*self.domain[1])
        self._set(curve=curve, origin=frozen_array(self.origin), axis=frozen_array(self.axis))
        along = np.outer(self.axis, self.axis)
        beside = np.cross(self.axis, np.eye(3))  # q @ beside = axis x q
        self._set(_parts=(along, np.eye(3) - along, beside))

    @property
    def periods(self) -> tuple[float | None, float | None]:
        return 2.0 * pi, self.curve.period

    @property
    def pieces(self) -> int:
        return _pieces(self.curve, *self.domain[1])

    def evaluate(self, uv: np.ndarray, order: int = 0) -> tuple[np.ndarray, ...]:
        uv = parameter_pairs(uv)
        moved = np.array(self.curve.evaluate(uv[:, 1], order))  # (order + 1, n, 3)
        moved[0] -= self.origin
        along, across, beside = (moved @ part for part in self._parts)
        cos, sin = np.cos(uv[:, :1]), np.sin(uv[:, :1])
        results = np.empty((derivative_count(order), len(uv), 3))
        turns = ((cos, sin), (-sin, cos), (-cos, -sin), (sin, -cos))
        for number, (k, l) in enumerate(DERIVATIVES[: len(results)]):
            c, s = turns[k]
            np.multiply(c, across[l], out=results[number])
            results[number] += s * beside[l]
            if k == 0:
                results[number] += along[l]
        results[0] += self.origin
        return tuple(results)


def _pieces(curve: Curve, first: float, last: float) -> int:
    if isinstance(curve, OffsetCurve):
        curve = curve.curve
    return knot_spans(curve.knots, first, last) if isinstance(curve, BSplineCurve) else 1
