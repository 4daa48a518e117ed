"""Salome's MED through meshio: a family for each face and edge, groups by name.

The groups of a face are its own name and those of its solids. What MED has no place for stands
in a dataset beside the mesh.
Tested with meshio 5.3, whose writer leaves the names of units blank: they are filled in here.
"""

from pathlib import Path
from types import ModuleType

import numpy as np

from surfmesh.errors import FileFormatError
from surfmesh.io.group_record import group_fields, group_lines, solids_of_faces
from surfmesh.six_nodes import edge_rows, split_six_nodes
from surfmesh.surface_mesh import SurfaceMesh

LINE, TRIANGLE = {1: "line", 2: "line3"}, {1: "triangle", 2: "triangle6"}
RECORD = "surfmesh_groups"
WIDTH = 16  # characters of the unit of one axis
NAME = 80  # characters of a group


def _libraries(path: Path) -> tuple[ModuleType, ModuleType]:
    try:
        import h5py
        import meshio.med
    except ImportError as error:
        need = f"{path}: .med needs {error.name}: pip install meshio h5py"
        raise FileFormatError(need) from None
    return meshio, h5py


def write(mesh: SurfaceMesh, path: Path) -> None:
    meshio, h5py = _libraries(path)
    groups, solids = mesh.groups, solids_of_faces(mesh)
    blocks, families = [(TRIANGLE[mesh.order], mesh.elements)], [-1 - mesh.face_ids]
    names = {}
    for face in np.unique(mesh.face_ids).tolist():
        held = [groups.solid_label(solid) for solid in solids[face].tolist() if solid >= 0]
        unique = dict.fromkeys(label[:NAME] for label in (groups.face_label(face), *held))
        names[-1 - face] = list(unique)
    if mesh.edge_segments is not None and len(mesh.edge_segments):
        below = int(mesh.face_ids.max()) + 1
        lines = mesh.edge_segments
        if mesh.order == 2:
            middles = len(mesh.points) + edge_rows(mesh.connectivity, lines)
            lines = np.column_stack((lines, middles))
        blocks.append((LINE[mesh.order], lines))
        families.append(-1 - below - mesh.edge_ids)
        for edge in np.unique(mesh.edge_ids).tolist():
            names[-1 - below - edge] = [groups.edge_label(edge)[:NAME]]
    content = meshio.Mesh(mesh.nodes, blocks, cell_data={"cell_tags": families})
    content.cell_tags, content.point_tags = names, {}
    meshio.med.write(path, content)
    with h5py.File(path, "r+") as file:
        text = "\n".join(group_lines(mesh, numbered=True)).encode("ascii")
        file[RECORD] = np.frombuffer(text, np.uint8)
        if groups.unit:
            for found in file["ENS_MAA"].values():
                found.attrs["UNI"] = np.bytes_(groups.unit.ljust(WIDTH) * 3)


def read(path: Path) -> SurfaceMesh:
    """Triangles; the number of a face is that of its family, names come from the groups."""
    meshio, h5py = _libraries(path)
    found = meshio.med.read(path)
    with h5py.File(path, "r") as file:
        text = bytes(file[RECORD][()]).decode("ascii") if RECORD in file else ""
    elements, families = [], []
    tags = found.cell_data.get("cell_tags") or [np.zeros(len(c.data), int) for c in found.cells]
    for block, tag in zip(found.cells, tags):
        if block.type in TRIANGLE.values():
            elements.append(block.data)
            families.append(tag)
        elif block.type not in (*LINE.values(), "vertex"):
            raise FileFormatError(f"{path}: holds cells {block.type} that are not triangles")
    if len(elements) != 1:
        raise FileFormatError(f"{path}: holds no triangles, or some of three and some of six nodes")
    fields = group_fields(text.splitlines())
    if "face_ids" not in fields:
        _, fields["face_ids"] = np.unique(-families[0], return_inverse=True)
    points, triangles = found.points, elements[0]
    if triangles.shape[1] == 6:
        points, triangles, fields["mid_points"], _ = split_six_nodes(points, triangles)
    return SurfaceMesh(points=points, triangles=triangles, **fields)
