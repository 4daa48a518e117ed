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


STEPS = 8
"""To the nearest point of the surface: vertices may have slid along it."""


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
    triangles = np.flatnonzero(free & (known.in_plane == 0))
    half_edge_of = np.full(len(corners.uv_points), -1)  # one of those at each corner
    half_edge_of[corners.uv_triangles[triangles]] = 3 * triangles[:, None] + np.arange(3)
    corner = np.flatnonzero(half_edge_of >= 0)
    triangle, side = np.divmod(half_edge_of[corner], 3)
    vertex, face = mesh.triangles[triangle, side], mesh.face_ids[triangle]
    uv = corners.uv_points[corner]
    away = np.linalg.norm(known.points_at(face, uv) - mesh.points[vertex], axis=1)
    far = np.flatnonzero((away > OFF * diagonal(mesh.points)) & ~_on_model_edges(mesh)[vertex])
    distance = np.zeros(len(mesh.points))
    for number in np.unique(face[far]).tolist():
        own = far[face[far] == number]
        points = mesh.points[vertex[own]]
        _, nearest, _ = closest_point(mesh.surfaces[number], points, uv[own], steps=STEPS)
        np.maximum.at(distance, vertex[own], nearest)
    found = np.flatnonzero(distance > OFF * diagonal(mesh.points)).astype(np.int64)
    return OffSurface(found, distance[found])


def _on_model_edges(mesh: SurfaceMesh) -> NDArray[np.bool_]:
    """(n,) vertices at edges and vertices of a CAD model."""
    found = np.zeros(len(mesh.points), bool)
    if mesh.edge_segments is not None:
        found[mesh.edge_segments] = True
    if mesh.vertex_ids is not None:
        found[mesh.vertex_ids[mesh.vertex_ids >= 0]] = True
    return found
