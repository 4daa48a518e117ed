"""The chart of a surface, the scaled plane (x, y): u and v stretched so that speeds are about one.

On a CAD cylinder u is radians and v millimetres; on a badly parametrised surface the speed
|r_u| changes a thousandfold along u. Both would make circles in (u, v) grotesque. So x is a
function of u alone, with dx/du the mean over v of |r_u|, and y likewise of v: lengths of the
surface's own order, on which predicates keep their digits. Where the mean speed hardly changes
the function is linear, otherwise a monotone cubic spline, once differentiable. Where speeds
have no bound (square roots) it is a function of the bent parameter instead.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from surfmesh._core import surfaces as core
from surfmesh.geometry.differential.infinite_speed import BentAxis, bent_axes_of, is_bent
from surfmesh.geometry.differential.monotone_cubic import MonotoneCubic
from surfmesh.geometry.surface import Domain, Surface, steady_axes

SAMPLES_ALONG = 257
SAMPLES_ACROSS = 17
_ACROSS = (np.arange(SAMPLES_ACROSS) + 0.5) / SAMPLES_ACROSS
UNEVEN = 1.3
"""Ratio of the largest to the smallest mean speed above which an axis is bent."""
SLOWEST = 1e-4
"""Smallest speed that is told apart, relative to the mean: a stop is not infinitely long."""
KNOTS = 1024
MISSED = 1.5
"""Ratio of the length by speeds at the samples to that of the chords between them from which the
samples miss something: tan(u) up to 1.57 has 93 % of its length in the last of 257 steps."""

LONG_STEP, FINEST_STEP, MOST_STEPS = 1.0 / 64.0, 1e-14, 4000
"""Then steps are halved: those longer than this fraction of the whole, unless they are as short as
the next fraction of the domain, or so many already."""


@dataclass(frozen=True)
class Axis:
    """A monotone map between one parameter and its scaled coordinate.

    ``knots`` (k,) and ``slopes`` (k,): the parameter and its derivative at k evenly spaced
    scaled coordinates from 0 to ``extent``; two knots make it linear. Where there is a ``bent``
    parameter, they are of that one.
    """

    extent: float
    knots: np.ndarray
    slopes: np.ndarray
    bent: BentAxis | None = None

    @classmethod
    def of(
        cls, low: float, high: float, t: np.ndarray, speed: np.ndarray,
        bent: BentAxis | None = None,
    ) -> "Axis":  # fmt: skip
        """From mean speeds (n,) at ``t`` (n,), evenly spaced from 0 to 1 over [low, high].

        Both of the ``bent`` parameter if there is one.
        """
        mean = float(speed.mean())
        if not mean > 0.0:
            mean, speed = 1.0, np.ones_like(speed)
        extent = mean * (high - low)
        speed = np.maximum(speed, SLOWEST * mean)
        if speed.max() <= UNEVEN * speed.min():
            return cls.linear(low, high, mean, bent)
        length = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]))])
        length *= extent / length[-1]
        length[-1] = extent
        return cls.of_length(low + t * (high - low), length, bent)

    @classmethod
    def of_length(
        cls, parameters: np.ndarray, length: np.ndarray, bent: BentAxis | None = None
    ) -> "Axis":
        """From the mean ``length`` (n,) of the way to ``parameters`` (n,); both rise."""
        spline = MonotoneCubic(length, parameters)
        x = np.linspace(0.0, length[-1], KNOTS)
        knots = spline(x)
        knots[0], knots[-1] = parameters[0], parameters[-1]
        # slopes of a monotone cubic on the even knots (Fritsch and Carlson 1980)
        slopes = MonotoneCubic(x, knots).derivative(x)
        return cls(float(length[-1]), knots, slopes, bent)

    @classmethod
    def linear(cls, low: float, high: float, speed: float, bent: BentAxis | None = None) -> "Axis":
        """Stretched by the same factor everywhere."""
        return cls(speed * (high - low), np.array([low, high]), np.full(2, 1.0 / speed), bent)

    def in_core(self) -> core.ChartAxis:
        """The map to the parameter as the core has it."""
        pieces = None if self.bent is None else self.bent.pieces()
        return core.ChartAxis(self.extent, self.knots, self.slopes, pieces)


@dataclass(frozen=True)
class Chart:
    """Coordinates of one surface: its (u, v) and the scaled plane (x, y), axis by axis."""

    axes: tuple[Axis, Axis]

    @cached_property
    def core(self) -> core.Chart:
        """The map as the core has it, between the plane and (u, v) or bent parameters."""
        return core.Chart(*(axis.in_core() for axis in self.axes))

    def __reduce__(self) -> tuple[Callable[..., "Chart"], tuple[tuple[Axis, Axis]]]:
        return Chart, (self.axes,)  # what the core has is made anew

    @classmethod
    def of(cls, surface: Surface) -> "Chart":
        steady, bent = steady_axes(surface), bent_axes_of(surface)
        u, v = (
            _steady_axis(surface, axis) if steady[axis] and bent[axis] is None
            else _sampled_axis(surface, axis, bent[axis])
            for axis in (0, 1)
        )  # fmt: skip
        return cls((u, v))

    @classmethod
    def uniform(cls, domain: Domain, speeds: tuple[float, float]) -> "Chart":
        """For a surface whose |r_u| and |r_v| are the same everywhere: nothing is sampled."""
        u, v = (Axis.linear(*span, speed) for span, speed in zip(domain, speeds))
        return cls((u, v))

    @property
    def extent(self) -> np.ndarray:
        """Width and height of the domain in the scaled plane."""
        return np.array([axis.extent for axis in self.axes])

    def to_plane(self, uv: np.ndarray) -> np.ndarray:
        """uv (n, 2) -> xy (n, 2)."""
        if is_bent((self.axes[0].bent, self.axes[1].bent)):
            uv = np.array(uv, float)
            for k, axis in enumerate(self.axes):
                if axis.bent is not None:
                    uv[:, k] = axis.bent.bent(uv[:, k])
        return self.core.to_plane(np.ascontiguousarray(uv, float))

    def to_uv(self, xy: np.ndarray) -> np.ndarray:
        """xy (n, 2) -> uv (n, 2)."""
        return self.to_uv_and_rates(xy)[0]

    def rates(self, xy: np.ndarray) -> np.ndarray:
        """(du/dx, dv/dy) at xy (n, 2) -> (n, 2)."""
        return self.to_uv_and_rates(xy)[1]

    def to_uv_and_rates(self, xy: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """xy (n, 2) -> uv (n, 2) and (du/dx, dv/dy) (n, 2).

        Linear outside the domain, constant where the parameter is bent.
        """
        return self.core.to_uv_and_rates(np.ascontiguousarray(xy, float))


def _steady_axis(surface: Surface, axis: int) -> Axis:
    """From one line across, as the speed is the same all along the axis."""
    (low, high), (first, last) = surface.domain[axis], surface.domain[1 - axis]
    uv = np.empty((SAMPLES_ACROSS, 2))
    uv[:, axis] = 0.5 * (low + high)
    uv[:, 1 - axis] = first + _ACROSS * (last - first)
    speed = float(np.linalg.norm(surface.evaluate(uv, 1)[1 + axis], axis=1).mean())
    return Axis.linear(low, high, speed if speed > 0.0 else 1.0)


def _sampled_axis(surface: Surface, axis: int, bent: BentAxis | None) -> Axis:
    """From speeds on lines across and along, or from chords where the speeds miss something."""
    low, high = np.array(surface.domain, float).T
    t = np.empty((SAMPLES_ACROSS, SAMPLES_ALONG, 2))
    t[..., axis] = along = np.linspace(0.0, 1.0, SAMPLES_ALONG)
    t[..., 1 - axis] = _ACROSS[:, None]
    uv = (low + t * (high - low)).reshape(-1, 2)
    rate = np.ones(1)
    if bent is not None:
        rate = bent.rates(uv[:, axis])[0]
        uv[:, axis] = bent.parameter(uv[:, axis])
    r, *derivatives = surface.evaluate(uv, 1)
    speed = np.linalg.norm(derivatives[axis], axis=1) * rate
    speed = speed.reshape(SAMPLES_ACROSS, SAMPLES_ALONG).mean(axis=0)
    seen = (speed[1:] + speed[:-1]).sum() * 0.5 * (high - low)[axis] / (SAMPLES_ALONG - 1)
    steps = np.linalg.norm(np.diff(r.reshape(*t.shape[:2], 3), axis=1), axis=2)
    way = steps.sum(axis=1).mean()
    if max(seen, way) <= MISSED * min(seen, way):
        return Axis.of(low[axis], high[axis], along, speed, bent)
    return Axis.of_length(*_lengths(surface, axis, bent), bent)


def _lengths(surface: Surface, axis: int, bent: BentAxis | None) -> tuple[np.ndarray, np.ndarray]:
    """Parameters (n,) along an axis, close where the surface is fast, and the length up to each.

    Mean lengths of the chords between them, over lines across. Bent parameters if there are such.
    """
    (low, high), across = surface.domain[axis], surface.domain[1 - axis]

    def points(s: np.ndarray) -> np.ndarray:
        uv = np.empty((len(s), SAMPLES_ACROSS, 2))
        uv[..., axis] = (s if bent is None else bent.parameter(s))[:, None]
        uv[..., 1 - axis] = across[0] + _ACROSS * (across[1] - across[0])
        return surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(len(s), SAMPLES_ACROSS, 3)

    s = np.linspace(low, high, SAMPLES_ALONG)
    r = points(s)
    while True:
        steps = np.linalg.norm(np.diff(r, axis=0), axis=2).mean(axis=1)
        wide = np.diff(s)
        long = (steps > LONG_STEP * steps.sum()) & (wide > FINEST_STEP * (high - low))
        if not long.any() or len(s) > MOST_STEPS:
            break
        place = np.flatnonzero(long) + 1
        middle = 0.5 * (s[place - 1] + s[place])
        s, r = np.insert(s, place, middle), np.insert(r, place, points(middle), axis=0)
    steps = np.maximum(steps, SLOWEST * steps.sum() * wide / (high - low))
    return s, np.concatenate([[0.0], np.cumsum(steps)])
