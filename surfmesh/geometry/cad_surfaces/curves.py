"""Curves in space and in the (u, v) plane: what every curve can do, lines and conics.

They are evaluated by the compiled core (``src/surfaces/elementary_curves.hpp``).

In the frame (origin; x, y), parametrised as CAD kernels do:

    line        t d                       circle     R cos t x + R sin t y
    ellipse     a cos t x + b sin t y     hyperbola  a cosh t x + b sinh t y
    parabola    t^2 / (4 f) x + t y       f: the focal length

The number of dimensions is that of the vectors. Splines are in `nurbs`, curves at a distance
from another in `offset`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import pi
from typing import ClassVar, Protocol, Self, runtime_checkable

import numpy as np

from surfmesh._core import surfaces
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


@runtime_checkable
class CoreCurve(Curve, Protocol):
    """A curve that the compiled core evaluates, so that it may be part of its surfaces."""

    @property
    def core(self) -> surfaces.Curve: ...


def points_on(curves: Sequence[Curve], t: np.ndarray) -> np.ndarray:
    """Points of n curves of one dimension d, row i of t (n, k) on curve i: (n, k, d) float."""
    cores = [curve.core for curve in curves if isinstance(curve, PlainCurve)]
    if len(cores) == len(curves):
        return surfaces.points_on(cores, t)
    return np.stack([curve.evaluate(row, 0)[0] for curve, row in zip(curves, t)])


@dataclass(frozen=True, eq=False, repr=False)
class PlainCurve(PlainData):
    """Plain data with the curve of the core, which is made when they are."""

    core: surfaces.Curve = field(init=False)

    @property
    def dimension(self) -> int:
        return self.core.dimension

    def evaluate(self, t: np.ndarray, order: int = 0) -> tuple[np.ndarray, ...]:
        """(n,) float -> (n, d) float arrays: (c, c', c'', ...)[: order + 1]."""
        return tuple(self.core.evaluate(np.asarray(t, dtype=float).reshape(-1), order))


@dataclass(frozen=True, eq=False, repr=False)
class _Elementary(PlainCurve):
    origin: np.ndarray  # (d,)
    x: np.ndarray  # (d,) unit vectors at right angles
    y: np.ndarray

    period: ClassVar[float | None] = None

    def __post_init__(self) -> None:
        self._set(**{name: frozen_array(getattr(self, name)) for name in ("origin", "x", "y")})
        self._set(core=self._made())

    def with_limits(self, first: float, last: float) -> Self:
        return self

    def _made(self) -> surfaces.Curve:
        raise NotImplementedError


@dataclass(frozen=True, eq=False, repr=False)
class Line(PlainCurve):
    origin: np.ndarray  # (d,)
    direction: np.ndarray  # (d,) of unit length, so that t is a length

    kind = "line"
    period: ClassVar[float | None] = None

    def __post_init__(self) -> None:
        origin, direction = frozen_array(self.origin), frozen_array(self.direction)
        core = surfaces.line(origin, direction)
        self._set(origin=origin, direction=direction, core=core)

    def with_limits(self, first: float, last: float) -> Self:
        return self


@dataclass(frozen=True, eq=False, repr=False)
class Ellipse(_Elementary):
    major: float  # along x
    minor: float  # along y

    kind = "ellipse"
    period = TURN

    def _made(self) -> surfaces.Curve:
        return surfaces.ellipse(self.origin, self.x, self.y, self.major, self.minor)


@dataclass(frozen=True, eq=False, repr=False)
class Circle(_Elementary):
    radius: float

    kind = "circle"
    period = TURN

    def _made(self) -> surfaces.Curve:
        return surfaces.ellipse(self.origin, self.x, self.y, self.radius, self.radius)


@dataclass(frozen=True, eq=False, repr=False)
class Hyperbola(_Elementary):
    """The branch that meets the positive x axis."""

    major: float  # along x
    minor: float  # along y

    kind = "hyperbola"

    def _made(self) -> surfaces.Curve:
        return surfaces.hyperbola(self.origin, self.x, self.y, self.major, self.minor)


@dataclass(frozen=True, eq=False, repr=False)
class Parabola(_Elementary):
    focal: float  # from the apex to the focus, along x

    kind = "parabola"

    def _made(self) -> surfaces.Curve:
        return surfaces.parabola(self.origin, self.x, self.y, self.focal)
