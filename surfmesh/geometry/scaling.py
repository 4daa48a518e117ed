"""The scaled parameter plane: (x, y) = (u, v) moved to the origin and times one factor each.

On a CAD cylinder u is radians and v millimetres. The factors make the mean speeds |r_u| and
|r_v| one, so that x and y are lengths of the surface's own order and predicates keep digits.
"""

from dataclasses import dataclass

import numpy as np

from surfmesh.geometry.surface import Surface

_SAMPLES = 24


@dataclass(frozen=True)
class Scaling:
    """x = (u - origin[0]) factor[0], y = (v - origin[1]) factor[1]."""

    origin: np.ndarray
    factor: np.ndarray
    extent: np.ndarray
    """Width and height of the domain in the scaled plane."""

    @classmethod
    def of(cls, surface: Surface) -> "Scaling":
        low, high = np.array(surface.domain, float).T
        grid = (np.arange(_SAMPLES) + 0.5) / _SAMPLES
        t = np.stack(np.meshgrid(grid, grid), axis=-1).reshape(-1, 2)
        _, ru, rv = surface.evaluate(low + t * (high - low), 1)
        speed = np.array([np.linalg.norm(ru, axis=1).mean(), np.linalg.norm(rv, axis=1).mean()])
        speed = np.where(speed > 0.0, speed, 1.0)
        return cls(low, speed, speed * (high - low))

    def to_plane(self, uv: np.ndarray) -> np.ndarray:
        """uv (n, 2) -> xy (n, 2)."""
        return (uv - self.origin) * self.factor

    def to_uv(self, xy: np.ndarray) -> np.ndarray:
        """xy (n, 2) -> uv (n, 2)."""
        return xy / self.factor + self.origin
