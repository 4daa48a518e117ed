"""What the surfaces of CAD faces have in common: a parameter box, periods, plain data."""

from __future__ import annotations

import dataclasses
from typing import Self

import numpy as np

from surfmesh._core import surfaces
from surfmesh.errors import SurfaceError
from surfmesh.geometry.cad_surfaces.plain_data import PlainData
from surfmesh.geometry.surface import Domain

DERIVATIVES = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3))
"""How often by u and by v, in the order in which `evaluate` gives them."""


@dataclasses.dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class FaceSurface(PlainData):
    """The surface under a CAD face. Satisfies `geometry.surface.Surface`; immutable.

    domain: the face's parameter box, finite; it may lie anywhere, also across the seam of a
    periodic surface. `evaluate` takes points outside the box too.
    """

    core: surfaces.Surface = dataclasses.field(init=False)
    """The surface of the compiled core that evaluates this one, made when it is."""

    domain: Domain
    name: str = ""

    kind = ""  # not annotated, so that a subclass may make it a field
    steady_axes = (False, False)  # see `geometry.surface`
    loops = ()  # a face's trimming curves belong to the model, not to the surface

    def __post_init__(self) -> None:
        (u0, u1), (v0, v1) = self.domain
        domain = (float(u0), float(u1)), (float(v0), float(v1))
        # a comparison with nan is False
        if not all(-np.inf < first < last < np.inf for first, last in domain):
            raise SurfaceError(
                f"{self.name or self.kind}: the parameter box u {u0:g} to {u1:g}, "
                f"v {v0:g} to {v1:g} is empty or not finite; give the box of the face"
            )
        self._set(domain=domain, name=self.name or self.kind)
        self._set(core=self._made())

    @property
    def periods(self) -> tuple[float | None, float | None]:
        """The periods of u and v; None where r(u, v) does not come back."""
        return None, None

    @property
    def pieces(self) -> int:
        """How many smooth pieces there are over the domain: a measure of what may be found."""
        return 1

    def evaluate(self, uv: np.ndarray, order: int = 0) -> tuple[np.ndarray, ...]:
        """(n, 2) float -> (n, 3) float arrays in model units, in the order of DERIVATIVES.

        Order 0: (r,). Order 1: (r, r_u, r_v). Order 2: and r_uu, r_uv, r_vv. Order 3: and
        r_uuu, r_uuv, r_uvv, r_vvv.
        """
        return tuple(self.core.evaluate(parameter_pairs(uv), order))

    def _made(self) -> surfaces.Surface:
        """The surface of the core. Vectors and arrays are made plain here, as this comes first."""
        raise NotImplementedError

    def derivative_bounds(
        self, lo: np.ndarray, hi: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray] | None:
        """Not known."""
        return None

    def with_domain(self, domain: Domain) -> Self:
        """The same surface over another box."""
        return self if domain == self.domain else dataclasses.replace(self, domain=domain)


def parameter_pairs(uv: np.ndarray) -> np.ndarray:
    """Whatever holds pairs -> (n, 2) float, contiguous."""
    return np.ascontiguousarray(uv, dtype=float).reshape(-1, 2)
