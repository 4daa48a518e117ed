"""Dihedral angles between neighbouring triangles, where the surface itself has no crease."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core import quality
from surfmesh.accuracy.dihedral import SLACK
from surfmesh.quality.measures.known_surfaces import KnownSurfaces
from surfmesh.quality.measures.places import Point, as_point
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.options.defaults import DEFAULT_ANGLE


class DihedralAngles(NamedTuple):
    """Angles between the normals of two triangles of one face that share an edge, degrees."""

    edges: NDArray[np.intp]  # (k,) of ``mesh.edges``: between two triangles of one face
    faces: NDArray[np.int32]  # (k,)
    angles: NDArray[np.float64]  # (k,) 0 on a crease of the surface

    def above(self, angle: float | NDArray[np.float64]) -> NDArray[np.bool_]:
        """(k,) which of them are larger than ``angle``, degrees: one for all, or (k,)."""
        return self.angles > angle * (1 + SLACK)


def angles_within_faces(
    mesh: SurfaceMesh,
    limits: NDArray[np.float64] | None = None,
    known: KnownSurfaces | None = None,
) -> DihedralAngles | None:
    """Angles within the faces of ``mesh``; None where its surfaces are not known.

    Edges between two faces are left out: there the model itself may bend. So may one surface,
    at a crease where two of its sides meet, or at an apex: where an angle is larger than asked
    for (or than 45 degrees) the normals of the surface on both sides are compared. limits: by
    face number, or one for all, what was asked for, infinite for nothing; None: by ``sizing``.
    known: the mesh on its surfaces, where that is at hand.
    """
    known = known or KnownSurfaces.of(mesh)
    if known is None:
        return None
    table = mesh.connectivity
    edges, faces, angles = quality.angles_within_faces(
        mesh.points, mesh.triangles, mesh.face_ids, table.half_edges, table.uses
    )
    if limits is None:
        limits = np.array([(mesh.sizing and mesh.sizing.angle) or np.inf])
    limits = np.where(np.isfinite(limits), limits, DEFAULT_ANGLE)
    large = np.flatnonzero(angles > limits.min() * (1 + SLACK))  # few; by face only among these
    if len(limits) > 1:
        large = large[angles[large] > limits[faces[large]] * (1 + SLACK)]
    if len(large):
        pairs = table.half_edges[edges[large]]
        of_each = np.broadcast_to(limits, len(mesh.surfaces)) if len(limits) == 1 else limits
        creased = quality.face_creases(*known.arrays, pairs, np.ascontiguousarray(of_each))
        angles[large[creased.view(bool)]] = 0.0
    return DihedralAngles(edges, faces, angles)


def largest_angle(
    mesh: SurfaceMesh, dihedrals: DihedralAngles
) -> tuple[float, tuple[int, int], Point] | None:
    """The largest angle, the two triangles, and the middle of their edge; None without edges."""
    if not len(dihedrals.angles):
        return None
    worst = int(dihedrals.angles.argmax())
    edge = dihedrals.edges[worst]
    first, second = (mesh.connectivity.half_edges[edge] // 3).tolist()
    place = as_point(mesh.points[mesh.edges[edge]].mean(axis=0))
    largest = float(dihedrals.angles[worst])
    return (largest if math.isfinite(largest) else math.nan), (first, second), place
