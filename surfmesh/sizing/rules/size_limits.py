"""Upper bounds of the size near points: where a round of meshing has found it too large."""

from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np

from surfmesh._core import sizing as core_sizing
from surfmesh.sizing.metric_roots import outer, uniform


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

    @cached_property
    def core(self) -> core_sizing.SizeLimits:
        """The same as the core has them: a few of the nearest points decide at a place."""
        points, sizes = (np.ascontiguousarray(x, float) for x in (self.points, self.sizes))
        tensors = self.metric_root_3d
        if tensors is not None:
            tensors = np.ascontiguousarray(tensors, float)
        return core_sizing.SizeLimits(points, sizes, self.slope, tensors)

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """Largest size (n,) at points (n, 3)."""
        return self.core.at(np.ascontiguousarray(points))

    def along(self, points: np.ndarray, directions: np.ndarray) -> np.ndarray:
        """Largest sizes (k, n) at points (n, 3) in k unit directions (k, n, 3)."""
        return self.core.along(np.ascontiguousarray(points), np.ascontiguousarray(directions))

    def tightest(self, points: np.ndarray, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The smallest size (n,) that is allowed in any direction of the tangent planes at points
        (n, 3) with unit normals (n, 3), and a unit direction (n, 3) it holds in."""
        return self.core.tightest(np.ascontiguousarray(points), np.ascontiguousarray(normals))

    def chosen(self, rows: np.ndarray) -> "SizeLimits":
        """The limits hold near their own points, whoever asks."""
        return self

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
