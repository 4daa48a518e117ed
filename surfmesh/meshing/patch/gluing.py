"""From the parameter plane to space: points on the surface, joined sides identified.

 ____B____                Sides A and A are one curve in space, nodes on them one point. An
|         |               edge on a side that is a single point vanishes, and with it its
A         A               triangle. What must come of it follows from Euler's number; where
|____B____|               sizes are too coarse an edge has more than two triangles.
"""

from dataclasses import dataclass

import numpy as np

from surfmesh._core.triangulation import DEAD, Triangulation
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.boundary.boundary_loops import BoundaryLoops
from surfmesh.meshing.boundary.boundary_recovery import DomainMesh
from surfmesh.result.connectivity import connect


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
    corners = live_triangles(domain.t)
    same = np.arange(len(uv), dtype=np.int64)
    joined = loops is not None and loops.joined > 0
    if joined:
        same[domain.node] = domain.same
    used = np.zeros(len(uv), bool)
    used[corners.ravel()] = True
    kept = used & (same == np.arange(len(uv)))
    number = np.cumsum(kept) - 1
    triangles = number[same[corners]].astype(np.int32)
    (points,) = surface.evaluate(uv[kept], 0)
    if loops is None or not joined:
        return SurfaceTriangles(
            points, triangles, corners, np.flatnonzero(kept), np.empty(0, np.int64)
        )
    a, b, c = triangles.T
    solid = (a != b) & (b != c) & (c != a)
    collapsed, change = _euler_of_identification(loops)
    lost = triangles[~solid]
    bad = np.unique(lost) if len(lost) != collapsed else np.empty(0, np.int64)
    triangles = triangles[solid]
    table = connect(triangles)
    bad = np.union1d(table.edges[table.uses > 2], bad)
    euler = len(points) - len(table.edges) + len(triangles)
    if not len(bad) and euler != _euler_of_domain(domain.t, corners, int(used.sum())) + change:
        bad = np.arange(len(points))
    return SurfaceTriangles(
        points, triangles, corners[solid], np.flatnonzero(kept), bad.astype(np.int64)
    )


def live_triangles(t: Triangulation) -> np.ndarray:
    """(m, 3)"""
    corners: np.ndarray = t.tri.reshape(-1, 3)[t.region != DEAD]
    return corners


def _euler_of_identification(loops: BoundaryLoops) -> tuple[int, int]:
    """How many segments collapse to points, and by how much Euler's number changes."""
    # an edge inside is walked there and back: two segments of the loops, one of the domain
    segments = np.unique(np.sort(loops.segments, axis=1), axis=0)
    start, end = loops.identity[segments].T
    collapsed = int((start == end).sum())
    pairs = np.sort(loops.identity[segments], axis=1)[start != end]
    identified = len(pairs) - len(np.unique(pairs, axis=0))
    return collapsed, collapsed + identified - loops.joined


def _euler_of_domain(t: Triangulation, corners: np.ndarray, vertices: int) -> int:
    """Vertices - edges + triangles: its border has as many edges as half-edges."""
    border = int((t.adj.reshape(-1, 3)[t.region != DEAD] < 0).sum())
    return vertices - (3 * len(corners) + border) // 2 + len(corners)
