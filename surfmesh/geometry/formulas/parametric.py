"""Surfaces given by three formulas in u and v."""

from __future__ import annotations

import numbers
from collections.abc import Mapping, Sequence
from typing import Any, NoReturn

import numpy as np

from surfmesh._core import surfaces
from surfmesh.errors import FormulaError, SurfaceError, shown
from surfmesh.geometry.differential.infinite_speed import (
    STRAIGHT,
    BentAxes,
    bent_axes,
    zeros_between,
)
from surfmesh.geometry.formulas.compiled_ahead import CompiledFormulas
from surfmesh.geometry.formulas.domain_bounds import bounds_of
from surfmesh.geometry.formulas.tape import Tape
from surfmesh.geometry.surface import Domain
from surfmesh.geometry.surface_checks import (
    loops_of,
    refuse_extremes,
    refuse_no_area,
    sample_grid,
    table_of,
)

ROOT_SAMPLES = 1025
"""Points along an axis at which signs of what roots are taken of are looked at."""

POLE_DEPTH = 52  # halvings of a cell before a value without bounds counts as a pole
POLE_CELLS = 64  # cells followed at a time in the search for a pole


class ParametricSurface:
    """r(u, v) = (x, y, z), differentiated symbolically, evaluated by a tape. Immutable.

    x, y, z: formulas as text, SymPy expressions or numbers. u, v: (first, last), numbers or
    text such as "2*pi". parameters: names used in the formulas, with their values. loops:
    polygons (k, 2) in (u, v) that trim the surface. description, sizing_defaults, facts: what
    is known about the surface, kept for whoever asks. compiled: what follows from formulas, bounds
    and parameters, where that is known already.

    Raises FormulaError for a formula that is refused, SurfaceError when the domain is empty,
    a coordinate is not finite somewhere in it, or the surface has no area.
    """

    def __init__(
        self,
        x: Any,
        y: Any,
        z: Any,
        u: tuple[Any, Any],
        v: tuple[Any, Any],
        parameters: Mapping[str, float] | None = None,
        loops: Sequence[Any] = (),
        name: str = "surface",
        description: str = "",
        sizing_defaults: Mapping[str, Any] | None = None,
        facts: Mapping[str, Any] | None = None,
        *,
        compiled: CompiledFormulas | None = None,
    ) -> None:
        ready = compiled
        fixed: dict[str, Any] = {
            "name": str(name),
            "parameters": dict(parameters or {}) if ready else _named_numbers(parameters),
            "domain": ready.domain if ready else (bounds_of("u", u), bounds_of("v", v)),
            "description": str(description),
            "sizing_defaults": table_of("sizing_defaults", sizing_defaults),
            "facts": table_of("facts", facts),
            "loops": loops_of(loops),
        }
        if ready is None:
            fixed["_expressions"] = _parsed((x, y, z), fixed["parameters"])
        fixed["formulas"] = tuple(" ".join(str(axis).split()) for axis in (x, y, z))
        fixed["_tapes"] = {} if ready is None else dict(ready.tapes)
        fixed["_core_surfaces"] = {}
        fixed["bent_axes"] = STRAIGHT
        self.__dict__.update(fixed)
        with np.errstate(all="ignore"):  # what cannot be used is refused with its place
            _refuse_values_that_are_not_finite(self)
            self.__dict__["_root_places"] = (
                _places_of_roots(self._expressions, self.domain) if ready is None
                else ready.root_places
            )  # fmt: skip
            self.__dict__["bent_axes"] = bent_axes(
                lambda uv: self.evaluate(uv)[0], self.domain, self._root_places
            )
            self._core_surfaces.clear()  # made before the axes were known
            refuse_no_area(self)

    name: str
    formulas: tuple[str, str, str]
    parameters: dict[str, float]
    domain: Domain
    loops: tuple[np.ndarray, ...]
    description: str
    sizing_defaults: dict[str, Any]
    facts: dict[str, Any]
    bent_axes: BentAxes
    """Where the speed has no bound, and parameters in which it has."""
    _expressions: tuple[Any, Any, Any]
    _root_places: tuple[list[float], list[float]]
    _tapes: dict[int, Tape]
    _core_surfaces: dict[tuple[int, ...], surfaces.FormulaSurface]

    def evaluate(self, uv: np.ndarray, order: int = 0) -> tuple[np.ndarray, ...]:
        """(n, 2) float -> (n, 3) float arrays: (r,), (r, r_u, r_v) or up to r_uu, r_uv, r_vv.

        Where a derivative is not finite (the apex of a cone) the derivatives are those a
        billionth of the domain further inside; where speeds have no bound (the rim of
        z = sqrt(1 - u^2)), those as near to that place as ``bent_axes`` has it. r itself is
        left as it is.
        """
        uv = np.asarray(uv, dtype=float).reshape(-1, 2)
        return tuple(self._in_core(order).evaluate(uv, order))

    @property
    def core(self) -> surfaces.FormulaSurface:
        """The same surface in the core, with all that it can do."""
        return self._in_core(0, 1, 2)

    def _in_core(self, *orders: int) -> surfaces.FormulaSurface:
        """The same with derivatives of these orders alone: each takes time to differentiate."""
        if orders not in self._core_surfaces:
            limits = [
                ([], [], []) if axis is None else (axis.places.tolist(), *axis.limits())
                for axis in self.bent_axes
            ]
            self._core_surfaces[orders] = surfaces.FormulaSurface(
                [self.tape(order).program if order in orders else None for order in range(3)],
                self.domain,
                (limits[0], limits[1]),
            )
        return self._core_surfaces[orders]

    def derivative_bounds(self, lo: np.ndarray, hi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Bounds of r_u, r_v, r_uu, r_uv, r_vv over cells by interval arithmetic.

        Of the smooth pieces in a cell, whether there are kinks between them or not.

        lo, hi: (n, 2) corners of the cells -> lower, upper: (n, 5, 3), infinite where unknown.
        """
        lo, hi = np.asarray(lo, dtype=float), np.asarray(hi, dtype=float)
        found = self._in_core(2).derivative_bounds(lo, hi)
        assert found is not None  # noqa: S101  a surface of formulas always knows them
        return found

    def with_domain(self, domain: Domain) -> ParametricSurface:
        """The same formulas over another domain, within this one."""
        other = object.__new__(ParametricSurface)
        other.__dict__.update(self.__dict__, domain=domain, _core_surfaces={})
        other.__dict__["bent_axes"] = bent_axes(
            lambda uv: other.evaluate(uv)[0], domain, self._root_places
        )
        other._core_surfaces.clear()
        return other

    def all_bounds(self, lo: np.ndarray, hi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Bounds of r, r_u, r_v, r_uu, r_uv, r_vv over cells: lower, upper (n, 6, 3).

        lo, hi: (n, 2) corners of the cells. Second derivatives have none across a kink, first
        ones none across a jump.
        """
        lower, upper = self.tape(2).bounds(lo, hi)
        return lower.reshape(-1, 6, 3), upper.reshape(-1, 6, 3)

    def guides(self) -> Tape | None:
        """The functions whose zeros are kinks of the surface, each with its two derivatives."""
        if -1 not in self._tapes and "_expressions" in self.__dict__:
            from surfmesh.geometry.formulas.compilation import guide_tape
            from surfmesh.geometry.formulas.parser import symbol

            made = guide_tape(self._expressions, (symbol("u"), symbol("v")))
            if made is None:
                return None
            self._tapes[-1] = made
        return self._tapes.get(-1)

    def compiled(self) -> CompiledFormulas:
        """What follows from the formulas, to make the same surface of without SymPy."""
        for order in range(3):
            self.tape(order)
        self.guides()
        return CompiledFormulas(self.domain, self._root_places, dict(self._tapes))

    def tape(self, order: int) -> Tape:
        """The program behind `evaluate`, made when it is first needed."""
        if order not in self._tapes:
            # SymPy takes a third of a second to import: only where a formula is differentiated
            from surfmesh.geometry.formulas.compilation import surface_tape
            from surfmesh.geometry.formulas.parser import symbol

            variables = (symbol("u"), symbol("v"))
            self._tapes[order] = surface_tape(self._expressions, variables, order)
        return self._tapes[order]

    def __repr__(self) -> str:
        formulas = ", ".join(f"{c}={f!r}" for c, f in zip("xyz", self.formulas))
        (u0, u1), (v0, v1) = self.domain
        more = "".join(f", {name}={value:g}" for name, value in self.parameters.items())
        trimmed = f", loops={len(self.loops)}" if self.loops else ""
        bounds = f"u=({u0:g}, {u1:g}), v=({v0:g}, {v1:g})"
        return f"ParametricSurface({self.name!r}, {formulas}, {bounds}{more}{trimmed})"

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"a surface does not change; make a new one to set {name!r}")

    def __getstate__(self) -> dict[str, Any]:
        # tapes travel, expressions do not: a worker process then never needs SymPy
        self.compiled()
        stays = ("_expressions", "_core_surfaces")
        return {key: value for key, value in self.__dict__.items() if key not in stays}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state, _core_surfaces={})


