"""What survives a round trip through a file, here and with gmsh, netgen and meshio.

    python benchmarks/formats.py [--json outputs/formats.json]

Every program gets the same mesh of two coloured, named solids that share a face, through its own
interface with all it has a place for, writes it and reads it back. A cell says how far the points
moved (share of the diagonal) and what came back:

    t  triangles     f  which triangles are one face     n  names of faces
    c  colours       s  solids of each triangle          2  nodes amid edges

and '-' where the program does not write the format, "written only" where it cannot read what it
wrote. Of netgen's .inp and gmsh's .inp and .obj there is no reader. netgen gets corners alone.

The first column counts what surfmesh itself reads back. In .obj, .ply, .off, .bdf, .inp and .xdmf
names, colours, solids or kinds come in part from a record in comments (or an Information
element), which other programs pass over.
"""

import argparse
import contextlib
import dataclasses
import json
import os
import tempfile
from collections.abc import Callable, Hashable, Iterator
from pathlib import Path

import cadquery as cq
import numpy as np
from OCP.BOPAlgo import BOPAlgo_Builder
from rich.box import SIMPLE_HEAD
from rich.table import Table
from scipy.spatial import cKDTree
from tables import console, heading, note

import surfmesh as sm
from surfmesh.io import FORMATS, read
from surfmesh.io.formats import SECOND_ORDER

FEATURES = "tfncs2"


@dataclasses.dataclass
class Found:
    """A mesh as a program gives it back; per triangle, None where it has nothing to say."""

    nodes: np.ndarray
    elements: np.ndarray  # (m, 3) or (m, 6)
    faces: list[Hashable] | None = None
    names: list[str] | None = None
    colours: list[tuple[int, int, int]] | None = None
    solids: list[frozenset[str]] | None = None


def original() -> sm.SurfaceMesh:
    """Two boxes and a cylinder between them, fused so that they share faces; order 2."""
    fuse = BOPAlgo_Builder()
    for solid in (cq.Solid.makeBox(1, 2, 1), cq.Solid.makeBox(2, 2, 1, cq.Vector(1, 0, 0))):
        fuse.AddArgument(solid.wrapped)
    fuse.AddArgument(cq.Solid.makeCylinder(0.4, 1, cq.Vector(2, 1, 1)).wrapped)
    fuse.Perform()
    mesh = sm.mesh(sm.from_cadquery(cq.Shape.cast(fuse.Shape())), 0.3, order=2)
    faces, solids = len(mesh.groups.face_names), len(mesh.groups.solid_names)
    groups = dataclasses.replace(
        mesh.groups,
        face_names=tuple(f"side {'abcdefghijklmnopqrstuvwxyz'[face]}" for face in range(faces)),
        face_colours=tuple((face / 20, 0.2, 1 - face / 20) for face in range(faces)),
        solid_names=tuple(f"part {number}" for number in range(solids)),
    )
    return dataclasses.replace(mesh, groups=groups)


def seen(mesh: sm.SurfaceMesh) -> Found:
    """A SurfaceMesh in the same terms."""
    groups = mesh.groups
    faces = mesh.face_ids.tolist()
    names = [groups.face_names[face] for face in faces] if groups.face_names else None
    colours = None
    if groups.face_colours:
        colours = [tuple(round(255 * c) for c in groups.face_colours[face]) for face in faces]
    solids = None
    if mesh.solid_ids is not None:
        solids = [frozenset(groups.solid_label(s) for s in pair if s >= 0)
                  for pair in mesh.solid_ids.tolist()]  # fmt: skip
    return Found(mesh.nodes, mesh.elements, faces, names, colours, solids)


def survived(found: Found, wanted: Found) -> tuple[float, str]:
    """How far points moved, and the letters of what came back."""
    diagonal = float(np.linalg.norm(np.ptp(wanted.nodes, axis=0)))
    corners = np.unique(wanted.elements[:, :3])
    distance, _ = cKDTree(found.nodes).query(wanted.nodes[corners])
    letters = "t" * (len(found.elements) == len(wanted.elements))
    if letters:

        def of(values: list | None) -> list | None:
            return None if values is None else [values[at] for at in match]

        centres = [mesh.nodes[mesh.elements[:, :3]].mean(axis=1) for mesh in (found, wanted)]
        _, match = cKDTree(centres[0]).query(centres[1])
        faces = of(found.faces)
        if faces is not None:
            pairs = set(zip(faces, wanted.faces))
            one_to_one = len(pairs) == len(set(faces)) == len(set(wanted.faces))
            letters += "f" * one_to_one
        letters += "n" * (of(found.names) == wanted.names)
        letters += "c" * (of(found.colours) == wanted.colours)
        letters += "s" * (of(found.solids) == wanted.solids)
        if found.elements.shape[1] == 6:
            middles = np.unique(wanted.elements[:, 3:])
            gap, _ = cKDTree(found.nodes).query(wanted.nodes[middles])
            letters += "2" * bool(gap.max() < 1e-5 * diagonal)
    return float(distance.max()) / diagonal, letters


