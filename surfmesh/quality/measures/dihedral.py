"""Dihedral angles between neighbouring triangles, where the surface itself has no crease."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core import quality
from surfmesh._core.quality import JoinedTriangles
from surfmesh.accuracy.dihedral import SLACK
from surfmesh.quality.measures.known_surfaces import KnownSurfaces
from surfmesh.quality.measures.places import Point, as_point, middles
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.options.defaults import DEFAULT_ANGLE


class DihedralAngles(NamedTuple):
    """Angles between the normals of two triangles of one face that share an edge, degrees."""

    edges: NDArray[np.int64]  # (k,) of ``mesh.edges``, across which more than was asked for, or
    # than 45 degrees, was found
    faces: NDArray[np.int32]  # (k,)
    angles: NDArray[np.float64]  # (k,) 0 on a crease of the surface
    largest: NDArray[np.float64]  # (f,) of all edges within each face; 0 without any
    number: NDArray[np.int64]  # (f,) of these
    worst: int | None  # the first edge where the largest of all is

    def above(self, angle: float | NDArray[np.float64]) -> NDArray[np.bool_]:
        """(k,) which of them are larger than ``angle``, degrees: one for all, or (k,)."""
        return self.angles > angle * (1 + SLACK)


def angles_within_faces(
    known: KnownSurfaces, joined: JoinedTriangles, limits: NDArray[np.float64]
) -> DihedralAngles:
    """Angles within the faces of a mesh.

    Edges between two faces are left out: there the model itself may bend. So may one surface,
    at a crease where two of its sides meet, or at an apex: where an angle is larger than asked
    for (or than 45 degrees) the normals of the surface on both sides are compared. limits: by
    face number, or one for all, what was asked for, infinite for nothing.
    """
    mesh, count = known.mesh, len(known.mesh.surfaces)
    limits = np.where(np.isfinite(limits), limits, DEFAULT_ANGLE)
    limits = np.full(count, limits[0]) if len(limits) == 1 else limits[:count]
    edges, angles, largest, number, worst = joined.angles_within_faces(limits * (1 + SLACK))
    faces = mesh.face_ids[mesh.connectivity.half_edges[edges, 0] // 3]
    if len(edges):  # few
        pairs = mesh.connectivity.half_edges[edges]
        creased = quality.face_creases(*known.arrays, pairs, limits)
        angles[creased.view(bool)] = 0.0
        others = -1.0 if worst < 0 else float(largest.max())
        top = float(angles.max())
        if top > others or (top == others and edges[angles.argmax()] < worst):
            worst = int(edges[angles.argmax()])
        np.maximum.at(largest, faces, angles)
    return DihedralAngles(edges, faces, angles, largest, number, None if worst < 0 else worst)


def largest_angle(
    mesh: SurfaceMesh, dihedrals: DihedralAngles
) -> tuple[float, tuple[int, int], Point] | None:
    """The largest angle, the two triangles, and the middle of their edge; None without edges."""
    edge = dihedrals.worst
    if edge is None:
        return None
    first, second = (mesh.connectivity.half_edges[edge] // 3).tolist()
    place = as_point(middles(mesh.points[mesh.edges[edge]]))
    largest = float(dihedrals.largest.max())
    return (largest if math.isfinite(largest) else math.nan), (first, second), place
