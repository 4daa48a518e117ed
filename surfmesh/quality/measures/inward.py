"""Closed surfaces whose triangles face their inside: their volume is negative.

A void within another closed surface faces it rightly, as the solid around it lies beyond.
"""

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.boxes import diagonal
from surfmesh.quality.measures.inside import inside
from surfmesh.quality.measures.solids import bounds_none
from surfmesh.quality.measures.topology import Topology, vertex_components
from surfmesh.result.surface_mesh import SurfaceMesh

NO_VOLUME = 1e-9  # of area times diagonal: what encloses less is not told to face any way
MOST = 200  # pieces that are asked whether they are voids


def inward_pieces(
    mesh: SurfaceMesh, topo: Topology
) -> tuple[NDArray[np.float64], NDArray[np.float64], int]:
    """Volumes (k,) of closed pieces of no solid that face their inside, a point of the first,
    and how many closed pieces there are."""
    none = np.empty(0), np.zeros(3), 0
    free = bounds_none(mesh)
    if not free.any():
        return none
    labels = vertex_components(mesh)
    of = labels[mesh.triangles[:, 0]]
    volume, area = _volumes(mesh, of)
    table = mesh.connectivity
    loose = np.concatenate(
        [table.boundary[:, 0], mesh.edges[topo.clashing_edges, 0], mesh.edges[table.uses > 2, 0]]
    )
    closed = np.zeros(len(labels), bool)
    closed[of[free]] = True
    closed[labels[loose]] = False
    closed[of[~free]] = False
    enclosed = NO_VOLUME * area * diagonal(mesh.points)
    found = np.flatnonzero(closed & (volume < -enclosed))
    outward = closed & (volume > 0.0)
    kept = []
    for label in found[:MOST].tolist():
        others = mesh.points[mesh.triangles[outward[of]]]
        if not len(others) or not inside(mesh.points[label][None], others)[0]:
            kept.append(label)
    if not kept:
        return none
    return volume[kept], mesh.points[kept[0]], int(closed.sum())


def _volumes(mesh: SurfaceMesh, of: NDArray) -> tuple[NDArray, NDArray]:
    """Signed volume and area of pieces, by number (n,)."""
    count = len(mesh.points)
    a, b, c = (mesh.points[corner] - mesh.points.mean(axis=0) for corner in mesh.triangles.T)
    volume = np.bincount(of, np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0, count)
    size = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2.0
    return volume, np.bincount(of, size, count)
