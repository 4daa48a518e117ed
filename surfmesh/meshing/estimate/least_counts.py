"""The fewest triangles that a chord allows, before a mesh is made: see
``quality/measures/least_triangles.py`` for what is counted.

    cells of the size field -> curvature in their middles -> the least on their area  -+-> the
    free sides and loops    -> curvature along them       -> segments, triangles      -+   larger
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from surfmesh._core.edges import curvatures_at
from surfmesh._core.quality import surface_points
from surfmesh._core.sizing import least_densities, least_segments
from surfmesh.cad.model.cad_model import CadModel
from surfmesh.cad.model.centres import cell_centres
from surfmesh.cad.model.model_arrays import model_arrays, offsets
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.differential.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.geometry.differential.sides import SideTopology
from surfmesh.geometry.inside_loops import is_inside
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.edges.edge_nodes import CutEdges
from surfmesh.meshing.faces.face_data import FaceJob
from surfmesh.sizing.field.metric_area import inner_cells
from surfmesh.sizing.field.size_field import SizeField

CELLS = 4096
"""Cells of a size field are cut until there are so many; where there are four times as many, four
of them are looked at together."""

FEW = 12
"""Points each way of a grid on a CAD face."""

ALONG = 257
"""Points along a side."""

LARGEST_TURN = np.pi / 3.0
"""Where a loop turns farther it has a corner."""

FLAT = {"plane", "cylinder", "cone", "extrusion"}
"""Kinds of CAD surfaces without Gaussian curvature: rims decide."""


def least_of_surface(
    surface: Surface, field: SizeField, sides: SideTopology, chord: float, balanced: bool
) -> float:
    """Triangles of a surface of formulas or a function."""
    loops = [np.asarray(loop, float) for loop in surface.loops]
    by_area = _over_cells(surface, field, loops, chord, balanced)
    lines = 0.0
    for side in range(0 if loops else 4):
        if sides.partner[side] >= 0:
            lines += 1.0  # cut open along it: two sides of one segment each may do
        elif not sides.collapsed[side]:
            uv = sides.points(side, np.linspace(0.0, 1.0, ALONG))
            lines += _segments(surface.evaluate(uv, 0)[0], chord, balanced)
    for loop in loops:
        (points,) = surface.evaluate(loop, 0)
        lines += sum(_segments(line, chord, balanced) for line in _between_corners(points))
    return max(by_area, lines - 2.0 * (2 - max(len(loops), 1)))


def _over_cells(
    surface: Surface, field: SizeField, loops: Sequence[np.ndarray], chord: float, balanced: bool
) -> float:
    low, step, _ = inner_cells(field, None)
    if len(low) > 4 * CELLS:
        low, step = _in_fours(low, step)
    parts = max(int(np.ceil(np.sqrt(CELLS / max(len(low), 1)))), 1)
    step = np.repeat(step / parts, parts**2, axis=0)
    middle = np.repeat(low, parts**2, axis=0) + np.tile(
        cell_centres(parts) * parts, (len(low), 1)
    ) * step  # fmt: skip
    if loops:
        inside = is_inside([field.chart.to_plane(loop) for loop in loops], middle)
        middle, step = middle[inside], step[inside]
    uv, rates = field.chart.to_uv_and_rates(middle)
    _, ru, rv, *second = surface.evaluate(uv, 2)
    area = np.linalg.norm(np.cross(ru, rv), axis=1) * (step * np.abs(rates)).prod(axis=1)
    k = curvatures(forms_from_derivatives(ru, rv, *second))
    density = least_densities(k.k1, k.k2, chord, balanced)[0]
    return float((density * area)[np.isfinite(area)].sum())


def _in_fours(low: np.ndarray, step: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Corners and sides of the cells that the leaves are the quarters of: as a background is made
    its leaves come in fours, one after the other."""
    corners = np.minimum.reduce([low[k::4] for k in range(4)])
    return corners, np.maximum.reduce([(low + step)[k::4] for k in range(4)]) - corners


