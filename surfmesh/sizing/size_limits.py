"""Upper bounds of the size near points: where a round of meshing has found it too large."""

from dataclasses import dataclass

import numpy as np

NEAREST = 8
"""How many of the points may decide at a place: the others are farther and not much finer."""


@dataclass(frozen=True)
class SizeLimits:
    """At distance d from point k the size is at most sizes[k] + slope d."""

    points: np.ndarray
    """(k, 3) in space."""
    sizes: np.ndarray
    """(k,) model units."""
    slope: float
    uv: np.ndarray | None = None
    """(k, 2) parameters of the points: the field is made fine enough there to see them all."""
    essential: bool = False
    """Without them there is no mesh: they go below ``min_size`` too."""
    settled: bool = False
    """The sizes are those of edges, which neighbours with a smaller ``min_size`` may have cut."""

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """Largest size (n,) at points (n, 3)."""
        from scipy.spatial import cKDTree

        count = min(NEAREST, len(self.sizes))
        distance, index = cKDTree(self.points).query(points, k=[*range(1, count + 1)])
        return (self.sizes[index] + self.slope * distance).min(axis=1)

    def joined_with(self, other: "SizeLimits | None") -> "SizeLimits":
        """Both sets of bounds."""
        if other is None:
            return self
        both = self.uv is not None and other.uv is not None
        return SizeLimits(
            np.concatenate([self.points, other.points]),
            np.concatenate([self.sizes, other.sizes]),
            self.slope,
            np.concatenate([self.uv, other.uv]) if both else None,
            self.essential or other.essential,
            self.settled or other.settled,
        )
