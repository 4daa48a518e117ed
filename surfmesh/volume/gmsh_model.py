"""The mesh as a model of Gmsh, ready for ``gmsh.model.mesh.generate(3)``.

Gmsh never fills volumes that it has read from a file of a mesh: they are "discrete" and left as
they are. So the faces come from such a file and the volumes are made by its own kernel around them.
"""

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType

import numpy as np

from surfmesh.io.group_record import solids_of_faces
from surfmesh.io.msh import names_of_solids, write
from surfmesh.result.surface_mesh import SurfaceMesh


def to_gmsh(mesh: SurfaceMesh, name: str = "surfmesh") -> ModuleType:
    """Add a model ``name`` to Gmsh, started when it is not running; returns the module ``gmsh``.

    Entities and physical groups are those of a .msh file: number + 1 of faces, edges and vertices;
    a volume for each solid, in a group with its name (and number, where two have one name). Nodes
    of order 2 are there. Raises ``ImportError`` where there is no gmsh.
    """
    gmsh = _gmsh()
    if not gmsh.isInitialized():
        gmsh.initialize(interruptible=False)
        gmsh.option.setNumber("General.Terminal", 0)
    gmsh.model.add(name)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "surface.msh"
        write(mesh, path, volumes=False)
        gmsh.merge(str(path))
    sides = solids_of_faces(mesh)
    solids = np.unique(sides[sides >= 0]).tolist()
    for solid in solids:
        faces = np.flatnonzero((sides == solid).any(axis=1)) + 1
        loop = gmsh.model.geo.addSurfaceLoop(faces.tolist(), solid + 1)
        gmsh.model.geo.addVolume([loop], solid + 1)
    gmsh.model.geo.synchronize()
    for solid, name in names_of_solids(mesh, solids):
        gmsh.model.addPhysicalGroup(3, [solid + 1], solid + 1, name)
    return gmsh


@contextmanager
def own_model(mesh: SurfaceMesh) -> Iterator[ModuleType]:
    """Gmsh with a model of the mesh; everything is as it was before at the end."""
    gmsh = _gmsh()
    running = gmsh.isInitialized()
    current = gmsh.model.getCurrent() if running else ""
    to_gmsh(mesh, "surfmesh volume")
    try:
        yield gmsh
    finally:
        if running:
            gmsh.model.setCurrent("surfmesh volume")
            gmsh.model.remove()
            if current:
                gmsh.model.setCurrent(current)
        else:
            gmsh.finalize()


def _gmsh() -> ModuleType:
    try:
        import gmsh
    except ImportError:
        raise ImportError("gmsh is not there: pip install gmsh") from None
    return gmsh
