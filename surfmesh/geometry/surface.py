"""What every surface can do: say where it is defined, give r(u,v), its derivatives, bounds."""

from __future__ import annotations

from typing import Any, Protocol, runtime_checkable

import numpy as np

Domain = tuple[tuple[float, float], tuple[float, float]]


@runtime_checkable
class Surface(Protocol):
    """A map from a rectangle of the (u, v) plane into space, twice differentiable.

    domain: ((u0, u1), (v0, v1)), finite, u0 < u1, v0 < v1.
    loops: closed polygons (k, 2) in (u, v) that trim the surface; empty: the whole rectangle.

    These five members are all that is needed; ``name`` may be empty. What a surface may say
    besides, and what is taken where it does not: ``kind`` ("plane", "cylinder", ...: see
    ``surface_kind``), ``facts`` and ``sizing_defaults`` (mappings: nothing is known or asked),
    ``formulas``. The surfaces of CAD faces have ``with_domain`` too: see ``FaceSurface``.
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


def surface_kind(surface: Any) -> str:
    """What kind it says it is, "" for none."""
    return getattr(surface, "kind", "") or ""


def surface_label(surface: Any) -> str:
    """What to call it: its name, else its kind."""
    return surface.name or surface_kind(surface) or "surface"
