"""Free edges within a surface: a triangle is missing beside them.

    rim of the surface    o----o----o----o----o      where a triangle is missing at a rim, free
                           ` .` ` . =   = . ` `      edges (=) lie that are no pieces of it: of no
    mesh                    o----o----o----o---      edge of the CAD model, of no side of the (u, v)
                                                     rectangle, of no trimming loop

Neither distances nor the Euler number tell of it: what is left lies on the surface, and has its
topology.
"""

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.planar.planar_domain import PlaneOfCoordinates
from surfmesh.geometry.planar.segment_distance import SegmentDistance
from surfmesh.geometry.surface import Surface
from surfmesh.quality.measures.against_model import Unexpected
from surfmesh.quality.measures.known_surfaces import KnownSurfaces

ON_SIDE = 1e-9
"""Of the (u, v) domain: nodes of rims have the parameters of these, to rounding."""


def torn_edges(known: KnownSurfaces, odd: Unexpected) -> NDArray[np.intp]:
    """Rows of ``mesh.edges``. None are known where nothing says that the mesh is all of its
    surfaces, of CAD models whose edges are not known, as in files, and of planar domains, whose
    regions know no lines.

    odd: says whether the edges of the model are known.
    """
    mesh = known.mesh
    free = np.flatnonzero(mesh.connectivity.uses == 1)
    if not len(free):
        return free
    if odd.known:
        row = mesh.edge_segment_rows
        of_model = np.zeros(len(mesh.edges), bool)
        of_model[row[row >= 0]] = True
        return free[~of_model[free]]
    if mesh.facts is None or mesh.facts.faces:
        return free[:0]
    half_edge = mesh.connectivity.half_edges[free, 0]
    triangle, side = np.divmod(half_edge.astype(np.int64), 3)
    corners = known.corners.uv_triangles[triangle]
    row = np.arange(len(free))
    ends = np.stack([corners[row, side], corners[row, (side + 1) % 3]], axis=1)
    uv, face = known.corners.uv_points[ends], mesh.face_ids[triangle]
    torn = np.zeros(len(free), bool)
    for number in np.unique(face).tolist():
        own = face == number
        torn[own] = ~_on_rim(mesh.surfaces[number], uv[own])
    return free[torn]


def _on_rim(surface: Surface, uv: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(k,) do segments uv (k, 2, 2) lie on the rim of the surface in (u, v)?"""
    if isinstance(surface, PlaneOfCoordinates):
        return np.ones(len(uv), np.bool_)
    low, high = np.array(surface.domain, float).T
    uv = (uv - low) / (high - low)
    if not len(surface.loops):
        sides = np.concatenate([abs(uv), abs(uv - 1.0)], axis=2) <= ON_SIDE
        return np.any(np.all(sides, axis=1), axis=1).astype(np.bool_)
    starts = [(np.asarray(loop, float) - low) / (high - low) for loop in surface.loops]
    ends = [np.roll(loop, -1, axis=0) for loop in starts]
    distance = SegmentDistance(_flat(np.concatenate(starts)), _flat(np.concatenate(ends)))
    places = np.concatenate([uv, uv.mean(axis=1, keepdims=True)], axis=1)
    away = distance(_flat(places.reshape(-1, 2)))
    return np.all(away.reshape(-1, 3) <= ON_SIDE, axis=1).astype(np.bool_)


def _flat(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 2) as points (n, 3) of the plane z = 0."""
    return np.column_stack([points, np.zeros(len(points))])
