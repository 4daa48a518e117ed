"""A mesh with its edge table, as the core takes it: looked at once, for all its figures."""

from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.quality import JoinedTriangles
from surfmesh.result.surface_mesh import SurfaceMesh


class NumberedFaces(NamedTuple):
    """Faces in a row, whatever their numbers."""

    numbers: NDArray[np.integer[Any]]  # (f,) of the faces; (0,) where ``face_ids`` are no numbers
    # of surfaces: then all triangles are in one row
    rows: NDArray[np.int32]  # (m,) of the triangles

    @classmethod
    def of(cls, mesh: SurfaceMesh) -> Self:
        """All surfaces, or the numbers that occur where none is known."""
        faces, count = mesh.face_ids, len(mesh.surfaces)
        if not count:
            numbers, rows = np.unique(faces, return_inverse=True)
            return cls(numbers, rows.reshape(-1).astype(np.int32, copy=False))
        if len(faces) and not 0 <= faces.min() <= faces.max() < count:
            return cls(np.empty(0, np.intp), np.zeros(len(faces), np.int32))
        return cls(np.arange(count), faces)


def joined_triangles(mesh: SurfaceMesh, faces: NumberedFaces | None = None) -> JoinedTriangles:
    """``mesh``, whose vertex numbers must be in range. faces: those of the mesh, where they are at
    hand."""
    faces = faces or NumberedFaces.of(mesh)
    table = mesh.connectivity
    return JoinedTriangles(
        mesh.points, mesh.triangles, faces.rows, max(len(faces.numbers), 1), table.edges,
        table.half_edges, table.uses,
    )  # fmt: skip
