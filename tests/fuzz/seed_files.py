"""Small good files of every kind that is read, made by surfmesh and by others, to be damaged.

The same functions make them for the tests and for ``benchmarks/trust.py``.
"""

import io
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from surfmesh.result.surface_mesh import SurfaceMesh

MESHES = (".vtu", ".vtp", ".stl", ".obj", ".ply", ".glb", ".msh", ".inp", ".bdf", ".xdmf", ".off",
          ".med", ".3mf")  # fmt: skip
CAD = ("step", "iges", "brep")
TEXTS = ("surface", "domain", "drawing", "sizes")
PIECES = (".pvtu", ".pvtu piece")  # of a mesh in several files: the index, and one of the others
EXTENSION = {kind: f".{kind}" for kind in CAD} | {kind: ".toml" for kind in TEXTS}
EXTENSION |= {".pvtu": ".pvtu", ".pvtu piece": ".vtu"}
EXTENSION |= {"drawing": ".svg"} | {kind: kind for kind in MESHES}

DRAWINGS = (
    '<svg viewBox="0 0 10 10"><path d="M1 1 L9 1 L9 9 L1 9 Z M3 3 C3 5 5 5 5 3 Z"/></svg>',
    '<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="30mm"><defs><rect id="r" x="2" '
    'y="2" width="4" height="3"/></defs><g transform="translate(1 2) rotate(10)">'
    '<rect width="30" height="20" rx="3"/><circle cx="10" cy="10" r="4"/></g></svg>',
    '<svg><polygon points="0,0 8,0 8,6 0,6"/><ellipse cx="4" cy="3" rx="2" ry="1"/>'
    '<path d="M1 1 Q2 3 3 1 T5 1 A1 1 0 0 0 6 2 H7 V5 Z" style="fill:none"/></svg>',
)
DOMAINS = (
    'name = "plate"\nouter = [[0, 0], [4, 0], [4, 3], [0, 3]]\nholes = [[[1, 1], [2, 1], [2, 2]]]\n'
    'constraints = [[[0.2, 2.5], [3.8, 2.5]]]\npoints = [[3, 1]]\ncrossings = "split"\n'
    "merge = 1e-6\n"
    "[sizing.distance]\nnear = 0.3\nfar = 0.8\nreach = 1.0\n[facts]\narea = 11.5\nregions = 1\n",
    'name = "two"\ndescription = "two loops"\nouter = [[[0, 0], [2, 0], [2, 2], [0, 2]], '
    "[[3, 0], [4, 0], [4, 1]]]\nsimplify = 0.01\n[sizing]\nsize = 0.5\ngrowth = 1.3\n",
)
SURFACES = (
    'name = "trimmed"\ndescription = "with loops"\nx = "a*u"\ny = "v"\nz = "sin(u)*exp(-v**2)/2"\n'
    "loops = [[[0.1, 0.1], [0.9, 0.1], [0.9, 0.9], [0.1, 0.9]]]\n[parameters]\na = 1.5\n"
    '[domain]\nu = [0, "pi/3"]\nv = [0, 1]\n[sizing]\nchord = 0.01\nangle = 20\n[facts]\n'
    'gaussian = "-1"\nembedded = true\n',
)
SIZES = (
    '[sizes."*"]\nchord = 0.05\ngrowth = 1.3\n[sizes."front*"]\nsize = 0.2\nmin_size = 0.05\n'
    "anisotropy = 5\n",
    '[sizes."*"]\nmax_size = 0.5\nangle = 15\ngap = 2\n[[sizes."*".sources]]\n'
    'near = [[0, 0, 0], [1, 0, 0]]\nsize = 0.1\n[[sizes."*".sources]]\n'
    'lines = [[[0, 0, 0], [1, 0, 0]]]\nsize = 0.2\n[[sizes."*".sources]]\nball = [0.5, 0.5, 0.5]\n'
    'radius = 0.2\nsize = 0.1\n[[sizes."*".sources]]\nbox = [[0, 0, 0], [0.3, 0.3, 0.3]]\n'
    "size = 0.1\n",
)


