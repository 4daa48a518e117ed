"""Salome's MED through meshio: a family for each face and edge, groups by name.

The groups of a face are its own name and those of its solids. What MED has no place for stands
in a dataset beside the mesh.
Tested with meshio 5.3. Its writer leaves the units of the axes blank and calls a family by all
its groups, which is more than the 64 characters that readers have room for (Gmsh crashes): both
are written here.
"""

from io import BytesIO
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import FileFormatError, needs
from surfmesh.io.group_record import group_fields, group_lines, solids_of_faces
from surfmesh.io.hdf5_bounds import require_bounded
from surfmesh.result.mesh_groups import MeshGroups
from surfmesh.result.quadratic_triangles import split_six_nodes
from surfmesh.result.surface_mesh import SurfaceMesh

LINE, TRIANGLE = {1: "line", 2: "line3"}, {1: "triangle", 2: "triangle6"}
RECORD = "surfmesh_groups"
WIDTH = 16  # characters of the unit of one axis
NAME = 80  # characters of a group


def _libraries(path: Path) -> tuple[ModuleType, ModuleType]:
    with needs("med", path.suffix):
        import h5py
        import meshio.med
    return meshio, h5py


def write(mesh: SurfaceMesh, path: Path) -> None:
    meshio, h5py = _libraries(path)
    groups, solids = mesh.groups, solids_of_faces(mesh)
    blocks: list[tuple[str, NDArray]] = [(TRIANGLE[mesh.order], mesh.elements)]
    families = [-1 - mesh.face_ids]
    names = {}
    for face in np.unique(mesh.face_ids).tolist():
        held = [groups.solid_label(solid) for solid in solids[face].tolist() if solid >= 0]
        names[-1 - face] = list(dict.fromkeys((groups.face_label(face), *held)))
    if mesh.edge_ids is not None and len(mesh.edge_ids):
        below = int(mesh.face_ids.max()) + 1
        blocks.append((LINE[mesh.order], mesh.edge_elements))
        families.append(-1 - below - mesh.edge_ids)
        for edge in np.unique(mesh.edge_ids).tolist():
            names[-1 - below - edge] = [groups.edge_label(edge)]
    content = meshio.Mesh(mesh.nodes, blocks, cell_data={"cell_tags": families})
    content.cell_tags, content.point_tags = {}, {}
    image = BytesIO()  # HDF5 says what goes wrong with files late, or on the console alone
    meshio.med.write(image, content)
    with h5py.File(image, "r+") as file:
        text = "\n".join(group_lines(mesh, numbered=True)).encode("ascii")
        file[RECORD] = np.frombuffer(text, np.uint8)
        for name, found in file["ENS_MAA"].items():
            _write_families(file["FAS"][name].create_group("ELEME"), names)
            if groups.unit:
                found.attrs["UNI"] = np.bytes_(groups.unit.ljust(WIDTH) * 3)
    path.write_bytes(image.getbuffer())


def _write_families(parent: Any, names: dict[int, list[str]]) -> None:
    """Families by their numbers, below a group of the HDF5 file; names in ASCII alone."""
    for number, held in names.items():
        family = parent.create_group(f"FAM_{number}")
        family.attrs.create("NUM", number)
        group = family.create_group("GRO")
        group.attrs.create("NBR", len(held))
        rows = group.create_dataset("NOM", (len(held),), dtype=f"{NAME}int8")
        for row, name in enumerate(held):
            text = name.encode("ascii", "replace")[: NAME - 1].ljust(NAME, b"\0")
            rows[row] = np.frombuffer(text, np.int8)


def read(path: Path) -> SurfaceMesh:
    """Triangles; in a file of another program a face is a family, named by its first group."""
    meshio, h5py = _libraries(path)
    with h5py.File(path, "r") as file:
        require_bounded(path, file)
        text = bytes(file[RECORD][()]).decode("ascii") if RECORD in file else ""
        bare = _without_groups(file, h5py)
    source: Path | BytesIO = path
    if bare:
        source = BytesIO(path.read_bytes())
        with h5py.File(source, "r+") as file:
            for family in bare:
                del file[family]
    found = meshio.med.read(source)
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
    fields = group_fields(text.splitlines(), len(elements[0]))
    if "face_ids" not in fields:
        numbers, fields["face_ids"] = np.unique(-families[0], return_inverse=True)
        held = [found.cell_tags.get(-number) or [""] for number in numbers.tolist()]
        fields["groups"] = MeshGroups(face_names=tuple(names[0] for names in held))
    points, triangles = found.points, elements[0]
    if triangles.shape[1] == 6:
        points, triangles, fields["mid_points"], _ = split_six_nodes(points, triangles)
    return SurfaceMesh(points=points, triangles=triangles, **fields)


def _without_groups(file: Any, h5py: ModuleType) -> list[str]:
    """Families of no group, as Gmsh writes them: meshio asks each for its groups."""
    found: list[str] = []

    def look(name: str, item: Any) -> None:
        if isinstance(item, h5py.Group) and "NUM" in item.attrs and "GRO" not in item:
            found.append(f"FAS/{name}")

    if "FAS" in file:
        file["FAS"].visititems(look)
    return found