def _named_numbers(parameters: Any) -> dict[str, float]:
    """Parameters as they were given, once they are known to be numbers with usable names."""
    from surfmesh.geometry.formulas.function_table import RESERVED
    from surfmesh.geometry.formulas.parser import is_finite

    named = table_of("parameters", parameters)
    for name, value in named.items():
        if not isinstance(name, str) or not name.isidentifier() or not name.isascii():
            reason = f"{shown(name)} cannot name a parameter: use letters, digits and _"
            raise SurfaceError(reason)
        if name in RESERVED or name in ("u", "v"):
            raise SurfaceError(f"the parameter {name!r} has the name of something known already")
        if isinstance(value, bool) or not isinstance(value, numbers.Real):
            raise SurfaceError(f"the parameter {name!r} is not a number: {shown(value)}")
        if not is_finite(value):
            raise SurfaceError(f"the parameter {name!r} is not finite: {shown(value)}")
    return named


def _parsed(coordinates: Sequence[Any], parameters: Mapping[str, float]) -> tuple:
    from surfmesh.geometry.formulas.expression import parse

    expressions = []
    for axis, coordinate in zip("xyz", coordinates):
        try:
            expressions.append(parse(coordinate, ("u", "v"), parameters))
        except FormulaError as error:
            raise FormulaError(f"{axis}: {error.reason}", error.text, error.column) from None
    return tuple(expressions)


