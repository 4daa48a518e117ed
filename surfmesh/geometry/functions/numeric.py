"""Surfaces given by a Python function instead of formulas."""

from __future__ import annotations

import numbers
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from surfmesh.errors import SurfaceError, shown
from surfmesh.geometry.differential.infinite_speed import (
    BentAxes,
    bent_axes,
    bent_rates,
    by_parameters,
    from_bent,
    is_bent,
    kept_off,
    to_bent,
)
from surfmesh.geometry.formulas.domain_bounds import bounds_of
from surfmesh.geometry.functions.differences import ORDERS, Differences, chosen_differences
from surfmesh.geometry.number_range import RANGE
from surfmesh.geometry.surface import Domain
from surfmesh.geometry.surface_checks import (
    loops_of,
    refuse_extremes,
    refuse_no_area,
    sample_grid,
    table_of,
)

LEAST_STEP = 1e-9
"""Of the domain: nodes nearer to each other differ by round-off."""

WRONG_GRID, WRONG, MOSTLY = 12, 0.2, 0.9
"""Cells each way in whose inner corners derivatives are compared with differences; by how much of
its length one is wrong; and at how many of the corners it may not be."""

CLOSED = 1e-9
"""Of the extent of two sides: so far apart they are one."""

Function = Callable[[np.ndarray, np.ndarray], Any]
"""u (n,), v (n,) -> (x, y, z), each (n,) or a number; or one array (n, 3) or (3, n)."""


