"""Curves in space and in the (u, v) plane: what every curve can do, lines and conics.

In the frame (origin; x, y), parametrised as CAD kernels do:

    line        t d                       circle     R cos t x + R sin t y
    ellipse     a cos t x + b sin t y     hyperbola  a cosh t x + b sinh t y
    parabola    t^2 / (4 f) x + t y       f: the focal length

All are origin + f(t) x + g(t) y, in the plane as in space: the number of dimensions is that
of the vectors. Splines are in `nurbs`, curves at a distance from another in `offset`.

Source: OCCT, packages ElCLib (parametrisations).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import pi
from typing import ClassVar, Protocol, Self, runtime_checkable

import numpy as np

from surfmesh.geometry.cad_surfaces.plain_data import PlainData, frozen_array

TURN = 2.0 * pi


@runtime_checkable
class Curve(Protocol):
    """A map from a parameter t into space (d = 3) or into the (u, v) plane (d = 2).

    kind: "line", "circle", "ellipse", "hyperbola", "parabola", "bspline", "bezier", "offset".
    period: c(t + period) = c(t), or None.
    """

    @property
    def kind(self) -> str: ...

    @property
    def period(self) -> float | None: ...

    @property
    def dimension(self) -> int: ...

    def evaluate(self, t: np.ndarray, order: int = 0) -> tuple[np.ndarray, ...]:
        """(n,) float -> (n, d) float arrays: (c, c', c'', c''')[: order + 1]."""
        ...

    def with_limits(self, first: float, last: float) -> Self:
        """The same curve, of which the part from first to last is in use.

        It can be evaluated elsewhere as before. But where a kink lies at an end, the
        derivatives there are those of the part in use.
        """
        ...


@dataclass(frozen=True, eq=False, repr=False)
class _Elementary(PlainData):
    """origin + f(t) x + g(t) y; `_functions` gives f and g with their derivatives."""

    origin: np.ndarray  # (d,)
    x: np.ndarray  # (d,) unit vectors at right angles
    y: np.ndarray
    _axes: np.ndarray = field(init=False)  # (2, d)

    period: ClassVar[float | None] = None

    def __post_init__(self) -> None:
        self._set(**{name: frozen_array(getattr(self, name)) for name in ("origin", "x", "y")})
        self._set(_axes=frozen_array([self.x, self.y]))

    @property
    def dimension(self) -> int:
        return len(self.origin)

    def evaluate(self, t: np.ndarray, order: int = 0) -> tuple[np.ndarray, ...]:
        t = np.asarray(t, dtype=float).reshape(-1)
        values = np.zeros((order + 1, len(t), 2))
        self._functions(t, values)
        results = values @ self._axes
        results[0] += self.origin
        return tuple(results)

    def with_limits(self, first: float, last: float) -> Self:
        return self

    def _functions(self, t: np.ndarray, out: np.ndarray) -> None:
        """f, g, then f', g', ... into out (order + 1, n, 2), which holds zeros."""
        raise NotImplementedError


@dataclass(frozen=True, eq=False, repr=False)
class Line(PlainData):
    origin: np.ndarray  # (d,)
    direction: np.ndarray  # (d,) of unit length, so that t is a length

    kind = "line"
    period: ClassVar[float | None] = None

    def __post_init__(self) -> None:
        origin, direction = frozen_array(self.origin), frozen_array(self.direction)
        self._set(origin=origin, direction=direction)

    @property
    def dimension(self) -> int:
        return len(self.origin)

    def evaluate(self, t: np.ndarray, order: int = 0) -> tuple[np.ndarray, ...]:
        t = np.asarray(t, dtype=float).reshape(-1)
        results = np.zeros((order + 1, len(t), len(self.origin)))
        np.multiply(t[:, None], self.direction, out=results[0])
        results[0] += self.origin
        if order:
            results[1] = self.direction
        return tuple(results)

    def with_limits(self, first: float, last: float) -> Self:
        return self


@dataclass(frozen=True, eq=False, repr=False)
class Ellipse(_Elementary):
    major: float  # along x
    minor: float  # along y

    kind = "ellipse"
    period = TURN

    def _functions(self, t: np.ndarray, out: np.ndarray) -> None:
        cos, sin = np.cos(t), np.sin(t)
        for k in range(len(out)):
            np.multiply(cos, self.major, out=out[k, :, 0])
            np.multiply(sin, self.minor, out=out[k, :, 1])
            cos, sin = -sin, cos


@dataclass(frozen=True, eq=False, repr=False)
class Circle(_Elementary):
    radius: float

    kind = "circle"
    period = TURN

    def _functions(self, t: np.ndarray, out: np.ndarray) -> None:
        cos, sin = self.radius * np.cos(t), self.radius * np.sin(t)
        for k in range(len(out)):
            out[k, :, 0] = cos
            out[k, :, 1] = sin
            cos, sin = -sin, cos


@dataclass(frozen=True, eq=False, repr=False)
class Hyperbola(_Elementary):
    """The branch that meets the positive x axis."""

    major: float  # along x
    minor: float  # along y

    kind = "hyperbola"

    def _functions(self, t: np.ndarray, out: np.ndarray) -> None:
        cosh, sinh = np.cosh(t), np.sinh(t)
        for k in range(len(out)):
            np.multiply(cosh, self.major, out=out[k, :, 0])
            np.multiply(sinh, self.minor, out=out[k, :, 1])
            cosh, sinh = sinh, cosh


@dataclass(frozen=True, eq=False, repr=False)
class Parabola(_Elementary):
    focal: float  # from the apex to the focus, along x

    kind = "parabola"

    def _functions(self, t: np.ndarray, out: np.ndarray) -> None:
        out[0, :, 0] = t * t / (4.0 * self.focal)
        out[0, :, 1] = t
        if len(out) > 1:
            out[1, :, 0] = t / (2.0 * self.focal)
            out[1, :, 1] = 1.0
        if len(out) > 2:
            out[2, :, 0] = 1.0 / (2.0 * self.focal)
