"""What every surface can do: say where it is defined, give r(u,v), its derivatives, bounds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol, runtime_checkable

import numpy as np

Domain = tuple[tuple[float, float], tuple[float, float]]


@runtime_checkable
class Surface(Protocol):
    """A map from a rectangle of the (u, v) plane into space, twice differentiable.

    domain: ((u0, u1), (v0, v1)), finite, u0 < u1, v0 < v1.
    loops: closed polygons (k, 2) in (u, v) that trim the surface; empty: the whole rectangle.

    These five members are all that is needed; ``name`` may be empty. A surface may be able to do
    more, and say more of itself, each where the code asks for it:

        BoundedSurface    bounds of r itself over cells
        surface_kind      ``kind``: "plane", "cylinder", ...; nothing is taken for granted without
        stated_facts      ``facts``: area, volume, Euler number, embedded
        stated_sizes      ``sizing_defaults``: what is asked where the caller asks for nothing
        smooth_pieces     ``pieces``: how many, of a spline between its knots
        steady_axes       ``steady_axes``: where |r_u| or |r_v| need not be sampled

    What only surfaces of formulas or of CAD faces can do is in their classes: ``ParametricSurface``
    and ``FaceSurface``.
    """

    @property
    def name(self) -> str: ...

    @property
    def domain(self) -> Domain: ...

    @property
    def loops(self) -> tuple[np.ndarray, ...]: ...

    def evaluate(self, uv: np.ndarray, order: int = 0) -> tuple[np.ndarray, ...]:
        """(n, 2) float -> (n, 3) float arrays in model units.

        Order 0: (r,). Order 1: (r, r_u, r_v). Order 2: (r, r_u, r_v, r_uu, r_uv, r_vv).
        """
        ...

    def derivative_bounds(
        self, lo: np.ndarray, hi: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray] | None:
        """Bounds of r_u, r_v, r_uu, r_uv, r_vv over cells, or None when they are not known.

        lo, hi: (n, 2) corners of the cells -> lower, upper: (n, 5, 3), infinite where unknown.
        """
        ...


@runtime_checkable
class BoundedSurface(Surface, Protocol):
    """A surface that can bound r too: nothing of it is missed between points."""

    def all_bounds(self, lo: np.ndarray, hi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Bounds of r, r_u, r_v, r_uu, r_uv, r_vv over cells: lower, upper (n, 6, 3)."""
        ...


def surface_kind(surface: Surface) -> str:
    """What kind it says it is, "" for none."""
    return getattr(surface, "kind", "") or ""


def stated_facts(surface: Surface) -> Mapping[str, Any]:
    """What it says is known of it: "area", "volume", "euler", "embedded"."""
    return getattr(surface, "facts", None) or {}


def stated_sizes(surface: Surface) -> Mapping[str, Any]:
    """The size requests that it comes with, by the names of ``Sizing``."""
    return getattr(surface, "sizing_defaults", None) or {}


def steady_axes(surface: Surface) -> tuple[bool, bool]:
    """Whether |r_u| is the same all along u (it may depend on v), and |r_v| all along v."""
    u, v = getattr(surface, "steady_axes", None) or (False, False)
    return bool(u), bool(v)


def smooth_pieces(surface: Surface) -> int | None:
    """Of how many smooth pieces it says it is made, as a spline between its knots."""
    return getattr(surface, "pieces", None)


def surface_label(surface: Surface) -> str:
    """What to call it: its name, else its kind."""
    return surface.name or surface_kind(surface) or "surface"
