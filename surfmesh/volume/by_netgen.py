"""Netgen fills the solids; their triangles stay."""

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import MeshingError
from surfmesh.io.group_record import solids_of_faces
from surfmesh.result.surface_mesh import SurfaceMesh


def fill(mesh: SurfaceMesh, size: float | None) -> tuple[NDArray, NDArray]:
    """Points, those of the mesh first, and tetrahedra inside the solids."""
    try:
        from netgen.meshing import Element2D, FaceDescriptor, Mesh, MeshPoint, Pnt
    except ImportError:
        raise ImportError("engine='netgen' needs Netgen: pip install netgen-mesher") from None
    work = Mesh()
    numbers = [work.Add(MeshPoint(Pnt(*point))) for point in mesh.points.tolist()]
    faces = {}
    for face, (behind, before) in enumerate(solids_of_faces(mesh).tolist()):
        side = FaceDescriptor(bc=face + 1, domin=behind + 1, domout=before + 1, surfnr=face + 1)
        faces[face] = work.Add(side)
    for face, row in zip(mesh.face_ids.tolist(), mesh.triangles.tolist()):
        work.Add(Element2D(faces[face], [numbers[v] for v in row]))
    try:
        options = {} if size is None else {"maxh": size}
        work.GenerateVolumeMesh(**options)
    except Exception as error:  # NgException and others
        raise MeshingError(f"Netgen: {error}") from None
    points = np.array([point.p for point in work.Points()])
    rows = [[vertex.nr - 1 for vertex in element.vertices] for element in work.Elements3D()]
    if not rows:
        raise MeshingError("Netgen made no tetrahedra")
    points[: len(mesh.points)] = mesh.points
    return points, np.array(rows, np.int64)
