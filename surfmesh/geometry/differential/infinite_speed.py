"""Places on an axis of (u, v) where the speed has no bound, and the axis bent until it has one.

Square roots do it: a dome z = sqrt(1 - v^2) at its rim, a paraboloid sqrt(v) cos(u), ... at its
pole. With w the distance from the place,

    r - r0 ~ w^p,  0 < p < 1    |r_w| ~ w^(p - 1), infinite        the user's own parameter
    w = s^(1 / p)               |r_s| ~ 1                          the bent one

    u  a----------|----------b    pieces between such places; on each u is the integral of
    s  a----------|----------b    s^(q0 - 1) (1 - s)^(q1 - 1), q = 1 / p at either end

SciPy is imported where an axis is bent: most are not, and it takes longer than a small mesh.
Derivatives by u at such a place are those a little way inside, and the rate du/ds of the bent
parameter is taken there too: their product is finite and right to the length of that way.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

import numpy as np

from surfmesh._core import elementary_functions as functions
from surfmesh.geometry.surface import Domain, Surface

STEPS = (1e-4, 1e-6, 1e-8)
"""Distances from a place, as fractions of the domain, at which the exponent is measured."""

ACROSS = 17
"""Points along the place at which they are taken; the mean of them counts."""

LARGEST_EXPONENT, SMALLEST_EXPONENT = 0.93, 0.12
"""Above the former the speed grows no more than twofold in four decades; below the latter a
hundredth of the domain is a half of the surface, and no power law tames it."""

STEADY = 0.06
"""Most that the exponent may differ from one pair of distances to the next: else it is no power."""

DENOMINATOR, NEAR_FRACTION = 6, 0.015
"""Exponents are fractions of small numbers, as a rule: they are taken to be the nearest one."""

NEAREST, LARGEST_SPEED = 1e-5, 1e7
"""Derivatives are taken no nearer to the place: as a fraction of the bent piece, and where the
speed would be so many times the usual one, beside which the other direction keeps no digits."""

ROUNDING, MOST_ROUNDED = 16.0 * np.finfo(float).eps, 1e-6
"""Of a parameter, as a fraction of its axis, and how much of the surface it may move a side."""

Values = Callable[[np.ndarray], np.ndarray]
"""uv (n, 2) -> r (n, 3)."""


@dataclass(frozen=True)
class BentAxis:
    """u as a function of a bent parameter s that runs over the same interval.

    places: (m + 1,) the ends of the axis and the places of infinite speed between them.
    powers: (m, 2) q at the beginning and the end of each piece, 1 where the speed is finite.
    """

    places: np.ndarray
    powers: np.ndarray

    def parameter(self, s: np.ndarray) -> np.ndarray:
        """u (n,) at bent parameters s (n,); those outside are moved to the ends."""
        from scipy.special import betainc

        return self._from_nearer_end(s, betainc)

    def bent(self, u: np.ndarray) -> np.ndarray:
        """The bent parameter s (n,) of u (n,): ``parameter`` inverted."""
        return self._from_nearer_end(u, _beta_inverse)

    def _from_nearer_end(
        self, x: np.ndarray, way: Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]
    ) -> np.ndarray:
        """Where x (n,) goes by ``way`` (q0, q1, fraction of the piece), within its piece.

        From the nearer end, where digits count.
        """
        _, a, b, q0, q1 = self._pieces(x)
        before, after = np.clip((x - a) / (b - a), 0.0, 1.0), np.clip((b - x) / (b - a), 0.0, 1.0)
        return np.where(
            before < 0.5, a + (b - a) * way(q0, q1, before), b - (b - a) * way(q1, q0, after)
        )

    def rates(self, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """du/ds and d2u/ds2 (n,) at s (n,) kept off the places."""
        from scipy.special import beta

        s = self.kept_off(s)
        _, a, b, q0, q1 = self._pieces(s)
        before, after = (s - a) / (b - a), (b - s) / (b - a)
        first = functions.pow(before, q0 - 1.0) * functions.pow(after, q1 - 1.0) / beta(q0, q1)
        with np.errstate(divide="ignore", invalid="ignore"):
            bending = np.where(q0 > 1.0, (q0 - 1.0) / before, 0.0)
            bending -= np.where(q1 > 1.0, (q1 - 1.0) / after, 0.0)
        return first, first * bending / (b - a)

    def kept_off(self, s: np.ndarray) -> np.ndarray:
        """Bent parameters (n,), those nearer to a place than derivatives are taken moved away."""
        piece, a, b, _, _ = self._pieces(s)
        clearance = self._clearance()[piece] * (b - a)[:, None]
        return np.clip(s, a + clearance[:, 0], b - clearance[:, 1])

    def limits(self) -> tuple[list[float], list[float]]:
        """Lowest and highest parameter (m,) of each piece at which derivatives are taken."""
        a, b, clearance = self.places[:-1], self.places[1:], self._clearance()
        lowest = self.parameter(a + clearance[:, 0] * (b - a))
        highest = self.parameter(b - clearance[:, 1] * (b - a))
        return (
            np.where(clearance[:, 0] > 0.0, lowest, -np.inf).tolist(),
            np.where(clearance[:, 1] > 0.0, highest, np.inf).tolist(),
        )

    def parameter_kept_off(self, u: np.ndarray) -> np.ndarray:
        """The same for parameters u (n,): the others stay as they are to the last bit."""
        lowest, highest = self.limits()
        piece = self._pieces(u)[0]
        return np.clip(u, np.array(lowest)[piece], np.array(highest)[piece])

    def pieces(self) -> np.ndarray:
        """What the core needs to know (m, 7): beginning, end, both powers of each piece, their
        beta function, and the clearance at both ends."""
        from scipy.special import beta

        q0, q1 = self.powers.T
        ends = self.places[:-1], self.places[1:]
        return np.column_stack([*ends, q0, q1, beta(q0, q1), self._clearance()])

    def _clearance(self) -> np.ndarray:
        """How near to the ends of the pieces derivatives are taken (m, 2), fractions of them."""
        with np.errstate(divide="ignore"):
            exponent = -1.0 / (self.powers - 1.0)
        slow = functions.pow(np.full_like(exponent, LARGEST_SPEED), exponent)
        return np.where(self.powers > 1.0, np.maximum(NEAREST, slow), 0.0)

    def _pieces(self, s: np.ndarray) -> tuple[np.ndarray, ...]:
        """Number, beginning, end and both powers of the pieces that hold s (n,)."""
        piece = np.searchsorted(self.places, s, side="right") - 1
        piece = np.clip(piece, 0, len(self.powers) - 1)
        return piece, self.places[piece], self.places[piece + 1], *self.powers[piece].T


def _beta_inverse(q0: np.ndarray, q1: np.ndarray, fraction: np.ndarray) -> np.ndarray:
    """s (n,) with ``betainc(q0, q1, s)`` = fraction; its leading power where SciPy underflows."""
    from scipy.special import beta, betaincinv

    s = betaincinv(q0, q1, fraction)
    return np.where(np.isnan(s), (fraction * q0 * beta(q0, q1)) ** (1.0 / q0), s)


BentAxes = tuple[BentAxis | None, BentAxis | None]
"""For u and for v; None where the speed is finite everywhere."""

STRAIGHT: BentAxes = (None, None)


def is_bent(axes: BentAxes) -> bool:
    """Is the speed without bound anywhere?"""
    return any(axis is not None for axis in axes)


def kept_off(axes: BentAxes, uv: np.ndarray) -> np.ndarray:
    """uv (n, 2), those too near to a place of infinite speed for derivatives moved away from it."""
    uv = uv.copy()
    for column, axis in enumerate(axes):
        if axis is not None:
            uv[:, column] = axis.parameter_kept_off(uv[:, column])
    return uv


def to_bent(axes: BentAxes, uv: np.ndarray) -> np.ndarray:
    """The bent parameters (n, 2) of uv (n, 2), kept off the places of infinite speed."""
    s = uv.copy()
    for column, axis in enumerate(axes):
        if axis is not None:
            s[:, column] = axis.kept_off(axis.bent(uv[:, column]))
    return s


def from_bent(axes: BentAxes, s: np.ndarray) -> np.ndarray:
    """uv (n, 2) of bent parameters s (n, 2)."""
    uv = s.copy()
    for column, axis in enumerate(axes):
        if axis is not None:
            uv[:, column] = axis.parameter(s[:, column])
    return uv


def bent_rates(axes: BentAxes, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """First and second derivatives (n, 2) of u and v by their bent parameters s (n, 2)."""
    first, second = np.ones_like(s), np.zeros_like(s)
    for column, axis in enumerate(axes):
        if axis is not None:
            first[:, column], second[:, column] = axis.rates(s[:, column])
    return first, second


def by_parameters(
    derivatives: Sequence[np.ndarray], first: np.ndarray, second: np.ndarray
) -> tuple[np.ndarray, ...]:
    """r_u, r_v or r_u .. r_vv, (n, 3) each, from those by the bent parameters: the chain rule.

    first, second: (n, 2) as ``bent_rates`` gives them.
    """
    (a, b), (p, q) = first.T[:, :, None], second.T[:, :, None]
    r_u, r_v = derivatives[0] / a, derivatives[1] / b
    if len(derivatives) == 2:
        return r_u, r_v
    r_ss, r_st, r_tt = derivatives[2:]
    return r_u, r_v, (r_ss - p * r_u) / a**2, r_st / (a * b), (r_tt - q * r_v) / b**2


def bent_axes_of(surface: Surface) -> BentAxes:
    """What a surface knows about itself; surfaces that know nothing have finite speeds."""
    return getattr(surface, "bent_axes", STRAIGHT)


def bent_axes(
    values: Values, domain: Domain, inside: Sequence[Sequence[float]] = ((), ())
) -> BentAxes:
    """The axes of r over a domain. inside: places between the ends to be tried, an axis each."""
    axes = []
    for axis in (0, 1):
        first, last = domain[axis]
        places = [first, *sorted(x for x in inside[axis] if first < x < last), last]
        powers = np.ones((len(places) - 1, 2))
        for k, (a, b) in enumerate(pairwise(places)):
            powers[k, 0] = _power(values, domain, axis, a, b - a)
            powers[k, 1] = _power(values, domain, axis, b, a - b)
        met = (powers[:-1, 1] > 1.0) | (powers[1:, 0] > 1.0)  # the others are no such places
        places = np.array(places, float)[np.concatenate([[True], met, [True]])]
        begins, ends = powers[np.append(True, met), 0], powers[np.append(met, True), 1]
        powers = np.stack([begins, ends], axis=1)
        bent = (powers > 1.0).any()
        axes.append(BentAxis(places, powers) if bent else None)
    return axes[0], axes[1]


def zeros_between(values: np.ndarray, at: np.ndarray, function: Values) -> list[float]:
    """Where a function of one parameter, sampled as ``values`` (n,) ``at`` (n,), vanishes: at
    samples, and by halving between those of opposite signs."""
    found = at[values == 0.0].tolist()
    signs = np.sign(values)
    changes = np.flatnonzero(signs[1:] * signs[:-1] < 0.0).tolist()
    if not changes:
        return found
    from scipy.optimize import brentq

    for k in changes:
        found.append(float(brentq(function, at[k], at[k + 1], xtol=4.0 * np.finfo(float).eps)))
    return found


def _power(values: Values, domain: Domain, axis: int, place: float, way: float) -> float:
    """1 / p of r - r0 ~ w^p beside u = place (or v), w along ``way``; 1 where p is 1 or more."""
    first, last = domain[1 - axis]
    uv = np.empty((len(STEPS) + 1, ACROSS, 2))
    uv[..., axis] = place + way * np.array([0.0, *STEPS])[:, None]
    uv[..., 1 - axis] = first + (last - first) * (np.arange(ACROSS) + 0.5) / ACROSS
    r = values(uv.reshape(-1, 2)).reshape(len(STEPS) + 1, ACROSS, 3)
    with np.errstate(all="ignore"):
        far = np.linalg.norm(r[1:] - r[0], axis=2).mean(axis=1)
        exponents = np.diff(functions.log(far)) / np.diff(functions.log(np.array(STEPS)))
    p = float(exponents[-1])
    if not SMALLEST_EXPONENT <= p <= LARGEST_EXPONENT or abs(p - exponents[0]) > STEADY:
        return 1.0
    simple = float(Fraction(p).limit_denominator(DENOMINATOR))
    return 1.0 / (simple if abs(simple - p) < NEAR_FRACTION else p)


def rounding_of_sides(surface: Surface) -> np.ndarray:
    """How far the rounding of a parameter moves each of the four sides, a fraction of the surface.

    (4,) in the order of ``sides``. sqrt(sin(v)) at v = pi is 1e-8, not 0.
    """
    (u0, u1), (v0, v1) = (
        (1.0, 1.0) if axis is None else (axis.powers[0, 0], axis.powers[-1, 1])
        for axis in bent_axes_of(surface)
    )
    return np.minimum(ROUNDING ** (1.0 / np.array([v0, u1, v1, u0])), MOST_ROUNDED)
