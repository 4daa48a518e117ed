"""A triangulated domain with its surface frames, and the local operators on it.

An operator changes only what is active, and marks what it has changed as active and dirty.
After each of them the vertices that moved are put back on the true surface.
"""

from collections.abc import Callable

import numpy as np

from surfmesh.geometry.boxes import diagonal
from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.surface import Surface
from surfmesh.kernels.optimisation.optimisation import (
    collapse_short,
    find_stars,
    smooth,
    split_far,
    split_long,
    swap_for_degree,
    swap_for_shape,
    triangles_at,
)
from surfmesh.kernels.optimisation.surface_frames import SurfaceFrames, empty_frames, set_frames
from surfmesh.kernels.triangulation.local_operations import DEAD
from surfmesh.meshing.boundary.boundary_recovery import DomainMesh
from surfmesh.sizing.field.size_field import SizeField

STIFFNESS = 2.0
"""Weight of unit edges against good shapes: 1 gives better shapes, 4 better lengths."""

SHORTEST, LONGEST = 0.66, 1.45
"""Metric lengths beyond which an edge is collapsed or split."""

FEW = 4
"""An interior vertex with at most this many triangles is removed."""

LEAST_FOR_DEGREE = 0.4
"""Worst alpha that a swap for the sake of degrees may leave to the smoothing that follows."""

GOOD_SHAPE = 0.82
"""Triangles above this alpha keep their edges."""

SWEEPS = 8
"""Of swaps over all edges, at most."""

BLOCK = 1 << 15
"""Vertices put on the surface together: the temporaries stay within the cache."""

BESIDE_KINK, _AROUND = 1e-6, ((1, 0.4), (-1, -0.4), (0.4, -1), (-0.4, 1))
"""Of the domain: how far from a kink its two sides are looked at, and in which directions."""


