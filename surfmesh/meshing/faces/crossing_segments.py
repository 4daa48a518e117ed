"""Smaller sizes where the polygon of a face's boundary crosses itself and its curves do not.

Every segment that meets another one is named, so that one round mends all of them and leaves
the rest of the boundary as it is.
"""

from __future__ import annotations

import numpy as np

from surfmesh._core.insertion import coincident_nodes
from surfmesh._core.space import PointTree
from surfmesh.geometry.inside_loops import nesting_depth
from surfmesh.geometry.small_matrices import product
from surfmesh.meshing.boundary.untangling import meeting_pairs
from surfmesh.meshing.faces.face_data import FaceJob
from surfmesh.sizing.rules.size_limits import SizeLimits

FINER = 0.5
"""Factor on the lengths of the segments."""


def limits_where_crossing(job: FaceJob, where: np.ndarray) -> SizeLimits | None:
    """Half the lengths of the segments that meet others, at their ends and middles.

    Where none do and yet nothing is enclosed, of the loops that lie on the wrong side of others;
    or else of the segments nearest to where (k, 2) the boundary could not be inserted. None when
    ``min_size`` forbids that.
    """
    uv, numbers, points, segments, loop = job.polygons
    nodes, row = coincident_nodes(uv, numbers, segments)
    ends = row[segments]
    real = np.flatnonzero(ends[:, 0] != ends[:, 1])
    pairs, _ = meeting_pairs(uv[nodes], ends[real])
    bad = real[np.unique(pairs)]
    if not len(bad):
        bad = np.flatnonzero(np.isin(loop, _misplaced(uv, segments, loop)))
    if not len(bad):
        _, near = PointTree(points).nearest(job.surface.evaluate(where, 0)[0], 1)
        bad = np.flatnonzero(np.isin(segments, near).any(axis=1))
    start, end = points[segments[bad]].transpose(1, 0, 2)
    length = np.linalg.norm(end - start, axis=1)
    bad, start, end, length = (x[length > 0.0] for x in (bad, start, end, length))
    (middle,) = job.surface.evaluate(uv[segments[bad]].mean(axis=1), 0)
    sizes = np.tile(FINER * length, 3)
    least = job.sizing.min_size or 0.0
    if not (sizes > least).any():
        return None
    return SizeLimits(np.concatenate([start, middle, end]), sizes, job.sizing.gradient)


def _misplaced(uv: np.ndarray, segments: np.ndarray, loop: np.ndarray) -> list[int]:
    """Loops that run the wrong way for the number of others around their polygon."""
    rings = [uv[segments[loop == k, 0]] for k in range(int(loop.max()) + 1)]
    real = [k for k, ring in enumerate(rings) if len(ring) > 2]
    if not real:
        return []
    depth = nesting_depth([rings[k] for k in real])
    found = []
    for number, deep in zip(real, depth.tolist()):
        x, y = (rings[number] - rings[number].mean(axis=0)).T
        area = float(product(x, np.roll(y, -1)) - product(y, np.roll(x, -1)))
        if (area > 0.0) != (deep % 2 == 0):
            found.append(number)
    return found
