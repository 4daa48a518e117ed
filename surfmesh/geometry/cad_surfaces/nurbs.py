"""B-spline curves and surfaces, rational or not; Bezier ones are B-splines of one span.

knots      flat: each as often as its multiplicity; (number of control points + degree + 1,)
range      from knots[degree] to knots[-1 - degree]
weights    None: not rational
period     of a closed curve given unrolled: knots and control points go on periodically
           beyond the range as far as the spans within it need them
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np

from surfmesh.errors import SurfaceError
from surfmesh.geometry.cad_surfaces.face_surface import (
    FaceSurface,
    derivative_count,
    parameter_pairs,
)
from surfmesh.geometry.cad_surfaces.plain_data import PlainData, frozen_array
from surfmesh.kernels.space.nurbs import curve_derivatives, surface_derivatives


def bezier_knots(degree: int) -> np.ndarray:
    """The knots of a Bezier curve of this degree, which runs from 0 to 1."""
    return np.repeat([0.0, 1.0], degree + 1)


@dataclass(frozen=True, eq=False, repr=False)
class BSplineCurve(PlainData):
    """A spline in the plane (d = 2) or in space (d = 3).

    Raises SurfaceError when knots, control points and weights do not fit together.
    """

    knots: np.ndarray  # (n + degree + 1,)
    control: np.ndarray  # (n, d)
    weights: np.ndarray | None = None  # (n,)
    period: float | None = None
    limits: tuple[float, float] | None = None  # the part in use; see `Curve.with_limits`
    kind: str = "bspline"  # or "bezier"
    degree: int = field(init=False)
    _arrays: tuple[np.ndarray, np.ndarray, np.ndarray] = field(init=False)  # for the kernel

    def __post_init__(self) -> None:
        knots, control = frozen_array(self.knots), frozen_array(self.control)
        self._set(knots=knots, control=control)
        if control.ndim != 2:
            raise SurfaceError("the control points of a curve are an array (n, d)")
        degree = _checked_degree("curve", knots, len(control))
        points = control.base
        if self.weights is not None:
            self._set(weights=frozen_array(self.weights))
            points = _weighted("curve", control, self.weights)
        first, last = self.limits or (np.nan, np.nan)
        limits = np.array([first, last, self.period or 0.0])
        self._set(degree=degree, _arrays=(knots.base, points, limits))

    @property
    def dimension(self) -> int:
        return self.control.shape[1]

    def evaluate(self, t: np.ndarray, order: int = 0) -> tuple[np.ndarray, ...]:
        t = np.ascontiguousarray(t, dtype=float).reshape(-1)
        out = np.empty((order + 1, len(t), self.dimension))
        size = self.degree + 1
        scratch = np.empty((size + 2 * (order + 1), max(size, self.dimension + 1)))
        curve_derivatives(*self._arrays, t, order, scratch, out)
        return tuple(out)

    def with_limits(self, first: float, last: float) -> Self:
        return replace(self, limits=(float(first), float(last)))


@dataclass(frozen=True, eq=False, repr=False)
class BSplineSurface(FaceSurface):
    """A tensor product spline surface.

    At a crease that is a side of `domain`, the derivatives are those inside. Raises
    SurfaceError when knots, control points and weights do not fit together.
    """

    knots_u: np.ndarray  # (nu + degree_u + 1,)
    knots_v: np.ndarray  # (nv + degree_v + 1,)
    control: np.ndarray  # (nu, nv, 3)
    weights: np.ndarray | None = None  # (nu, nv)
    periods: tuple[float | None, float | None] = (None, None)
    kind: str = "bspline"  # or "bezier"
    degrees: tuple[int, int] = field(init=False)
    _arrays: tuple[np.ndarray, ...] = field(init=False)  # for the kernel

    def __post_init__(self) -> None:
        super().__post_init__()
        knots_u, knots_v = frozen_array(self.knots_u), frozen_array(self.knots_v)
        control = frozen_array(self.control)
        self._set(knots_u=knots_u, knots_v=knots_v, control=control)
        if control.ndim != 3 or control.shape[2] != 3:
            raise SurfaceError(f"{self.name}: the control points are an array (nu, nv, 3)")
        degree_u = _checked_degree(f"{self.name}, u", knots_u, control.shape[0])
        degree_v = _checked_degree(f"{self.name}, v", knots_v, control.shape[1])
        points = control.base
        if self.weights is not None:
            self._set(weights=frozen_array(self.weights))
            points = _weighted(self.name, control, self.weights)
        period_u, period_v = (period or 0.0 for period in self.periods)
        limits = np.array([*self.domain[0], period_u, *self.domain[1], period_v])
        self._set(degrees=(degree_u, degree_v))
        self._set(_arrays=(knots_u.base, knots_v.base, points, limits))

    def evaluate(self, uv: np.ndarray, order: int = 0) -> tuple[np.ndarray, ...]:
        uv = parameter_pairs(uv)
        out = np.empty((derivative_count(order), len(uv), 3))
        size = max(self.degrees) + 1
        scratch = np.empty((size + 18, max(size, 4)))
        surface_derivatives(*self._arrays, uv, order, scratch, out)
        return tuple(out)

    @property
    def pieces(self) -> int:
        """Knot spans over the domain."""
        (u0, u1), (v0, v1) = self.domain
        return knot_spans(self.knots_u, u0, u1) * knot_spans(self.knots_v, v0, v1)


def knot_spans(knots: np.ndarray, first: float, last: float) -> int:
    """About how many knot spans lie between two parameters, periods gone round included."""
    distinct = np.unique(knots)
    inside = int(((distinct > first) & (distinct < last)).sum())
    beyond = max(distinct[0] - first, 0.0) + max(last - distinct[-1], 0.0)
    each = (distinct[-1] - distinct[0]) / (len(distinct) - 1)
    return 1 + inside + int(beyond / each)


def _checked_degree(what: str, knots: np.ndarray, count: int) -> int:
    degree = len(knots) - count - 1
    if not 1 <= degree < count:
        raise SurfaceError(
            f"{what}: {len(knots)} knots and {count} control points make no spline; there are "
            "degree + 1 more knots than control points, and the degree is less than their number"
        )
    steps = np.diff(knots)
    if not (np.isfinite(knots).all() and (steps >= 0.0).all()):
        raise SurfaceError(f"{what}: the knots must be finite and must not decrease")
    if not knots[degree] < knots[count]:
        raise SurfaceError(f"{what}: the knots leave no interval between the first and the last")
    return degree


def _weighted(what: str, control: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """(..., d) and (...) -> (..., d + 1): each point with its weight."""
    if weights.shape != control.shape[:-1]:
        raise SurfaceError(f"{what}: there must be one weight for each control point")
    if not (weights > 0.0).all():
        raise SurfaceError(f"{what}: weights must be positive")
    return np.concatenate([control, weights[..., None]], axis=-1)
