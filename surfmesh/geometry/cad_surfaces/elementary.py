"""Plane, cylinder, cone, sphere and torus, parametrised as CAD kernels do.

In the frame (origin; x, y, z), with the radius R, the tube's radius r and the half angle a:

    plane      u x + v y
    cylinder   R e(u) + v z                              e(u) = cos u x + sin u y
    cone       (R + v sin a) e(u) + v cos a z
    sphere     R cos v e(u) + R sin v z
    torus      (R + r cos v) e(u) + r sin v z

They are evaluated by the compiled core (``src/surfaces/elementary_surfaces.hpp``). The frame may
be left-handed, which turns the normal round.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from surfmesh._core import surfaces
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.cad_surfaces.plain_data import frozen_array

TURN = 2.0 * pi


@dataclass(frozen=True, eq=False, repr=False)
class _Elementary(FaceSurface):
    origin: np.ndarray  # (3,)
    x: np.ndarray  # (3,) unit vectors at right angles
    y: np.ndarray
    z: np.ndarray

    steady_axes = (True, True)

    def _frame(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        frame = tuple(frozen_array(v) for v in (self.origin, self.x, self.y, self.z))
        origin, x, y, z = frame
        self._set(origin=origin, x=x, y=y, z=z)
        return origin, x, y, z


@dataclass(frozen=True, eq=False, repr=False)
class Plane(_Elementary):
    kind = "plane"

    def _made(self) -> surfaces.Surface:
        origin, x, y, _ = self._frame()
        return surfaces.plane(self.domain, origin, x, y)


@dataclass(frozen=True, eq=False, repr=False)
class Cylinder(_Elementary):
    radius: float

    kind = "cylinder"
    periods = (TURN, None)

    def _made(self) -> surfaces.Surface:
        return surfaces.cylinder(self.domain, *self._frame(), self.radius)


@dataclass(frozen=True, eq=False, repr=False)
class Cone(_Elementary):
    radius: float  # at v = 0
    angle: float  # half angle at the apex, radians, either sign; v runs along the generator

    kind = "cone"
    periods = (TURN, None)

    def _made(self) -> surfaces.Surface:
        return surfaces.cone(self.domain, *self._frame(), self.radius, self.angle)


@dataclass(frozen=True, eq=False, repr=False)
class Sphere(_Elementary):
    radius: float

    kind = "sphere"
    periods = (TURN, None)

    def _made(self) -> surfaces.Surface:
        return surfaces.sphere(self.domain, *self._frame(), self.radius)


@dataclass(frozen=True, eq=False, repr=False)
class Torus(_Elementary):
    radius: float  # from the axis to the middle of the tube
    tube: float  # radius of the tube; larger than `radius`: the surface meets itself

    kind = "torus"
    periods = (TURN, TURN)

    def _made(self) -> surfaces.Surface:
        return surfaces.torus(self.domain, *self._frame(), self.radius, self.tube)
