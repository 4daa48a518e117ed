"""From the parameter plane to space: points on the surface, joined sides identified.

 ____B____                Sides A and A are one curve in space, nodes on them one point. An
|         |               edge on a side that is a single point vanishes, and with it its
A         A               triangle. What must come of it follows from Euler's number; where
|____B____|               sizes are too coarse an edge has more than two triangles.
"""

from dataclasses import dataclass

import numpy as np

from surfmesh._core import patch as core
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.boundary.boundary_loops import BoundaryLoops
from surfmesh.meshing.boundary.boundary_recovery import DomainMesh


@dataclass(frozen=True)
class SurfaceTriangles:
    """Points in space and triangles on them, with their corners in the parameter plane."""

    points: np.ndarray
    """(n, 3)"""
    triangles: np.ndarray
    """(m, 3) int32, rows of ``points``."""
    uv_triangles: np.ndarray
    """(m, 3) int32, vertices of the domain."""
    vertex: np.ndarray
    """(n,) int64: vertex of the domain that each point was computed from."""
    non_manifold: np.ndarray
    """(k,) int64: points where identification has not made a surface, sizes are too coarse."""


def identify_seams(
    surface: Surface, domain: DomainMesh, uv: np.ndarray, loops: BoundaryLoops | None
) -> SurfaceTriangles:
    """The triangles in space of a domain whose vertices lie at uv (k, 2).

    Triangles with two corners on one collapsed side are dropped: they are edges in space.
    loops: None where no nodes coincide.
    """
    node, segments, identity = _NO_NODES, _NO_SEGMENTS, _NO_IDENTITY
    if loops is not None:
        node, segments, identity = domain.node, loops.segments, loops.identity
    t = domain.t
    corners, uv_corners, vertex, non_manifold = core.identify_seams(
        t.tri, t.adj, t.region, len(uv),
        node, segments, identity,
    )  # fmt: skip
    (points,) = surface.evaluate(uv[vertex], 0)
    return SurfaceTriangles(
        points, corners.reshape(-1, 3), uv_corners.reshape(-1, 3), vertex, non_manifold
    )


_NO_NODES = np.empty(0, np.int32)
_NO_SEGMENTS = np.empty((0, 2), np.int32)
_NO_IDENTITY = np.empty(0, np.int64)