@cache
def originals(kind: str) -> tuple[bytes, ...]:
    """The files of one kind, the smallest first."""
    if kind in MESHES:
        made = [*_by_surfmesh(kind), *_by_others(kind)]
    elif kind in PIECES:
        made = [
            data
            for name, data in in_pieces().items()
            if (name == Path(name).name) == (kind == PIECES[0])
        ]
    elif kind in CAD:
        made = list(_by_cadquery(kind))
    else:
        own = {"drawing": DRAWINGS, "domain": DOMAINS, "surface": SURFACES, "sizes": SIZES}[kind]
        made = [text.encode() for text in own] + list(_of_gallery(kind))
    return tuple(sorted(made, key=len))


# ---- meshes


@cache
def two_blocks() -> SurfaceMesh:
    """Two boxes that share a face, of order 2, with names, colours, kinds, edges and a unit."""
    import cadquery as cq

    import surfmesh as sm

    parts = cq.Assembly(name="blocks")
    parts.add(cq.Workplane().box(1, 1, 1), name="left é", color=cq.Color(1, 0.5, 0))
    parts.add(cq.Workplane(origin=(1, 0, 0)).box(1, 1, 1), name="right")
    model = sm.from_cadquery(parts, imprint=True)
    return sm.mesh(model, 1.2, order=2)


@cache
def torus() -> SurfaceMesh:
    """A coarse stretched torus: corner parameters, sizes that depend on the direction."""
    import surfmesh as sm

    return sm.mesh(sm.load("torus"), sm.Sizing(size=3.0, anisotropy=2.0))


def tetrahedron() -> SurfaceMesh:
    points = [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]
    return SurfaceMesh(points=points, triangles=[(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)])


def _saved(mesh: SurfaceMesh, extension: str, **options: bool) -> bytes:
    from tempfile import TemporaryDirectory

    with TemporaryDirectory() as folder:
        return mesh.save(Path(folder, f"mesh{extension}"), **options).read_bytes()


@cache
def in_pieces() -> dict[str, bytes]:
    """Two indices with their pieces, by their paths below one folder."""
    from tempfile import TemporaryDirectory
    from unittest.mock import patch

    from surfmesh.io import pvtu

    with TemporaryDirectory() as folder, patch.object(pvtu, "LARGEST", 12):
        for name, mesh in (("blocks", two_blocks()), ("torus", torus())):
            mesh.save(Path(folder, f"{name}.pvtu"))
        paths = sorted(path for path in Path(folder).rglob("*") if path.is_file())
        return {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}


def _by_surfmesh(extension: str) -> Iterator[bytes]:
    from surfmesh.io.formats import SECOND_ORDER

    corners = replace(two_blocks(), mid_points=None)
    yield _saved(tetrahedron(), extension)
    yield _saved(corners, extension)
    yield _saved(torus(), extension)
    if extension in SECOND_ORDER:
        yield _saved(two_blocks(), extension)
    if extension == ".stl":
        yield _saved(corners, extension, ascii=True)


def _by_others(extension: str) -> Iterator[bytes]:
    writers: dict[str, list[Callable[[SurfaceMesh], bytes]]] = {
        ".vtu": [_vtk, _vtk_text, _meshio],
        ".vtp": [_vtk, _vtk_text, _vtk_strips],
        ".msh": [_meshio, _meshio_old],
        ".inp": [_meshio],
        ".bdf": [_meshio],
        ".xdmf": [_meshio],
        ".med": [_meshio],
        ".stl": [_trimesh, _meshio],
        ".ply": [_trimesh, _trimesh_text, _meshio],
        ".obj": [_trimesh, _obj_by_hand],
        ".off": [_trimesh],
        ".glb": [_trimesh],
        ".3mf": [_trimesh],
    }
    for writer in writers[extension]:
        yield writer(extension)


def _vtk(extension: str, text: bool = False, strips: bool = False) -> bytes:
    """As VTK writes by itself: compressed and appended, or as text."""
    import pyvista
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter

    mesh = replace(two_blocks(), mid_points=None)
    faces = np.column_stack((np.full(len(mesh.triangles), 3), mesh.triangles))
    data: pyvista.DataSet = pyvista.PolyData(mesh.points.copy(), faces.ravel())
    data.cell_data["face_id"] = mesh.face_ids.copy()
    groups = _json_bytes(mesh)
    data.field_data["surfmesh_groups"] = np.frombuffer(groups, np.uint8)
    if strips:
        data = data.strip()
    writer = vtkXMLPolyDataWriter()
    if extension == ".vtu":
        data, writer = data.cast_to_unstructured_grid(), vtkXMLUnstructuredGridWriter()
    writer.SetInputData(data)
    writer.WriteToOutputStringOn()
    if text:
        writer.SetDataModeToAscii()
    writer.Write()
    return writer.GetOutputString().encode("latin-1")


