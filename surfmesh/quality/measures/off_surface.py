"""Vertices that lie off the surface of their triangles where no ``chord`` says how far they may.

Where vertices are asked to lie on the surface they are r(u, v), to rounding. Those on edges of a
CAD model are left out: edges lie off their faces by their tolerances.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.quality import far_corners
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
    none = OffSurface(np.empty(0, np.int64), np.empty(0))
    bound = np.isfinite(tolerances.at(tolerances.chord, mesh.face_ids))
    if mesh.sizing is None or mesh.sizing.vertices != ON_SURFACE or bound.all():
        return none
    left_out = bound | (known.in_plane != 0)
    limit = OFF * known.diagonal
    far = far_corners(*known.prepared_arrays, left_out.view(np.uint8), limit)
    if len(far):
        far = far[~_on_model_edges(mesh)[mesh.triangles.reshape(-1)[far]]]
    if not len(far):
        return none
    vertex, face = mesh.triangles.reshape(-1)[far], mesh.face_ids[far // 3]
    uv = corners.uv_points[corners.uv_triangles.reshape(-1)[far]]
    distance = np.zeros(len(mesh.points))
    for number in np.unique(face).tolist():
        own = np.flatnonzero(face == number)
        points = mesh.points[vertex[own]]
        _, nearest, _ = closest_point(mesh.surfaces[number], points, uv[own], steps=STEPS)
        np.maximum.at(distance, vertex[own], nearest)
    found = np.flatnonzero(distance > limit).astype(np.int64)
    return OffSurface(found, distance[found])


def _on_model_edges(mesh: SurfaceMesh) -> NDArray[np.bool_]:
    """(n,) vertices at edges and vertices of a CAD model."""
    found = np.zeros(len(mesh.points), bool)
    if mesh.edge_segments is not None:
        found[mesh.edge_segments] = True
    if mesh.vertex_ids is not None:
        found[mesh.vertex_ids[mesh.vertex_ids >= 0]] = True
    return found