class NumericSurface:
    """r(u, v) by a function of numpy arrays. Immutable.

        NumericSurface(lambda u, v: (u, v, np.sin(u * v)), u=(-2, 2), v=(-2, 2))

    f: called with arrays u (n,) and v (n,), never outside of the domain; gives (x, y, z), each (n,)
    or a number, or one array (n, 3) or (3, n). u, v: (first, last). derivatives: called in the
    same way, gives (r_u, r_v) or (r_u, r_v, r_uu, r_uv, r_vv), each like r; what it does not
    give, or gives as not finite, comes from differences. differences: their order, 2, 4 or 6.
    step: distance of their nodes as a fraction of the domain; None: chosen for each variable so
    that truncation and round-off balance. loops: polygons (k, 2) in (u, v) that trim the surface.

    ``difference_error`` tells the error of the differences; ``derivative_bounds`` knows
    nothing, so that a feature smaller than the grid of the size field can be missed: state
    ``max_size`` where there are such. f must be safe to call from where ``mesh`` is called, and
    be picklable (no lambda) if the surface or its mesh shall travel to another process.

    Raises SurfaceError when the domain is empty, f or derivatives give arrays of the wrong shape
    or values that are not finite, derivatives are almost nowhere those of f, or the surface has no
    area. What f raises comes through, with a note that says which places were asked for.
    """

    def __init__(
        self,
        f: Function,
        u: tuple[Any, Any],
        v: tuple[Any, Any],
        derivatives: Function | None = None,
        *,
        differences: int = 4,
        step: float | None = None,
        loops: Sequence[Any] = (),
        name: str = "surface",
        sizing_defaults: Mapping[str, Any] | None = None,
    ) -> None:
        for what, given in (("f", f), ("derivatives", derivatives)):
            if given is not None and not callable(given):
                raise SurfaceError(
                    f"{what} is a function of arrays u and v, not {shown(given)}; "
                    "formulas as text make a ParametricSurface"
                )
        if not isinstance(differences, numbers.Integral) or differences not in ORDERS:
            raise SurfaceError(f"differences are of order 2, 4 or 6, not {shown(differences)}")
        if step is not None and not _is_fraction(step, differences):
            raise SurfaceError(
                f"step is a fraction of the domain, {LEAST_STEP:g} to 1/{differences}, "
                f"not {shown(step)}"
            )
        fixed: dict[str, Any] = {
            "name": str(name),
            "function": f,
            "derivatives": derivatives,
            "domain": (bounds_of("u", u), bounds_of("v", v)),
            "loops": loops_of(loops),
            "sizing_defaults": table_of("sizing_defaults", sizing_defaults),
        }
        self.__dict__.update(fixed, closed=(False, False))
        # refused now rather than later
        refuse_extremes(self._r(sample_grid(self.domain).reshape(-1, 2)), self.domain)
        self.__dict__["bent_axes"] = axes = bent_axes(self._r, self.domain)
        rule, error = chosen_differences(
            lambda s: self._r(from_bent(axes, s)), self.domain, int(differences), step
        )
        self.__dict__["closed"] = (self._is_closed(0), self._is_closed(1))
        self.__dict__.update(differences=rule, difference_error=error)
        if derivatives is not None:
            self._refuse_wrong_derivatives()
        refuse_no_area(self)

    name: str
    function: Function
    derivatives: Function | None
    domain: Domain
    loops: tuple[np.ndarray, ...]
    sizing_defaults: dict[str, Any]
    bent_axes: BentAxes
    """Where the speed has no bound, and parameters in which it has: differences are taken there."""
    differences: Differences
    closed: tuple[bool, bool]
    """Does the surface begin again where u, or v, ends? Violation the one end lies the other."""
    difference_error: float
    """Of second derivatives by differences of r, as a fraction of the largest or of the surface's
    extent, whichever is more: see ``chosen_differences``."""

    def evaluate(self, uv: np.ndarray, order: int = 0) -> tuple[np.ndarray, ...]:
        """(n, 2) float -> (n, 3) float arrays: (r,), (r, r_u, r_v) or up to r_uu, r_uv, r_vv.

        Outside of the domain, be it by a rounding, f is never asked: there the surface goes on
        straight, or from its other end where it is closed. Raises SurfaceError with the place
        where r is not finite or has the wrong shape.
        """
        asked = np.asarray(uv, dtype=float).reshape(-1, 2)
        uv, beyond = self._within(asked)
        outside = np.flatnonzero(beyond.any(axis=1))
        r, *derivatives = self._evaluated(uv, order)
        if len(outside):
            tangents = self._evaluated(uv[outside], 1)[1:]
            for axis in (0, 1):
                r[outside] += beyond[outside, axis, None] * tangents[axis]
        return (r, *derivatives)

    def _evaluated(self, uv: np.ndarray, order: int) -> tuple[np.ndarray, ...]:
        """The same for places of the domain."""
        r = self._r(uv)
        if order == 0:
            return (r,)
        count = 2 if order == 1 else 5
        if not len(uv):
            return (r, *(np.empty((0, 3)) for _ in range(count)))
        if self.derivatives is None:
            return (r, *self._by_differences(uv, count))
        uv = kept_off(self.bent_axes, uv)
        given = self._given(uv)
        if len(given) < count:
            given = (*given[:2], *self._second_from_first(uv))
        given = tuple(given[:count])
        broken = ~(np.abs(np.hstack(given)) <= RANGE.bend).all(axis=1)
        if broken.any():  # a pole, as a rule
            better = self._by_differences(uv[broken], count)
            for value, replacement in zip(given, better):
                value[broken] = replacement
        return (r, *given)

    def with_domain(self, domain: Domain) -> NumericSurface:
        """The same function over another domain, within this one."""
        other = object.__new__(NumericSurface)
        whole = tuple(
            closed and span == part for closed, span, part in zip(self.closed, self.domain, domain)
        )
        other.__dict__.update(self.__dict__, domain=domain, closed=whole)
        return other

    def derivative_bounds(self, lo: np.ndarray, hi: np.ndarray) -> None:
        """None: a function cannot be bounded between its values."""
        return None

    def _is_closed(self, axis: int) -> bool:
        """Are the two sides at the ends of a variable the same curve, run through alike?"""
        sides = np.moveaxis(sample_grid(self.domain), axis, 0)[[0, -1]]
        first, last = (self._r(np.ascontiguousarray(side)) for side in sides)
        extent = float(np.ptp(np.concatenate([first, last]), axis=0).max())
        return extent > 0.0 and bool(np.abs(first - last).max() <= CLOSED * extent)

    def _within(self, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Places (n, 2) of the domain that stand for uv (n, 2), and the steps from there to it."""
        (u0, u1), (v0, v1) = self.domain
        lo, hi = np.array([u0, v0]), np.array([u1, v1])
        outside = (uv < lo) | (uv > hi)
        if not outside.any():
            return uv, np.zeros((0, 2))
        uv = uv.copy()
        for axis in np.flatnonzero(self.closed):
            rows = outside[:, axis]
            turned = np.mod(uv[rows, axis] - lo[axis], hi[axis] - lo[axis])
            uv[rows, axis] = lo[axis] + turned
        place = np.clip(uv, lo, hi)
        return place, uv - place

    def _r(self, uv: np.ndarray) -> np.ndarray:
        (r,) = _called(self.function, uv, "f")
        usable = (np.abs(r) <= RANGE.coordinate).all(axis=1)
        if not usable.all():
            row = int(np.argmin(usable))
            beyond = np.isfinite(r[row]).all()
            what = f"beyond {RANGE.coordinate:g}" if beyond else "not finite"
            raise SurfaceError(
                f"f of {self.name!r} is {what} at (u, v) = ({uv[row, 0]:.6g}, {uv[row, 1]:.6g}); "
                "change the function or the domain"
            )
        return r

    def _given(self, uv: np.ndarray) -> tuple[np.ndarray, ...]:
        """What ``derivatives`` gives: two or five arrays (n, 3)."""
        assert self.derivatives is not None  # noqa: S101 for mypy: callers have looked
        found = _called(self.derivatives, uv, "derivatives")
        if len(found) not in (2, 5):
            raise SurfaceError(
                "derivatives gives (r_u, r_v) or (r_u, r_v, r_uu, r_uv, r_vv), each like r"
            )
        return found

    def _refuse_wrong_derivatives(self) -> None:
        """Raise SurfaceError where given slopes are others than those of f, almost everywhere.

        At poles, kinks and the like they may well differ.
        """
        uv = sample_grid(self.domain, WRONG_GRID)[1:-1, 1:-1].reshape(-1, 2)
        uv = kept_off(self.bent_axes, uv)
        for name, given, found in zip(("r_u", "r_v"), self._given(uv), self._by_differences(uv, 2)):
            size = np.linalg.norm(found, axis=1)
            with np.errstate(invalid="ignore", over="ignore"):
                deviation = np.linalg.norm(given - found, axis=1)
                wrong = deviation > WRONG * np.maximum(size, np.median(size))
            if np.mean(wrong) > MOSTLY:
                row = int(np.argmax(np.where(wrong & np.isfinite(deviation), deviation, -1.0)))
                raise SurfaceError(
                    f"derivatives of {self.name!r} gives {name} = {_listed(given[row])} at "
                    f"(u, v) = {_listed(uv[row])}, where f changes by {_listed(found[row])}: "
                    "change one of them, or leave derivatives out"
                )

    def _by_differences(self, uv: np.ndarray, count: int) -> tuple[np.ndarray, ...]:
        rule, axes = self.differences, self.bent_axes
        if not is_bent(axes):
            return rule.first(self._r, uv) if count == 2 else rule.both(self._r, uv)
        s = to_bent(axes, uv)
        taken = rule.first if count == 2 else rule.both
        found = taken(lambda place: self._r(from_bent(axes, place)), s)
        return by_parameters(found, *bent_rates(axes, s))

    def _second_from_first(self, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """r_uu, r_uv, r_vv by differences of r_u and r_v; r_uv is the mean of its two."""

        axes, s = self.bent_axes, to_bent(self.bent_axes, uv)

        def first(place: np.ndarray) -> np.ndarray:
            return np.hstack(self._given(kept_off(axes, from_bent(axes, place)))[:2])

        rates, _ = bent_rates(axes, s)
        along_u, along_v = self.differences.first(first, s)
        along_u, along_v = along_u / rates[:, :1], along_v / rates[:, 1:]
        return along_u[:, :3], 0.5 * (along_u[:, 3:] + along_v[:, :3]), along_v[:, 3:]

    def __repr__(self) -> str:
        (u0, u1), (v0, v1) = self.domain
        called = getattr(self.function, "__name__", type(self.function).__name__)
        return f"NumericSurface({self.name!r}, {called}, u=({u0:g}, {u1:g}), v=({v0:g}, {v1:g}))"

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"a surface does not change; make a new one to set {name!r}")


def _listed(numbers: np.ndarray) -> str:
    return "(" + ", ".join(f"{x:.6g}" for x in numbers) + ")"


def _called(function: Function, uv: np.ndarray, what: str) -> tuple[np.ndarray, ...]:
    """What ``f`` or ``derivatives`` gives at uv (n, 2): one array (n, 3), or several."""
    n = len(uv)
    if n == 3:  # of an array (3, 3) nobody could tell which axis is which
        uv = np.concatenate([uv, uv[-1:]])
    u, v = uv[:, 0].copy(), uv[:, 1].copy()
    try:
        with np.errstate(all="ignore"):  # values that cannot be used are refused with their place
            found = function(u, v)
    except (TypeError, ValueError) as error:  # so say math.sin(u), and "if u > 0"
        _refuse_scalar_functions(function, float(uv[0, 0]), float(uv[0, 1]), what, error)
        error.add_note(_asked(what, uv))
        raise
    except Exception as error:
        error.add_note(_asked(what, uv))
        raise
    several = found if what == "derivatives" and isinstance(found, (tuple, list)) else (found,)
    return tuple(_rows(value, len(uv), what)[:n] for value in several)


def _asked(what: str, uv: np.ndarray) -> str:
    (u0, v0), (u1, v1) = uv.min(axis=0), uv.max(axis=0)
    return (
        f"raised by {what} when surfmesh asked for {len(uv)} places with u from {u0:.6g} to "
        f"{u1:.6g} and v from {v0:.6g} to {v1:.6g}"
    )


def _is_fraction(step: Any, differences: int) -> bool:
    try:
        return bool(LEAST_STEP <= step and step * differences <= 1.0)
    except (TypeError, ValueError):
        return False


def _refuse_scalar_functions(
    function: Function, u: float, v: float, what: str, error: Exception
) -> None:
    """Raise SurfaceError with a cure if the function understands numbers, but no arrays."""
    try:
        one = function(u, v)  # type: ignore[arg-type]  # numbers on purpose
        size = np.size(one[0]) if what == "derivatives" else np.size(one)
    except Exception:  # whatever it is: what was raised first is said
        return
    if size != 3:
        return
    signature = "" if isinstance(one, tuple) else ", signature='(),()->(n)'"
    raise SurfaceError(
        f"{what} takes single numbers only, not arrays ({error}): write it with numpy's functions "
        f"(np.sin, np.where), or give np.vectorize({what}{signature}), which is slower"
    ) from error


def _is_complex(value: Any) -> bool:
    try:
        return bool(np.iscomplexobj(value))
    except ValueError:  # rows of different lengths
        return False


def _unmasked(value: Any) -> Any:
    """What is masked is not known: nan."""
    return np.ma.filled(value.astype(float), np.nan) if np.ma.isMaskedArray(value) else value


def _rows(value: Any, count: int, what: str) -> np.ndarray:
    """What a function gave as an array (n, 3) of its own; SurfaceError when it cannot be one."""
    parts = value if isinstance(value, (tuple, list)) else (value,)
    if any(_is_complex(part) for part in parts):
        raise SurfaceError(
            f"{what} gives complex numbers: give their real parts, or change it where a root or "
            "logarithm of a negative number is taken"
        )
    try:
        if isinstance(value, (tuple, list)):
            if len(value) != 3:
                raise ValueError
            rows = np.empty((count, 3))
            for axis, coordinate in enumerate(value):
                rows[:, axis] = _unmasked(coordinate)
            return rows
        array: Any = np.array(_unmasked(value), dtype=float)
    except (TypeError, ValueError, OverflowError):
        array = np.empty(0)
    if array.shape == (count, 3):
        return array
    if array.shape == (3, count):
        return np.ascontiguousarray(array.T)
    shape = np.shape(value) if isinstance(value, np.ndarray) else type(value).__name__
    raise SurfaceError(
        f"{what} must give (x, y, z), each of shape ({count},) or a number, or an array "
        f"({count}, 3) for u and v of shape ({count},); it gave {shape}"
    )