def _vtk_text(extension: str) -> bytes:
    return _vtk(extension, text=True)


def _vtk_strips(extension: str) -> bytes:
    """Triangles in strips, which this reader may refuse but must not misread."""
    return _vtk(extension, text=True, strips=True)


def _json_bytes(mesh: SurfaceMesh) -> bytes:
    import json

    return json.dumps(mesh.groups.plain()).encode()


def _meshio(extension: str, form: str | None = None) -> bytes:
    from contextlib import redirect_stderr, redirect_stdout
    from tempfile import TemporaryDirectory

    import meshio

    mesh = replace(two_blocks(), mid_points=None)
    forms = {".msh": "gmsh22", ".bdf": "nastran"}
    options = {".xdmf": {"data_format": "XML"}, ".vtu": {"compression": None}}.get(extension, {})
    content = meshio.Mesh(mesh.points, [("triangle", mesh.triangles)])
    quiet = io.StringIO()
    with TemporaryDirectory() as folder, redirect_stdout(quiet), redirect_stderr(quiet):
        path = Path(folder, f"mesh{extension}")
        meshio.write(path, content, file_format=form or forms.get(extension), **options)
        return path.read_bytes()


def _meshio_old(extension: str) -> bytes:
    """Gmsh's version 4.1 as meshio writes it."""
    return _meshio(extension, "gmsh")


def _trimesh(extension: str, **options: str) -> bytes:
    mesh = replace(two_blocks(), mid_points=None)
    found = mesh.to_trimesh().export(file_type=extension[1:], **options)
    return found if isinstance(found, bytes) else found.encode()


def _trimesh_text(extension: str) -> bytes:
    return _trimesh(extension, encoding="ascii")


def _obj_by_hand(extension: str) -> bytes:
    return (
        b"# by hand\nmtllib a.mtl\no cube\nv 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\n"
        b"vt 0 0\ng one two\nusemtl red\nf 1/1/1 3/1/1 2/1/1\nf 1//1 2//1 4//1\ng three\ns off\n"
        b"f -2 -3 -1\nf -4 -1 -2\n"
    )


# ---- CAD models


def _by_cadquery(kind: str) -> Iterator[bytes]:
    from tempfile import TemporaryDirectory

    import cadquery as cq

    drilled = cq.Workplane().box(2, 2, 1).faces(">Z").hole(0.8).edges("|Z").fillet(0.2)
    pipe = cq.Workplane("XZ").moveTo(1, 0).circle(0.3).revolve(120, (0, 0, 0), (0, 1, 0))
    spline = cq.Workplane().spline([(0, 0), (1, 0.4), (2, 0)]).close().extrude(0.5)
    parts = cq.Assembly(name="parts").add(cq.Workplane().box(1, 1, 1), name="a")
    parts.add(cq.Workplane().sphere(0.5), name="b", loc=cq.Location((2, 0, 0)),
              color=cq.Color(1, 0, 0))  # fmt: skip
    with TemporaryDirectory() as folder:
        path = Path(folder, f"part.{kind}")
        for shape in (drilled, pipe, spline):
            if kind == "step":
                cq.exporters.export(shape, str(path))
            elif kind == "brep":
                shape.val().exportBrep(str(path))
            else:
                _write_iges(shape.val().wrapped, path)
            yield path.read_bytes()
        if kind == "step":
            parts.export(str(path), exportType="STEP")
            yield path.read_bytes()


def _write_iges(shape: object, path: Path) -> None:
    from OCP.IGESControl import IGESControl_Controller, IGESControl_Writer

    IGESControl_Controller.Init_s()
    writer = IGESControl_Writer("MM", 1)
    writer.AddShape(shape)
    writer.Write(str(path))


# ---- text


def _of_gallery(kind: str) -> Iterator[bytes]:
    """The files of the gallery: surfaces or planar domains."""
    from surfmesh.geometry.files.surface_file import gallery
    from surfmesh.geometry.files.toml_entries import sets_key

    if kind in ("surface", "domain"):
        for path in gallery().values():
            if sets_key(path, "outer") == (kind == "domain"):
                yield path.read_bytes()
