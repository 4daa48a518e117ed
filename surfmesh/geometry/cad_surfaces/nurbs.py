"""B-spline curves and surfaces, rational or not; Bezier ones are B-splines of one span.

knots      flat: each as often as its multiplicity; (number of control points + degree + 1,)
range      from knots[degree] to knots[-1 - degree]
weights    None: not rational
period     of a closed curve given unrolled: knots and control points go on periodically
           beyond the range as far as the spans within it need them

They are evaluated by the compiled core (``src/surfaces/spline_surface.hpp``, ``spline_curve.hpp``).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Self

import numpy as np

from surfmesh._core import surfaces
from surfmesh.errors import SurfaceError
from surfmesh.geometry.cad_surfaces.curves import PlainCurve
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.cad_surfaces.plain_data import frozen_array, poles_of


def bezier_knots(degree: int) -> np.ndarray:
    """The knots of a Bezier curve of this degree, which runs from 0 to 1."""
    return np.repeat([0.0, 1.0], degree + 1)


@dataclass(frozen=True, eq=False, repr=False)
class BSplineCurve(PlainCurve):
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

    def __post_init__(self) -> None:
        knots, control = frozen_array(self.knots), poles_of("a curve", self.control)
        self._set(knots=knots, control=control)
        if control.ndim != 2:
            raise SurfaceError("the control points of a curve are an array (n, d)")
        degree = _checked_degree("curve", knots, len(control))
        if self.weights is not None:
            self._set(weights=_checked_weights("curve", control, self.weights))
        period = self.period or 0.0
        core = surfaces.spline_curve(knots, control, self.weights, self.limits, period)
        self._set(degree=degree, core=core)

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

    def _made(self) -> surfaces.Surface:
        knots_u, knots_v = frozen_array(self.knots_u), frozen_array(self.knots_v)
        control = poles_of(self.name, self.control)
        self._set(knots_u=knots_u, knots_v=knots_v, control=control)
        if control.ndim != 3 or control.shape[2] != 3:
            raise SurfaceError(f"{self.name}: the control points are an array (nu, nv, 3)")
        degree_u = _checked_degree(f"{self.name}, u", knots_u, control.shape[0])
        degree_v = _checked_degree(f"{self.name}, v", knots_v, control.shape[1])
        if self.weights is not None:
            self._set(weights=_checked_weights(self.name, control, self.weights))
        self._set(degrees=(degree_u, degree_v))
        period_u, period_v = self.periods
        periods = (period_u or 0.0, period_v or 0.0)
        return surfaces.spline_surface(
            self.domain, knots_u, knots_v, control, self.weights, periods
        )

    @cached_property
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


def _checked_weights(what: str, control: np.ndarray, given: np.ndarray) -> np.ndarray:
    weights = frozen_array(given)
    if weights.shape != control.shape[:-1]:
        raise SurfaceError(f"{what}: there must be one weight for each control point")
    if not ((weights > 0.0) & np.isfinite(weights)).all():
        raise SurfaceError(f"{what}: weights must be positive numbers")
    return weights