def _places_of_roots(
    expressions: tuple[Any, Any, Any], domain: Domain
) -> tuple[list[float], list[float]]:
    """Values of u, and of v, between the ends of the domain at which a root is taken of zero."""
    from surfmesh.geometry.formulas.compilation import roots_of_one_parameter
    from surfmesh.geometry.formulas.parser import symbol

    places: tuple[list[float], list[float]] = [], []
    for axis, tape in roots_of_one_parameter(expressions, (symbol("u"), symbol("v"))):
        first, last = domain[axis]

        def value(x: Any, axis: int = axis, tape: Tape = tape) -> Any:
            uv = np.full((np.size(x), 2), np.mean(domain[1 - axis]))
            uv[:, axis] = x
            found = tape.evaluate(uv)[0][:, 0]
            return found if np.ndim(x) else float(found[0])

        at = np.linspace(first, last, ROOT_SAMPLES)
        places[axis].extend(x for x in zeros_between(value(at), at, value) if first < x < last)
    return sorted(set(places[0])), sorted(set(places[1]))


def _refuse_values_that_are_not_finite(surface: ParametricSurface) -> None:
    """Try the corners of a grid, then look for poles in the cells that have no bounds."""
    grid = sample_grid(surface.domain)
    points = grid.reshape(-1, 2)
    (values,) = surface.evaluate(points)
    finite = np.isfinite(values)
    if not finite.all():
        point, axis = np.argwhere(~finite)[0]
        _refuse(surface, points[point], axis)
    refuse_extremes(values, surface.domain)
    lo, hi = grid[:-1, :-1].reshape(-1, 2), grid[1:, 1:].reshape(-1, 2)
    tape = surface.tape(0)
    for depth in range(POLE_DEPTH):
        unbounded = ~np.isfinite(np.hstack(tape.bounds(lo, hi))).all(axis=1)
        if not unbounded.any():
            return
        keep = np.flatnonzero(unbounded)
        if len(keep) > POLE_CELLS:  # a line of poles: follow a few of them, evenly spread
            keep = keep[np.linspace(0, len(keep) - 1, POLE_CELLS).astype(int)]
        lo, hi = _halved(lo[keep], hi[keep], axis=depth % 2)
    bounds = np.hstack([np.abs(b) for b in tape.bounds(lo, hi)])
    unbounded = np.argwhere(~np.isfinite(bounds))
    if len(unbounded):
        cell, axis = unbounded[0]
        _refuse(surface, lo[cell], axis % 3)


def _halved(lo: np.ndarray, hi: np.ndarray, axis: int) -> tuple[np.ndarray, np.ndarray]:
    middle = 0.5 * (lo[:, axis] + hi[:, axis])
    first_hi, second_lo = hi.copy(), lo.copy()
    first_hi[:, axis] = middle
    second_lo[:, axis] = middle
    return np.concatenate([lo, second_lo]), np.concatenate([first_hi, hi])


def _refuse(surface: ParametricSurface, place: np.ndarray, axis: int) -> NoReturn:
    formula = surface.formulas[axis]
    shown = formula if len(formula) <= 60 else formula[:57] + "..."
    raise SurfaceError(
        f"{'xyz'[axis]} = {shown} is not a finite real number at (u, v) = "
        f"({place[0]:.6g}, {place[1]:.6g}); change the formula or the domain"
    )