def with_surfmesh(mesh: sm.SurfaceMesh, path: Path) -> Found:
    if path.suffix not in SECOND_ORDER:
        mesh = dataclasses.replace(mesh, mid_points=None)
    return seen(read(mesh.save(path)))


def with_gmsh(mesh: sm.SurfaceMesh, path: Path) -> Found:
    """From our .msh, which holds all that gmsh knows of but colours, which are set."""
    import gmsh

    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.Binary", 1 if path.suffix == ".msh" else 0)
        gmsh.option.setNumber("Mesh.SaveAll", 1)
        gmsh.option.setNumber("Mesh.BdfFieldFormat", 2)  # large fields
        gmsh.open(str(mesh.save(path.with_name("source.msh"))))
        for face, colour in enumerate(mesh.groups.face_colours):
            gmsh.model.setColor([(2, face + 1)], *(round(255 * c) for c in colour))
        gmsh.write(str(path))
        gmsh.clear()
        gmsh.open(str(path))
        tags, nodes, _ = gmsh.model.mesh.getNodes()
        place = np.full(int(tags.max()) + 1, -1)
        place[tags.astype(int)] = np.arange(len(tags))
        volumes = {}
        for _, volume in gmsh.model.getEntities(3):
            name = gmsh.model.getPhysicalName(3, volume)
            for _, face in gmsh.model.getBoundary([(3, volume)], oriented=False):
                volumes.setdefault(face, set()).add(name)
        out = Found(nodes.reshape(-1, 3), np.empty((0, 3), int), [], [], [], [])
        blocks = []
        for _, face in gmsh.model.getEntities(2):
            groups = gmsh.model.getPhysicalGroupsForEntity(2, face)
            name = gmsh.model.getPhysicalName(2, groups[0]) if len(groups) else ""
            colour = gmsh.model.getColor(2, face)[:3]
            for kind, row in zip(*(gmsh.model.mesh.getElements(2, face)[at] for at in (0, 2))):
                rows = place[row.astype(int)].reshape(-1, {2: 3, 9: 6}[kind])
                blocks.append(rows)
                for values, value in ((out.faces, face), (out.names, name), (out.colours, colour),
                                      (out.solids, frozenset(volumes.get(face, ())))):  # fmt: skip
                    values += [value] * len(rows)
        out.elements = np.vstack(blocks)
        return out
    finally:
        gmsh.finalize()


def with_meshio(mesh: sm.SurfaceMesh, path: Path) -> Found:
    """Faces as cell data and as cell sets of their names, colours as cell data."""
    import meshio

    extension = {".glb": None, ".3mf": None, ".vtp": None}.get(path.suffix, path.suffix)
    if extension is None:
        raise NotImplementedError
    colours = np.array([mesh.groups.face_colours[face] for face in mesh.face_ids])
    names = [mesh.groups.face_label(face) for face in range(len(mesh.groups.face_names))]
    tags = {".msh": "gmsh:physical", ".bdf": "nastran:ref", ".med": "cell_tags"}
    data = {tags.get(extension, "face_id"): [mesh.face_ids + (extension == ".msh")]}
    if extension == ".msh":
        data["gmsh:geometrical"] = data["gmsh:physical"]
    if extension in (".vtu", ".xdmf"):
        data["colour"] = [colours]
    sets = {name: [np.flatnonzero(mesh.face_ids == face)] for face, name in enumerate(names)}
    kept = mesh.order == 2 and extension in SECOND_ORDER
    rows = mesh.elements if kept else mesh.triangles
    content = meshio.Mesh(
        mesh.nodes if kept else mesh.points,
        [("triangle6" if kept else "triangle", rows)],
        cell_data=data,
        cell_sets=sets if extension == ".inp" else None,
        field_data={name: np.array([face + 1, 2]) for face, name in enumerate(names)},
    )
    if extension == ".med":
        content.cell_data["cell_tags"][0] = -1 - mesh.face_ids
        content.cell_tags = {-1 - face: [name] for face, name in enumerate(names)}
        content.point_tags = {}
    form = "gmsh22" if extension == ".msh" else None  # its 4.1 wants entities
    meshio.write(path, content, file_format=form)
    found = meshio.read(path, file_format="gmsh" if form else None)
    blocks = [block.data for block in found.cells]
    flat = {name: np.concatenate(values) for name, values in found.cell_data.items()}
    out = Found(found.points, np.vstack(blocks))
    for name in (*tags.values(), "face_id"):
        if name in flat:
            out.faces = flat[name].tolist()
    if "colour" in flat:
        out.colours = [tuple(np.round(255 * row).astype(int).tolist()) for row in flat["colour"]]
    tables = [{tag: name for name, (tag, _) in found.field_data.items()}]
    tables += [{tag: held[0] for tag, held in getattr(found, "cell_tags", {}).items()}]
    for table in tables:
        if table and out.faces and set(out.faces) <= set(table):
            out.names = [table[face] for face in out.faces]
    members = {k: v for k, v in found.cell_sets.items() if not k.startswith("gmsh:")}
    if extension == ".inp" and members:
        starts = np.cumsum([0, *map(len, blocks)])
        out.names = [""] * len(out.elements)
        for name, own in members.items():
            for start, rows in zip(starts, own):
                for row in np.asarray(rows, int).tolist():
                    out.names[start + row] = name
        out.faces = out.names
    return out