def least_of_model(
    model: CadModel, nodes: CutEdges, jobs: Sequence[FaceJob], chords: np.ndarray, balanced: bool
) -> float:
    """Triangles of a CAD model. chords: (f,) of the faces, infinite for none."""
    arrays = model_arrays(model)
    allowed = np.full(len(nodes), np.inf)
    np.minimum.at(allowed, arrays.coedge_edge, chords[arrays.coedge_face])
    segments = np.zeros(len(nodes))
    for number, cut in enumerate(nodes):
        if cut is not None:
            segments[number] = _segments(cut.points, float(allowed[number]), balanced)
    pairs = np.stack([arrays.coedge_face, arrays.coedge_edge], axis=1)
    _, which, uses = np.unique(pairs, axis=0, return_inverse=True, return_counts=True)
    around = segments[arrays.coedge_edge]
    seam = uses[which.ravel()] > 1
    around[seam] = np.minimum(around[seam], 1.0)
    lines = np.bincount(arrays.coedge_face, weights=around, minlength=len(model.faces))
    loops = np.array([len(face.loops) for face in model.faces])
    by_area = _over_faces(jobs, arrays.area, chords, balanced)
    return float(np.maximum(by_area, lines - 2.0 * (2 - np.maximum(loops, 1))).sum())


def _over_faces(
    jobs: Sequence[FaceJob], area: np.ndarray, chords: np.ndarray, balanced: bool
) -> np.ndarray:
    """Triangles (f,) that the areas of faces need, by the curvature at points of a grid."""
    found = np.zeros(len(jobs))
    uv, faces = [], []
    for number, job in enumerate(jobs):
        if job.surface.kind in FLAT or not np.isfinite(chords[number]):
            continue
        low, high = np.array(job.surface.domain).T
        grid = low + cell_centres(FEW) * (high - low)
        inside = grid[is_inside(job.rings, grid)] if len(job.rings) else grid
        uv.append(inside if len(inside) else grid)
        faces.append(number)
    if not faces:
        return found
    first = offsets(np.array([len(rows) for rows in uv]))
    cores = [as_core_surface(jobs[face].surface) for face in faces]
    places, which = np.concatenate(uv), np.repeat(np.arange(len(faces)), np.diff(first))
    k1, k2, _ = curvatures_at(places, first, cores)
    _, ru, rv = surface_points(cores, which.astype(np.int32), places, 1)
    weight = np.linalg.norm(np.cross(ru, rv), axis=1)
    density = least_densities(k1, k2, 1.0, balanced)[0]
    sums = np.bincount(which, weights=weight * density)
    whole = np.maximum(np.bincount(which, weights=weight), np.finfo(float).tiny)
    found[faces] = sums / whole * area[faces] / chords[faces]
    return found


def _segments(points: np.ndarray, chord: float, balanced: bool) -> float:
    """Of a line (n, 3); one whose ends are one point is closed."""
    closed = len(points) > 2 and bool((np.abs(points[0] - points[-1]) <= _same(points)).all())
    line = points[:-1] if closed else points
    return least_segments(np.ascontiguousarray(line), closed, chord, balanced)


def _same(points: np.ndarray) -> float:
    return 1e-9 * float(np.abs(points).max())


def _between_corners(points: np.ndarray) -> list[np.ndarray]:
    """A closed polygon (n, 3) in lines from corner to corner, ends included."""
    step = np.roll(points, -1, axis=0) - points
    before = np.roll(step, 1, axis=0)
    lengths = np.linalg.norm(step, axis=1) * np.linalg.norm(before, axis=1)
    corner = np.flatnonzero((step * before).sum(axis=1) < np.cos(LARGEST_TURN) * lengths)
    if not len(corner):
        return [np.concatenate([points, points[:1]])]
    turned = np.roll(points, -corner[0], axis=0)
    ends = [*(corner - corner[0]).tolist(), len(points)]
    closed = np.concatenate([turned, turned[:1]])
    return [closed[a : b + 1] for a, b in pairwise(ends)]
