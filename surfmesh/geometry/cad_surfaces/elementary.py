"""Plane, cylinder, cone, sphere and torus, parametrised as CAD kernels do.

In the frame (origin; x, y, z), with the radius R, the tube's radius r and the half angle a:

    plane      u x + v y
    cylinder   R e(u) + v z                              e(u) = cos u x + sin u y
    cone       (R + v sin a) e(u) + v cos a z
    sphere     R cos v e(u) + R sin v z
    torus      (R + r cos v) e(u) + r sin v z

Each is a sum of fixed vectors times a few functions of u and v, such as cos u cos v, and the
derivatives of these functions are the same functions again. So r and all its derivatives are
one product: values of the functions times a table that is made when the surface is. The frame
may be left-handed, which turns the normal round.

Source: OCCT, package ElSLib (parametrisations).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import cos, pi, sin
from typing import ClassVar

import numpy as np

from surfmesh.geometry.cad_surfaces.face_surface import (
    DERIVATIVES,
    FaceSurface,
    derivative_count,
    parameter_pairs,
)
from surfmesh.geometry.cad_surfaces.plain_data import frozen_array

TURN = 2.0 * pi


def _operators(
    count: int, by_u: Mapping[int, tuple[int, int]], by_v: Mapping[int, tuple[int, int]]
) -> np.ndarray:
    """Differentiation of `count` functions as matrices, one for each of DERIVATIVES.

    by_u[i] = (j, sign): the u-derivative of function i is the function j times sign, and that
    of the others is zero. Result (10, count, count): the coefficients of a derivative are the
    matrix times the coefficients of r.
    """
    first = []
    for rules in (by_u, by_v):
        matrix = np.zeros((count, count))
        for function, (derivative, sign) in rules.items():
            matrix[derivative, function] = sign
        first.append(matrix)
    power = np.linalg.matrix_power
    return np.array([power(first[0], k) @ power(first[1], l) for k, l in DERIVATIVES])


@dataclass(frozen=True, eq=False, repr=False)
class _Elementary(FaceSurface):
    origin: np.ndarray  # (3,)
    x: np.ndarray  # (3,) unit vectors at right angles
    y: np.ndarray
    z: np.ndarray

    _table: np.ndarray = field(init=False)  # (derivatives, functions, 3)

    _OPERATORS: ClassVar[np.ndarray]

    def __post_init__(self) -> None:
        super().__post_init__()
        self._set(**{name: frozen_array(getattr(self, name)) for name in ("origin", "x", "y", "z")})
        self._set(_table=frozen_array(self._OPERATORS @ self._coefficients()))

    def evaluate(self, uv: np.ndarray, order: int = 0) -> tuple[np.ndarray, ...]:
        uv = parameter_pairs(uv)
        functions = self._functions(uv[:, 0], uv[:, 1])
        return tuple(np.matmul(functions.T, self._table[: derivative_count(order)]))

    def _coefficients(self) -> np.ndarray:
        """(k, 3): the vector that each function is multiplied with."""
        raise NotImplementedError

    def _functions(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """(k, n): values of the functions."""
        raise NotImplementedError


@dataclass(frozen=True, eq=False, repr=False)
class Plane(_Elementary):
    kind = "plane"
    _OPERATORS = _operators(3, {1: (0, 1)}, {2: (0, 1)})  # 1, u, v

    def _coefficients(self) -> np.ndarray:
        return np.array([self.origin, self.x, self.y])

    def _functions(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        values = np.empty((3, len(u)))
        values[0] = 1.0
        values[1] = u
        values[2] = v
        return values


@dataclass(frozen=True, eq=False, repr=False)
class Cylinder(_Elementary):
    radius: float

    kind = "cylinder"
    periods = (TURN, None)
    _OPERATORS = _operators(4, {1: (2, -1), 2: (1, 1)}, {3: (0, 1)})  # 1, cos u, sin u, v

    def _coefficients(self) -> np.ndarray:
        return np.array([self.origin, self.radius * self.x, self.radius * self.y, self.z])

    def _functions(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        values = np.empty((4, len(u)))
        values[0] = 1.0
        np.cos(u, out=values[1])
        np.sin(u, out=values[2])
        values[3] = v
        return values


@dataclass(frozen=True, eq=False, repr=False)
class Cone(_Elementary):
    radius: float  # at v = 0
    angle: float  # half angle at the apex, radians, either sign; v runs along the generator

    kind = "cone"
    periods = (TURN, None)
    _OPERATORS = _operators(  # 1, cos u, sin u, v, v cos u, v sin u
        6,
        {1: (2, -1), 2: (1, 1), 4: (5, -1), 5: (4, 1)},
        {3: (0, 1), 4: (1, 1), 5: (2, 1)},
    )

    def _coefficients(self) -> np.ndarray:
        x, y, z, slope = self.x, self.y, self.z, sin(self.angle)
        rows = [self.origin, self.radius * x, self.radius * y]
        return np.array([*rows, cos(self.angle) * z, slope * x, slope * y])

    def _functions(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        values = np.empty((6, len(u)))
        values[0] = 1.0
        np.cos(u, out=values[1])
        np.sin(u, out=values[2])
        values[3] = v
        np.multiply(values[1:3], v, out=values[4:])
        return values


@dataclass(frozen=True, eq=False, repr=False)
class Sphere(_Elementary):
    radius: float

    kind = "sphere"
    periods = (TURN, None)
    # 1, cos v, sin v, cos u cos v, sin u cos v, cos u sin v, sin u sin v
    _OPERATORS = _operators(
        7,
        {3: (4, -1), 4: (3, 1), 5: (6, -1), 6: (5, 1)},
        {1: (2, -1), 2: (1, 1), 3: (5, -1), 4: (6, -1), 5: (3, 1), 6: (4, 1)},
    )

    def _coefficients(self) -> np.ndarray:
        x, y, z = self.radius * self.x, self.radius * self.y, self.radius * self.z
        none = np.zeros(3)
        return np.array([self.origin, none, z, x, y, none, none])

    def _functions(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        values = np.empty((7, len(u)))
        values[0] = 1.0
        _products(u, v, values[1:3], values[3:7])
        return values


@dataclass(frozen=True, eq=False, repr=False)
class Torus(_Elementary):
    radius: float  # from the axis to the middle of the tube
    tube: float  # radius of the tube; larger than `radius`: the surface meets itself

    kind = "torus"
    periods = (TURN, TURN)
    # those of the sphere, cos u, sin u
    _OPERATORS = _operators(
        9,
        {3: (4, -1), 4: (3, 1), 5: (6, -1), 6: (5, 1), 7: (8, -1), 8: (7, 1)},
        {1: (2, -1), 2: (1, 1), 3: (5, -1), 4: (6, -1), 5: (3, 1), 6: (4, 1)},
    )

    def _coefficients(self) -> np.ndarray:
        x, y, z, none = self.x, self.y, self.z, np.zeros(3)
        tube, radius = self.tube, self.radius
        rows = [self.origin, none, tube * z, tube * x, tube * y, none, none]
        return np.array([*rows, radius * x, radius * y])

    def _functions(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        values = np.empty((9, len(u)))
        values[0] = 1.0
        values[7:] = _products(u, v, values[1:3], values[3:7])
        return values


def _products(u: np.ndarray, v: np.ndarray, turn_v: np.ndarray, products: np.ndarray) -> np.ndarray:
    """cos v, sin v into turn_v (2, n), times cos u, sin u into products (4, n).

    Returns cos u, sin u (2, n).
    """
    turn_u = np.empty((2, len(u)))
    np.cos(u, out=turn_u[0])
    np.sin(u, out=turn_u[1])
    np.cos(v, out=turn_v[0])
    np.sin(v, out=turn_v[1])
    np.multiply(turn_u, turn_v[0], out=products[:2])
    np.multiply(turn_u, turn_v[1], out=products[2:])
    return turn_u
