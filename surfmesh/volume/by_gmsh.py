"""Gmsh fills the solids; its faces are discrete and stay as they are."""

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import MeshingError
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.volume.gmsh_model import own_model

TETRAHEDRON = 4  # Gmsh's type of element
LARGEST, RENUMBER = "Mesh.MeshSizeMax", "Mesh.Renumber"


def fill(mesh: SurfaceMesh, size: float | None) -> tuple[NDArray, NDArray]:
    """Points, those of the mesh first, and tetrahedra inside the solids."""
    corners = mesh if mesh.order == 1 else mesh.replaced(mid_points=None)
    with own_model(corners) as gmsh:
        before = {name: gmsh.option.getNumber(name) for name in (LARGEST, RENUMBER)}
        try:
            gmsh.option.setNumber(RENUMBER, 0)  # else nodes are numbered anew, entity by entity
            if size is not None:
                gmsh.option.setNumber(LARGEST, size)
            gmsh.model.mesh.generate(3)
        except Exception as error:  # gmsh raises nothing more special
            raise MeshingError(f"Gmsh: {error}") from None
        finally:
            for name, value in before.items():
                gmsh.option.setNumber(name, value)
        tags, places, _ = gmsh.model.mesh.getNodes()
        _, rows = gmsh.model.mesh.getElementsByType(TETRAHEDRON)
    if not len(rows):
        raise MeshingError("Gmsh made no tetrahedra")
    order = np.argsort(tags, kind="stable")
    points = np.asarray(places).reshape(-1, 3)[order]
    at = np.searchsorted(np.asarray(tags)[order], np.asarray(rows).reshape(-1, 4))
    points[: len(mesh.points)] = mesh.points  # they are counted from 1 in the file
    return points, at.astype(np.int64)
