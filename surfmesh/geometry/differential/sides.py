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

from surfmesh.geometry.differential.infinite_speed import rounding_of_sides
from surfmesh.geometry.small_matrices import norm
from surfmesh.geometry.surface import Domain, Surface

SAMPLES = 65  # points on which two sides are compared; uneven, so that symmetry fools nobody
SAME = 1e-9  # of the bounding box diagonal: sin(pi) is 1e-16, a real gap is far larger

_WALK = (1, 1, -1, -1)  # does t rise when the rectangle is walked counter-clockwise?
# opposite sides first: where several sides coincide, that is what is meant
_PAIRS = ((1, 3), (0, 2), (0, 1), (1, 2), (2, 3), (0, 3))


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
    """Compare the sides of a surface in space."""
    low, high = np.array(surface.domain, float).T
    # ends exact, as those of `side_points`
    uv = np.where(_PLACES < 1.0, low + _PLACES * (high - low), high)
    (cloud,) = surface.evaluate(uv, 0)
    curves = cloud[-4 * SAMPLES :].reshape(4, SAMPLES, 3)
    columns = np.ascontiguousarray(cloud.T)
    of_sides = columns[:, -4 * SAMPLES :].reshape(3, 4, SAMPLES)
    whole = norm(columns.max(axis=1) - columns.min(axis=1))
    tolerance = whole * np.maximum(SAME, rounding_of_sides(surface))

    extents = (of_sides.max(axis=2) - of_sides.min(axis=2)).T
    collapsed = [norm(extent) <= near for extent, near in zip(extents, tolerance.tolist())]
    partner, reverse = [-1] * 4, [False] * 4
    for first, second in _PAIRS:
        if collapsed[first] or collapsed[second] or partner[first] >= 0 or partner[second] >= 0:
            continue
        for backwards in (False, True):
            # the samples are symmetric under t -> 1 - t, so backwards is the same list reversed
            other = curves[second][::-1] if backwards else curves[second]
            if np.abs(curves[first] - other).max() <= max(tolerance[first], tolerance[second]):
                partner[first], partner[second] = second, first
                reverse[first] = reverse[second] = backwards
                break
    return SideTopology(surface.domain, tuple(collapsed), tuple(partner), tuple(reverse))


def _samples() -> np.ndarray:
    """Uneven parameters in [0, 1], symmetric under t -> 1 - t, both ends included."""
    count = (SAMPLES - 1) // 2
    golden = 0.5 * (np.sqrt(5.0) - 1.0)
    half = 0.5 * np.sort((np.arange(1, count) * golden) % 1.0)
    return np.concatenate([[0.0], half, [0.5], 1.0 - half[::-1], [1.0]])


def _places() -> np.ndarray:
    """Where a surface is compared, on the unit square: a grid, then the samples of each side."""
    coarse, unit = np.linspace(0.0, 1.0, 9), ((0.0, 1.0), (0.0, 1.0))
    grid = np.stack(np.meshgrid(coarse, coarse), axis=-1).reshape(-1, 2)
    return np.concatenate([grid, *(side_points(unit, side, _samples()) for side in range(4))])


_PLACES = _places()