def with_netgen(mesh: sm.SurfaceMesh, path: Path) -> Found:
    """As a netgen mesh with a descriptor for each face; what it writes and reads again."""
    from netgen import meshing as ng

    kinds = {".msh": "Gmsh2 Format", ".stl": "STL Format", ".inp": "Abaqus Format", ".vol": ""}
    if path.suffix not in kinds:
        raise NotImplementedError
    made = ng.Mesh(3)
    numbers = [made.Add(ng.MeshPoint(ng.Pnt(*point))) for point in mesh.points.tolist()]
    for face, name in enumerate(mesh.groups.face_names):
        behind, before = mesh.solid_ids[np.flatnonzero(mesh.face_ids == face)[0]].tolist()
        number = made.Add(
            ng.FaceDescriptor(surfnr=face + 1, domin=behind + 1, domout=before + 1, bc=face + 1)
        )
        made.SetBCName(face, name)
        made.FaceDescriptor(number).color = (*mesh.groups.face_colours[face], 1.0)
    for row, face in zip(mesh.triangles.tolist(), mesh.face_ids.tolist()):
        made.Add(ng.Element2D(face + 1, [numbers[corner] for corner in row]))
    for number, name in enumerate(mesh.groups.solid_names):
        made.SetMaterial(number + 1, name)
    again = ng.Mesh(3)
    if path.suffix == ".vol":
        made.Save(str(path))
        again.Load(str(path))
    else:
        made.Export(str(path), kinds[path.suffix])
        if path.suffix == ".msh":
            from netgen.read_gmsh import ReadGmsh

            again = ReadGmsh(str(path))
        else:
            again = ng.ImportMesh(str(path))
    points = np.array([tuple(point.p) for point in again.Points()])
    elements, out = again.Elements2D(), Found(points, np.empty(0), [], [], [], [])
    out.elements = np.array([[v.nr - 1 for v in element.vertices] for element in elements])
    for element in elements:
        face = again.FaceDescriptor(element.index)
        out.faces.append(element.index)
        out.names.append(face.bcname)
        out.colours.append(tuple(round(255 * c) for c in tuple(face.color)[:3]))
        held = [d for d in (face.domin, face.domout) if d > 0]
        out.solids.append(frozenset(again.GetMaterial(domain) for domain in held))
    return out


PROGRAMS: dict[str, Callable[[sm.SurfaceMesh, Path], Found]] = {
    "surfmesh": with_surfmesh,
    "gmsh": with_gmsh,
    "netgen": with_netgen,
    "meshio": with_meshio,
}


@contextlib.contextmanager
def silence() -> Iterator[None]:
    """Nothing from compiled libraries either."""
    kept = [os.dup(stream) for stream in (1, 2)]
    with open(os.devnull, "w") as nowhere:
        for stream in (1, 2):
            os.dup2(nowhere.fileno(), stream)
        try:
            yield
        finally:
            for stream, old in zip((1, 2), kept):
                os.dup2(old, stream)
                os.close(old)


def tried(work: Callable, mesh: sm.SurfaceMesh, path: Path, wanted: Found) -> str:
    """The cell of one program and one format."""
    try:
        with silence():
            moved, letters = survived(work(mesh, path), wanted)
    except (Exception, SystemExit):  # whatever the programs raise
        letters = ""
    if letters:
        return f"{moved:.0e} {letters}"
    return "written only" if path.exists() and path.stat().st_size else "-"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", type=Path, help="write the cells too")
    options = parser.parse_args()
    mesh = original()
    wanted = seen(mesh)
    heading(f"What survives: {mesh}, {len(mesh.groups.solid_names)} solids, order 2")
    note("t triangles, f faces, n names, c colours, s solids, 2 order 2; points by diagonal")
    table = Table(box=SIMPLE_HEAD)
    for title in ("", *PROGRAMS):
        table.add_column(title, no_wrap=True)
    cells = {}
    with tempfile.TemporaryDirectory() as folder:
        for extension in (*FORMATS, ".vol"):
            cells[extension] = {
                program: tried(work, mesh, Path(folder) / f"{program}{extension}", wanted)
                if extension in FORMATS or program == "netgen" else "-"
                for program, work in PROGRAMS.items()
            }  # fmt: skip
            table.add_row(extension, *cells[extension].values())
    console.print(table)
    if options.json:
        options.json.write_text(json.dumps(cells, indent=2) + os.linesep)


if __name__ == "__main__":
    main()
