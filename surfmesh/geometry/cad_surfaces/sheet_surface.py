"""A surface of formulas, or of a caller's function, as that under a face."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from surfmesh._core import surfaces
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.surface import BoundedSurface, Domain, Surface, steady_axes


@dataclass(frozen=True, eq=False, repr=False)
class SheetSurface(FaceSurface):
    """basis: any `geometry.surface.Surface`; what it knows of its bounds is kept."""

    basis: Surface
    kind: str = field(init=False, default="formula")
    """"formula" where its bounds are known, else "function"."""
    steady_axes: tuple[bool, bool] = field(init=False, default=(False, False))

    def _made(self) -> surfaces.Surface:
        self._set(kind="formula" if isinstance(self.basis, BoundedSurface) else "function")
        self._set(steady_axes=steady_axes(self.basis))
        return as_core_surface(_within(self.basis, self.domain))

    def derivative_bounds(
        self, lo: np.ndarray, hi: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray] | None:
        """As those of the basis."""
        return self.basis.derivative_bounds(lo, hi)


def _within(basis: Surface, domain: Domain) -> Surface:
    """The same over a box of its domain; what lies beyond that by rounding is cut off."""
    box: Any = tuple(
        (max(low, first), min(high, last))
        for (low, high), (first, last) in zip(domain, basis.domain)
    )
    if box == basis.domain:
        return basis
    return basis.with_domain(box) if hasattr(basis, "with_domain") else _Part(basis, box)


@dataclass(frozen=True)
class _Part:
    """A surface that cannot be cut itself, over a part of its domain."""

    basis: Surface
    domain: Domain

    @property
    def name(self) -> str:
        return self.basis.name

    @property
    def loops(self) -> tuple[np.ndarray, ...]:
        return ()

    def evaluate(self, uv: np.ndarray, order: int = 0) -> tuple[np.ndarray, ...]:
        return self.basis.evaluate(uv, order)

    def derivative_bounds(self, lo: np.ndarray, hi: np.ndarray) -> Any:
        return self.basis.derivative_bounds(lo, hi)
