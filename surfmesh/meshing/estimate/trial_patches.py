"""Small patches of a face, meshed for real: what becomes of the triangles a size field asks for.

The optimiser splits triangles that are too far from the surface or meet at too large angles, and
collapses short edges. How many it does of each depends on the surface; a few patches tell.

    +-----------------------+
    |    [ ]          [ ]   |     patches of equal metric area, spread evenly
    |          [ ]          |     over the metric area of the face
    |   [ ]          [ ]    |
    +-----------------------+
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from surfmesh.errors import SurfmeshError
from surfmesh.geometry.inside_loops import is_inside
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.boundary.boundary_loops import BoundaryLoops, cut_line
from surfmesh.meshing.patch.patch_mesh import mesh_patch
from surfmesh.sizing.field.metric_area import TRIANGLES, box_area, inner_cells
from surfmesh.sizing.field.size_field import SizeField

SMALL_PATCH = 300
"""Triangles of a patch, about, where a larger one does not fit in or would cost too much."""

LARGEST_FRACTION = 0.03
"""Of the triangles that a surface of formulas is asked for, so many are made on trial; more where
sizes depend on the direction, of which the area tells less."""


class PatchPlan(NamedTuple):
    """How many patches are made of one face."""

    patches: int
    triangles: int
    """Of each, about."""

    @property
    def cost(self) -> int:
        """In triangles."""
        return self.patches * self.triangles


WIDE = PatchPlan(4, 1000)
PLANS = (WIDE, PatchPlan(4, 500), PatchPlan(4, SMALL_PATCH), PatchPlan(2, SMALL_PATCH))
"""From the best on."""


def plan_within(triangles: float) -> PatchPlan | None:
    """The best plan that makes no more triangles; None: there is none."""
    return next((plan for plan in PLANS if plan.cost <= triangles), None)


SMALLEST = 200
"""A patch that the sides of the face cut down to fewer tells nothing."""


def triangles_per_unit(
    surface: Surface, field: SizeField, loops: Sequence[np.ndarray] | None, plan: PatchPlan = WIDE
) -> float | None:
    """Triangles got for each that the field asks for; None where no patch fits in the loops.

    loops: (k, 2) in (u, v).
    """
    total = got = 0.0
    rings = None if loops is None else [field.chart.to_plane(loop) for loop in loops]
    for centre in _centres(field, rings, plan.patches):
        box = _patch(field, centre, plan.triangles)
        if rings is not None and not _is_within(rings, box):
            box = _patch(field, centre, SMALL_PATCH)
            if not _is_within(rings, box):
                continue
        asked = TRIANGLES * box_area(field, box)
        if asked < SMALLEST:
            continue
        made = _meshed(surface, field, box)
        if made is not None:
            total, got = total + asked, got + made
    return got / total if total > 0.0 else None


def _centres(field: SizeField, rings: list[np.ndarray] | None, count: int) -> np.ndarray:
    """(count, 2) in the scaled plane, spread evenly over the metric area inside the rings."""
    low, step, area = inner_cells(field, rings)
    if not len(low):
        return np.empty((0, 2))
    middle = low + 0.5 * step
    # strips, and in each of them along: neighbours in this order are neighbours in the plane
    strip = np.floor(middle[:, 0] / field.chart.extent[0] * np.sqrt(count)).astype(int)
    order = np.lexsort((middle[:, 1], strip))
    sums = np.cumsum(area[order])
    at = (np.arange(count) + 0.5) / count * sums[-1]
    return middle[order[np.minimum(np.searchsorted(sums, at), len(order) - 1)]]


def _patch(field: SizeField, centre: np.ndarray, triangles: float) -> np.ndarray:
    """A box (x0, y0, x1, y1) of about so many triangles around a point, inside the rectangle."""
    extent = field.chart.extent
    h = field.tensors(centre[None])[0]
    sizes = np.maximum(h[[0, 2]], np.finfo(float).tiny)
    side = np.sqrt(triangles / TRIANGLES * (h[0] * h[2] - h[1] ** 2) / sizes.prod())
    step = np.minimum(side * sizes, extent)
    for k in (0, 1):  # what one way is cut off is added the other way
        step[k] = min(step[k] * side * sizes[1 - k] / step[1 - k], extent[k])
    low = np.clip(centre - 0.5 * step, 0.0, extent - step)
    return np.concatenate([low, low + step])


def _is_within(rings: list[np.ndarray], box: np.ndarray) -> bool:
    low, high = box[:2], box[2:]
    nodes = np.concatenate(rings)
    if ((nodes > low) & (nodes < high)).all(axis=1).any():
        return False
    t = np.linspace(0.0, 1.0, 9)
    grid = low + np.stack(np.meshgrid(t, t), axis=-1).reshape(-1, 2) * (high - low)
    return bool(is_inside(rings, grid).all())


def _meshed(surface: Surface, field: SizeField, box: np.ndarray) -> int | None:
    """Triangles that all stages make of a box of the scaled plane; None where one fails."""
    corners = field.chart.to_uv(box[[[0, 1], [2, 1], [2, 3], [0, 3]]])
    lines = [
        cut_line(field, start, end, 1)[1][:-1]
        for start, end in zip(corners, np.roll(corners, -1, axis=0))
    ]
    uv = np.concatenate(lines)
    ring = np.arange(len(uv), dtype=np.int32)
    loops = BoundaryLoops(uv, np.stack([ring, np.roll(ring, -1)], axis=1), ring.astype(np.int64))
    try:
        patch = mesh_patch(surface, field.chart, field, loops, box=box)
    except SurfmeshError:
        return None
    return len(patch.space.triangles)
