"""The worst triangles, each with where it is."""

from dataclasses import dataclass

import numpy as np

from surfmesh._core.quality import least_values
from surfmesh.errors import shown
from surfmesh.quality.measures.places import Point, middles
from surfmesh.quality.measures.shape import Shapes, shapes
from surfmesh.result.surface_mesh import SurfaceMesh


@dataclass(frozen=True)
class WorstTriangle:
    """One triangle; angles in degrees."""

    triangle: int  # its number
    alpha: float
    min_angle_deg: float
    max_angle_deg: float
    face: int
    name: str  # of the face
    point: Point  # its centroid, model units
    corners: tuple[int, int, int]  # vertex numbers


def worst_triangles(
    mesh: SurfaceMesh, count: int = 20, shape: Shapes | None = None
) -> tuple[WorstTriangle, ...]:
    """The ``count`` triangles of the smallest alpha, the worst first.

    shape: ``shapes(mesh)`` where it is known already. Raises ``TypeError`` for a count that is no
    whole number.
    """
    if isinstance(count, bool) or not isinstance(count, (int, np.integer)):
        raise TypeError(f"count is a number of triangles, as in worst(20), not {shown(count)}")
    shape = shapes(mesh) if shape is None else shape
    count = min(max(int(count), 0), len(mesh.triangles))
    if not count:
        return ()
    worst = least_values(shape.alpha, count)
    corners, faces = mesh.triangles[worst], mesh.face_ids[worst].tolist()
    names = {face: mesh.face_name(face) for face in set(faces)}
    columns = (
        worst.tolist(),
        *(angle[worst].tolist() for angle in (shape.alpha, shape.min_angle, shape.max_angle)),
        faces,
        map(names.__getitem__, faces),
        map(tuple, middles(mesh.points[corners]).tolist()),
        map(tuple, corners.tolist()),
    )
    return tuple(map(WorstTriangle, *columns))