class PatchState:
    """One patch while it is optimised: ``t`` and ``frames`` change in place."""

    def __init__(
        self,
        domain: DomainMesh,
        surface: Surface,
        chart: Chart,
        field: SizeField,
        before_pass: Callable[[], None] | None = None,
    ) -> None:
        """before_pass: called before each pass of smoothing; may raise to stop the work."""
        self.domain, self.t = domain, domain.t
        self.node, self.same = domain.node[domain.is_used], domain.same[domain.is_used]
        self.surface, self.chart, self.field = surface, chart, field
        self.before_pass = before_pass
        self.on_kinks = domain.on_kinks
        room = len(self.t.xy)
        self.is_anisotropic = field.is_anisotropic
        self.frames: SurfaceFrames = empty_frames(room, self.is_anisotropic)
        self.star = np.empty(room, np.int32)
        self.frozen = np.empty(room, np.uint8)
        self.degree = np.empty(room, np.int32)
        self.active = np.ones(room, np.uint8)
        self.dirty = np.ones(room, np.uint8)
        self.stars_known = False
        self.moved = np.empty(room, np.int32)
        self.shape = np.ones(len(self.t.tri) // 3)
        self.swaps = self.collapses = self.splits = self.passes = 0
        self.set_frames(np.arange(self.vertices, dtype=np.int32))
        self._place_nodes()

    @property
    def vertices(self) -> int:
        return int(self.t.count[0])

    @property
    def triangles(self) -> int:
        """How many there are, dead ones included."""
        return int(self.t.count[1])

    @property
    def is_live(self) -> np.ndarray:
        """(triangles,)"""
        live: np.ndarray = self.t.region[: self.triangles] != DEAD
        return live

    def diagonal(self) -> float:
        """Of the box of all vertices, model units."""
        return diagonal(self.frames.point[: self.vertices])

    def identified(self) -> np.ndarray:
        """For each vertex the one that it coincides with in space, or itself."""
        number = np.arange(self.vertices)
        number[self.node] = self.same
        return number

    def corners(self, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(n, 3, 3) in space and (n, 3, 2) in the scaled plane, of triangles (n,)."""
        corners = self.t.tri.reshape(-1, 3)[triangles]
        return self.frames.point[corners], self.t.xy[corners]

    def parameters(self, vertices: np.ndarray) -> np.ndarray:
        """(..., 2) of vertices (...)."""
        uv = self.chart.to_uv(self.t.xy[vertices.ravel()])
        return uv.reshape(*vertices.shape, 2)

    def set_frames(self, vertices: np.ndarray, on_kink: bool = False) -> None:
        """Put vertices (n,) back on the surface, with their exact metric."""
        background = self.field.arrays
        largest = 1e3 * float(background.box[4]) / float(self.chart.extent.max())
        for start in range(0, len(vertices), BLOCK):
            some = vertices[start : start + BLOCK]
            uv, rates = self.chart.to_uv_and_rates(self.t.xy[some])
            r, ru, rv = self.surface.evaluate(uv, 1)
            if on_kink:
                ru, rv = self._mean_slopes(uv)
            ru *= rates[:, :1]
            rv *= rates[:, 1:]
            set_frames(self.t, self.frames, background, some, r, ru, rv, largest)

    def set_frames_on_kinks(self) -> None:
        """Give vertices on kinks the mean of the frames around them.

        With the normal of one side, triangles of the other would seem to be turned over.
        """
        if len(self.on_kinks):
            self.set_frames(self.on_kinks, on_kink=True)
            self._place_nodes()

    def _place_nodes(self) -> None:
        """Boundary nodes lie where edges have them, or on each other to the last bit."""
        domain, used = self.domain, self.domain.is_used
        if domain.points is None:
            self.frames.point[self.node] = self.frames.point[self.same]
        else:
            self.frames.point[self.node] = domain.points[used]

    def _mean_slopes(self, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """r_u and r_v (n, 3) on kinks at uv (n, 2): the mean of what they are around."""
        low, high = np.array(self.surface.domain).T
        step = BESIDE_KINK * (high - low)
        around = [np.clip(uv + step * np.array(way), low, high) for way in _AROUND]
        slopes = np.array([self.surface.evaluate(place, 1)[1:] for place in around])
        mean: np.ndarray = sum(slopes[1:], slopes[0]) / len(slopes)
        return mean[0], mean[1]

    def find_stars(self) -> None:
        """Bring ``star``, ``frozen`` and ``degree`` up to date."""
        if not self.stars_known:
            find_stars(self.t, self.star, self.frozen, self.degree)
            self.frozen[self.node] = 1
            self.stars_known = True

    def smooth(self, stiffness: float = STIFFNESS) -> int:
        """Move every active vertex by one Newton step; returns how many have moved."""
        if self.before_pass is not None:
            self.before_pass()
        self.find_stars()
        moved = smooth(
            self.t, self.frames, self.field.arrays,
            self.star, self.frozen, self.active, self.dirty, stiffness, self.moved,
        )  # fmt: skip
        self.set_frames(self.moved[:moved])
        self.passes += 1
        return int(moved)

    def swap(self, good: float = GOOD_SHAPE) -> None:
        """Swap edges of triangles below the alpha ``good`` while that raises the smaller one."""
        swaps = swap_for_shape(
            self.t, self.frames, self.shape, self.dirty, self.active, good, SWEEPS
        )
        self.stars_known = self.stars_known and swaps == 0
        self.swaps += swaps

    def swap_for_degree(self) -> None:
        """Swap edges that bring the degrees of their four vertices nearer to six."""
        self.find_stars()
        swaps = swap_for_degree(
            self.t, self.frames, self.frozen, self.degree, self.dirty, self.active,
            LEAST_FOR_DEGREE,
        )  # fmt: skip
        self.stars_known = self.stars_known and swaps == 0
        self.swaps += swaps

    def collapse(self) -> None:
        """Remove interior vertices with a short edge, or with few triangles."""
        self.find_stars()
        collapses = collapse_short(
            self.t, self.frames, self.star, self.frozen, self.degree, self.dirty,
            self.active, SHORTEST, FEW,
        )  # fmt: skip
        self.stars_known = self.stars_known and collapses == 0
        self.collapses += collapses

    def split(self, longest: float = LONGEST) -> None:
        """Split interior edges of active vertices longer than ``longest``."""
        self._set_new(split_long(self.t, self.frames, longest, self.dirty, self.active))

    def split_farthest(self, triangles: np.ndarray) -> int:
        """Split the edge of each of the triangles (n,) that lies farthest from the surface.

        All other vertices stay where they are. Returns how many were split.
        """
        return self._set_new(split_far(self.t, self.frames, triangles, self.dirty, self.active))

    def _set_new(self, first: int) -> int:
        """Set the frames of vertices from number ``first`` on; returns how many there are."""
        new = np.arange(first, self.vertices, dtype=np.int32)
        if len(new):
            self.set_frames(new)
            self.stars_known = False
            self.splits += len(new)
        return len(new)

    def changed_since(self, before: np.ndarray, changed: np.ndarray) -> np.ndarray:
        """Triangles with a vertex in ``changed``, or whose corners are not as ``before``.

        before: (3 n,) the corners then; changed: (room,) marks of vertices, more are set.
        """
        now = self.t.tri[: 3 * self.triangles]
        changed[now[: len(before)][now[: len(before)] != before]] = 1
        changed[now[len(before) :]] = 1
        seen = np.empty(self.triangles, np.uint8)
        triangles_at(self.t, changed, seen)
        return np.flatnonzero(seen)
