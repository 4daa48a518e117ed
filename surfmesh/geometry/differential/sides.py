"""The four sides of the (u, v) rectangle: which coincide in space, which shrink to a point.

v1 +-----2-----+       sides are numbered counter-clockwise; walking round, 0 and 1
   |           |       are followed with their variable rising, 2 and 3 with it falling
   3           1       a side's own parameter t in [0, 1] always RISES with its variable:
   |           |       side 0: u along v = v0      side 1: v along u = u1
v0 +-----0-----+       side 2: u along v = v1      side 3: v along u = u0
   u0          u1
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfmesh._core import surfaces
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.differential.infinite_speed import rounding_of_sides
from surfmesh.geometry.surface import Domain, Surface

_WALK = (1, 1, -1, -1)  # does t rise when the rectangle is walked counter-clockwise?


@dataclass(frozen=True)
class SideTopology:
    """How the sides of one surface are joined; each tuple has an entry a side."""

    domain: Domain
    collapsed: tuple[bool, ...]  # the side is one point in space
    partner: tuple[int, ...]  # the side that it coincides with, or -1
    reversed: tuple[bool, ...]  # t meets 1 - t of the partner

    @property
    def one_sided(self) -> bool:
        """Whether the joined surface has one side only (Moebius strip, Klein bottle).

        A joint keeps the orientation when, walking round the rectangle, its two sides are
        followed in opposite directions in space.
        """
        for side, partner in enumerate(self.partner):
            if partner < 0:
                continue
            along = _WALK[side] * _WALK[partner] * (-1 if self.reversed[side] else 1)
            if along > 0:
                return True
        return False

    @property
    def closed(self) -> bool:
        """Whether no side is left open."""
        return all(c or p >= 0 for c, p in zip(self.collapsed, self.partner))

    def points(self, side: int, t: np.ndarray) -> np.ndarray:
        """(u, v) of a side's own parameter: t (n,) in [0, 1] -> (n, 2), ends exact."""
        return side_points(self.domain, side, t)

    def broken_invariant(self) -> str:
        """The first broken invariant in words, or "" when all hold."""
        for side, partner in enumerate(self.partner):
            if partner < 0:
                if self.reversed[side]:
                    return f"side {side} has no partner but runs against it"
            elif partner == side or self.partner[partner] != side:
                return f"side {side} has partner {partner}, which does not have it"
            elif self.reversed[side] != self.reversed[partner]:
                return f"sides {side} and {partner} disagree about their direction"
            elif self.collapsed[side]:
                return f"side {side} is a point and has a partner"
        return ""


def side_points(domain: Domain, side: int, t: np.ndarray) -> np.ndarray:
    """(u, v) along a side: t (n,) in [0, 1], rising with the side's variable -> (n, 2)."""
    (u0, u1), (v0, v1) = domain
    t = np.asarray(t, dtype=float)
    rising_u = np.where(t < 1.0, u0 + t * (u1 - u0), u1)
    rising_v = np.where(t < 1.0, v0 + t * (v1 - v0), v1)
    fixed = (v0, u1, v1, u0)[side]
    pair = (rising_u, fixed) if side in (0, 2) else (fixed, rising_v)
    return np.stack(np.broadcast_arrays(*pair), axis=-1)


def find_sides(surface: Surface) -> SideTopology:
    """Compare the sides of a surface in space (``src/surfaces/coincident_sides.hpp``)."""
    rounding = rounding_of_sides(surface).tolist()
    collapsed, partner, backwards = surfaces.coincident_sides(as_core_surface(surface), rounding)
    return SideTopology(surface.domain, tuple(collapsed), tuple(partner), tuple(backwards))
