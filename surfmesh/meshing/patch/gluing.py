"""From the parameter plane to space: points on the surface, joined sides glued."""

from dataclasses import dataclass

import numpy as np

from surfmesh.geometry.surface import Surface
from surfmesh.meshing.boundary.boundary_loops import BoundaryLoops
from surfmesh.meshing.boundary.boundary_recovery import DomainMesh
from surfmesh.result.connectivity import connect


@dataclass(frozen=True)
class Glued:
    """Points in space and triangles on them, with their corners in the parameter plane."""

    points: np.ndarray
    """(n, 3)"""
    triangles: np.ndarray
    """(m, 3) int32, rows of ``points``."""
    uv_points: np.ndarray
    """(k, 2)"""
    uv_triangles: np.ndarray
    """(m, 3) int32, rows of ``uv_points``."""
    place: np.ndarray
    """(n,) int64: row of ``uv_points`` that each point was computed from."""
    euler: int
    """The Euler characteristic that gluing must give."""
    pinched: np.ndarray
    """Points (j,) at which a triangle collapsed that should not have."""
    joined: int
    """How many boundary nodes have been glued to others."""


def glued(surface: Surface, loops: BoundaryLoops, domain: DomainMesh, uv: np.ndarray) -> Glued:
    """Glue a domain whose vertices lie at uv (k, 2).

    Triangles with two corners on one collapsed side are dropped: they are edges in space.
    """
    t = domain.t
    vertices = int(t.count[0])
    live = t.region[: t.count[1]] == 0
    corners = t.tri[: 3 * t.count[1]].reshape(-1, 3)[live]
    same = np.arange(vertices, dtype=np.int64)
    same[domain.node] = domain.node[loops.identity]
    used = np.zeros(vertices, bool)
    used[corners.ravel()] = True
    kept = used & (same == np.arange(vertices))
    number = np.cumsum(kept) - 1
    triangles = number[same[corners]].astype(np.int32)
    solid = np.ones(len(triangles), bool)
    pinched = np.empty(0, np.int64)
    joined = len(loops.identity) - len(np.unique(loops.identity))
    euler = vertices_minus_edges_plus_faces(t, corners, int(used.sum()))
    if joined:
        a, b, c = triangles.T
        solid = (a != b) & (b != c) & (c != a)
        # an edge inside is walked there and back: two segments of the loops, one of the domain
        segments = np.unique(np.sort(loops.segments, axis=1), axis=0)
        start, end = loops.identity[segments].T
        collapsed = int((start == end).sum())
        pairs = np.sort(loops.identity[segments], axis=1)[start != end]
        glued_edges = len(pairs) - len(np.unique(pairs, axis=0))
        euler += collapsed + glued_edges - joined
        lost = triangles[~solid]
        if len(lost) != collapsed:
            pinched = np.unique(lost)
    (points,) = surface.evaluate(uv[kept], 0)
    place = np.flatnonzero(kept)
    return Glued(points, triangles[solid], uv, corners[solid], place, euler, pinched, joined)


def vertices_minus_edges_plus_faces(t, corners: np.ndarray, vertices: int) -> int:
    """Euler characteristic of the domain: its border has as many edges as half-edges."""
    border = int((t.adj[: 3 * t.count[1]].reshape(-1, 3)[t.region[: t.count[1]] == 0] < 0).sum())
    return vertices - (3 * len(corners) + border) // 2 + len(corners)


def misglued(glued: Glued) -> np.ndarray:
    """Points (k,) where gluing has not made a surface: the sizes there are too coarse.

    Empty when every edge has at most two triangles and Euler's number is as it must be.
    """
    if glued.joined == 0:
        return np.empty(0, np.int64)
    table = connect(glued.triangles)
    crowded = table.edges[table.uses > 2]
    euler = len(glued.points) - len(table.edges) + len(glued.triangles)
    bad = np.union1d(crowded, glued.pinched)
    if not len(bad) and euler != glued.euler:
        bad = np.arange(len(glued.points))
    return bad.astype(np.int64)
