"""Upper bounds of the size near points: where a round of meshing has found it too large."""

from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from surfmesh._core import elementary_functions
from surfmesh.sizing.metric_roots import outer, uniform

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

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
    metric_root_3d: np.ndarray | None = None
    """(k, 6) W = xx, xy, xz, yy, yz, zz: in the unit direction e the size is at most 1 / |W e|,
    at least ``sizes``; None: ``sizes`` in every direction."""
    as_cut: bool = False
    """The sizes are those of edges, which neighbours with a smaller ``min_size`` may have cut."""

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """Largest size (n,) at points (n, 3)."""
        distance, index = self._nearest(points)
        return (self.sizes[index] + self.slope * distance).min(axis=1)

    def along(self, points: np.ndarray, directions: np.ndarray) -> np.ndarray:
        """Largest sizes (k, n) at points (n, 3) in k unit directions (k, n, 3)."""
        distance, index = self._nearest(points)
        grown = self.slope * distance
        found = np.empty((len(directions), len(points)))
        if self.metric_root_3d is None:
            found[:] = (self.sizes[index] + grown).min(axis=1)
            return found
        for size, (x, y, z) in zip(found, directions.transpose(0, 2, 1)[..., None]):
            xx, xy, xz, yy, yz, zz = self.metric_root_3d.T
            square = (xx[index] * x + xy[index] * y + xz[index] * z) ** 2
            square += (xy[index] * x + yy[index] * y + yz[index] * z) ** 2
            square += (xz[index] * x + yz[index] * y + zz[index] * z) ** 2
            inverse = np.maximum(np.sqrt(square), np.finfo(float).tiny)
            size[:] = (1.0 / inverse + grown).min(axis=1)
        return found

    def tightest(self, points: np.ndarray, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The smallest size (n,) that is allowed in any direction of the tangent planes at points
        (n, 3) with unit normals (n, 3), and a unit direction (n, 3) it holds in."""
        distance, index = self._nearest(points)
        first = _across(normals)
        second = np.cross(normals, first)
        if self.metric_root_3d is None:
            return (self.sizes[index] + self.slope * distance).min(axis=1), first
        xx, xy, xz, yy, yz, zz = self.metric_root_3d[index].transpose(2, 0, 1)

        def form(e: np.ndarray, f: np.ndarray) -> np.ndarray:
            (x, y, z), (u, v, w) = e.T[..., None], f.T[..., None]
            found = xx * x * u + yy * y * v + zz * z * w
            found += xy * (x * v + y * u) + xz * (x * w + z * u) + yz * (y * w + z * v)
            return found

        a, b, c = form(first, first), form(first, second), form(second, second)
        mean, half = 0.5 * (a + c), 0.5 * (a - c)
        largest = mean + elementary_functions.hypot(half, b)
        size = 1.0 / np.maximum(largest, np.finfo(float).tiny) + self.slope * distance
        best = size.argmin(axis=1)[:, None]
        b, half = (np.take_along_axis(x, best, 1) for x in (b, half))
        angle = 0.5 * elementary_functions.atan2(b, half)
        sine, cosine = elementary_functions.sincos(angle)
        direction = cosine * first + sine * second
        return np.take_along_axis(size, best, 1)[:, 0], direction

    def chosen(self, rows: np.ndarray) -> "SizeLimits":
        """The limits hold near their own points, whoever asks."""
        return self

    def _nearest(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Distances (n, k) and numbers (n, k) of the limits nearest to points (n, 3)."""
        count = min(NEAREST, len(self.sizes))
        return self._tree.query(points, k=[*range(1, count + 1)])

    @cached_property
    def _tree(self) -> "cKDTree":
        from scipy.spatial import cKDTree

        return cKDTree(self.points)

    def __getstate__(self) -> dict:
        return {field.name: getattr(self, field.name) for field in fields(self)}

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
            self._tensors_with(other),
            self.as_cut or other.as_cut,
        )

    def not_below(self, least: float) -> "SizeLimits":
        """The same with no size smaller than ``least``; ratios of tensors are kept."""
        sizes = np.maximum(self.sizes, least)
        tensors = self.metric_root_3d
        if tensors is not None:
            tensors = tensors * (self.sizes / sizes)[:, None]
        return replace(self, sizes=sizes, metric_root_3d=tensors)

    def _tensors_with(self, other: "SizeLimits") -> np.ndarray | None:
        if self.metric_root_3d is None and other.metric_root_3d is None:
            return None
        parts = [
            uniform(1.0 / limits.sizes) if limits.metric_root_3d is None else limits.metric_root_3d
            for limits in (self, other)
        ]
        return np.concatenate(parts)


def along_lines(directions: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """Tensors (k, 6) of sizes (k,) that hold along unit directions (k, 3) only: e e^T / size."""
    return outer(directions, directions) / sizes[:, None]


def _across(normals: np.ndarray) -> np.ndarray:
    """Unit vectors (n, 3) at right angles to unit normals (n, 3)."""
    axis = np.eye(3)[np.abs(normals).argmin(axis=1)]
    found = np.cross(normals, axis)
    return found / np.linalg.norm(found, axis=1)[:, None]
