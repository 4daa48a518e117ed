"""Sizes at points, growing from each: what another mesh, or a solver, has found.

Points are sorted by their sizes into octaves, in which sizes differ by less than a factor of two:
the few points of each octave that are nearest to a place stand for all of it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from surfmesh.errors import SizingError
from surfmesh.sizing.options.sources import MOST_MARKS, Source

NEAREST = 4
"""How many points of each octave of sizes of a cloud decide at a place."""


@dataclass(frozen=True, eq=False)
class SizeCloud(Source):
    """Sizes at points, growing from each: what another mesh, or a solver, has found.

    points: (n, 3). sizes: (n,) wanted edge lengths. growth: ratio of neighbouring sizes away from
    a point. reach: distance from a point beyond which it asks for nothing; None: no end.

    Raises ``SizingError`` for arrays of other shapes and sizes that are not positive.
    """

    points: np.ndarray
    sizes: np.ndarray
    growth: float = 1.2
    reach: float | None = None

    radius = 0.0
    _trees: list = field(default_factory=list, repr=False)

    def __post_init__(self) -> None:
        try:
            points = np.atleast_2d(np.array(self.points, float))
            sizes = np.atleast_1d(np.array(self.sizes, float))
        except (TypeError, ValueError):
            raise SizingError("the points and sizes of a cloud must be numbers") from None
        if points.shape != (len(sizes), 3) or sizes.ndim != 1 or not len(sizes):
            raise SizingError(
                f"a cloud needs points (n, 3) and sizes (n,), not {points.shape}, {sizes.shape}"
            )
        if not (np.isfinite(points).all() and np.isfinite(sizes).all() and (sizes > 0.0).all()):
            raise SizingError("the points of a cloud must be finite, its sizes positive")
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "sizes", sizes)
        object.__setattr__(self, "_trees", [])
        self._check_growth()

    @classmethod
    def of_mesh(cls, mesh: Any, factor: float = 1.0, growth: float = 1.2) -> SizeCloud:
        """The mean length of the edges at each vertex of a mesh (points, triangles), scaled."""
        corners = np.asarray(mesh.triangles if hasattr(mesh, "triangles") else mesh.faces)
        if np.issubdtype(corners.dtype, np.floating):  # trimesh: faces are numbers, triangles not
            corners = np.asarray(mesh.faces)
        places = np.asarray(mesh.points if hasattr(mesh, "points") else mesh.vertices, float)
        ends = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
        length = np.linalg.norm(places[ends[:, 1]] - places[ends[:, 0]], axis=1)
        total = np.bincount(ends.ravel(), np.repeat(length, 2), len(places))
        count = np.bincount(ends.ravel(), minlength=len(places))
        used = (count > 0) & (total > 0.0)
        return cls(places[used], factor * total[used] / count[used], growth)

    @cached_property
    def size(self) -> float:  # type: ignore[override]  # of no other source it is a result
        """The smallest."""
        return float(self.sizes.min())

    def __call__(self, points: np.ndarray) -> np.ndarray:
        points = np.asarray(points, float)
        found = np.full(len(points), np.inf)
        for tree, sizes in self._octaves():
            count = min(NEAREST, len(sizes))
            most = np.inf if self.reach is None else self.reach
            distance, row = tree.query(points, k=[*range(1, count + 1)], distance_upper_bound=most)
            padded = np.append(sizes, np.inf)  # of what is too far away
            grown = padded[row] + self.slope * np.where(np.isfinite(distance), distance, 0.0)
            np.minimum(found, grown.min(axis=1), out=found)
        return found

    def _octaves(self) -> list:
        """Of points whose sizes are alike the nearest decide; trees are made when first used."""
        if not self._trees:
            from scipy.spatial import cKDTree

            octave = np.floor(np.log2(self.sizes / self.sizes.min())).astype(int)
            for k in np.unique(octave):
                own = octave == k
                self._trees.append((cKDTree(self.points[own]), self.sizes[own]))
        return self._trees

    @cached_property
    def marks(self) -> np.ndarray:
        """(k, 3) points where the size is smallest."""
        if len(self.points) <= MOST_MARKS:
            return self.points
        order = np.argsort(self.sizes, kind="stable")  # the smallest, and some of all
        some = order[:: -(-len(order) // (MOST_MARKS // 2))]
        return self.points[np.union1d(order[: MOST_MARKS // 2], some)]

    def _extent(self) -> tuple[np.ndarray, np.ndarray]:
        return self.points.min(axis=0), self.points.max(axis=0)

    def __repr__(self) -> str:
        return f"SizeCloud({len(self.points)} points, smallest size={self.size:g})"
