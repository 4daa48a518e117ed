"""Vertices that lie off the surface of their triangles where no ``chord`` says how far they may.

Where vertices are asked to lie on the surface they are r(u, v), to rounding. Those on edges of a
CAD model are left out: edges lie off their faces by their tolerances.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.boxes import diagonal
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.quality.measures.known_surfaces import KnownSurfaces
from surfmesh.quality.measures.tolerances import Tolerances
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.options.sizing import ON_SURFACE

OFF = 1e-6
"""Of the diagonal: what (u, v) that were kept in single precision would not reach."""


class OffSurface(NamedTuple):
    """Vertices that lie off their surfaces."""

    vertices: NDArray[np.int64]  # (k,) ascending
    distance: NDArray[np.float64]  # (k,) to the surface, model units


def off_surface(known: KnownSurfaces, tolerances: Tolerances) -> OffSurface:
    """Of faces without a chord; none where it is not known that vertices lie on the surface."""
    mesh, corners = known.mesh, known.corners
    free = ~np.isfinite(tolerances.at(tolerances.chord, mesh.face_ids))
    if mesh.sizing is None or mesh.sizing.vertices != ON_SURFACE or not free.any():
        return OffSurface(np.empty(0, np.int64), np.empty(0))
    vertices, uv, faces = _corners(known, np.flatnonzero(free & (known.in_plane == 0)))
    (on,) = np.nonzero(~_on_model_edges(mesh)[vertices])
    vertices, uv, faces = vertices[on], corners.uv_points[uv[on]], faces[on]
    away = np.linalg.norm(known.points_at(faces, uv) - mesh.points[vertices], axis=1)
    (far,) = np.nonzero(away > OFF * diagonal(mesh.points))
    for face in np.unique(faces[far]).tolist():
        own = far[faces[far] == face]
        found = closest_point(mesh.surfaces[face], mesh.points[vertices[own]], uv[own], steps=8)
        away[own] = found[1]
    far = far[away[far] > OFF * diagonal(mesh.points)]
    most = np.zeros(len(mesh.points))
    np.maximum.at(most, vertices[far], away[far])
    found = np.flatnonzero(most)
    return OffSurface(found, most[found])


def _corners(
    known: KnownSurfaces, triangles: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int32]]:
    """Vertex, row of ``uv_points`` and face (k,) of the corners of triangles, each row once."""
    rows, first = np.unique(known.corners.uv_triangles[triangles], return_index=True)
    vertices = known.mesh.triangles[triangles].reshape(-1)[first]
    return vertices.astype(np.int64), rows, known.mesh.face_ids[triangles[first // 3]]


def _on_model_edges(mesh: SurfaceMesh) -> NDArray[np.bool_]:
    """(n,) vertices at edges and vertices of a CAD model."""
    found = np.zeros(len(mesh.points), bool)
    if mesh.edge_segments is not None:
        found[mesh.edge_segments] = True
    if mesh.vertex_ids is not None:
        found[mesh.vertex_ids[mesh.vertex_ids >= 0]] = True
    return found
