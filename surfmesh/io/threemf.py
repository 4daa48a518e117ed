"""3MF: one object a solid, a set of triangles for each face, colours as base materials.

Coordinates have 17 digits, the unit is one of the file's own. What 3MF has no place for, and
the numbers of the vertices, stand in metadata.
Format: 3MF Core Specification 1.3, with chapter "Triangle Sets".
"""

import json
import zipfile
from array import array
from collections.abc import Iterator
from datetime import UTC, datetime
from io import BytesIO
from pathlib import Path
from typing import IO
from xml.sax.saxutils import escape, quoteattr

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import FileFormatError
from surfmesh.io import xml_reading
from surfmesh.io.asked_date import asked_date
from surfmesh.io.colours import colour_of, hexadecimal
from surfmesh.io.expansion import Expansion
from surfmesh.io.text_columns import write_rows
from surfmesh.result.mesh_groups import MeshGroups
from surfmesh.result.surface_mesh import SurfaceMesh

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
SETS = "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07"
OWN = "urn:surfmesh:groups"
MODEL = "3D/3dmodel.model"
UNITS = {"um": "micron", "mm": "millimeter", "cm": "centimeter", "m": "meter", "in": "inch",
         "ft": "foot"}  # fmt: skip
CONTENT_TYPES = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    '<Default Extension="rels" '
    'ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="model" '
    'ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>'
)
RELATIONS = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    f'<Relationship Target="/{MODEL}" Id="rel0" '
    'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
)
EARLIEST, LATEST = datetime(1980, 1, 1, tzinfo=UTC), datetime(2107, 12, 31, tzinfo=UTC)  # of zip
UNIX = 3  # the system that a zip says it was made on
VERTEX, TRIANGLE, OBJECT, MESH, METADATA = (
    f"{CORE}}}{name}" for name in ("vertex", "triangle", "object", "mesh", "metadata")
)
TRIANGLE_SET, REF, RANGE = (f"{SETS}}}{name}" for name in ("triangleset", "ref", "refrange"))
MOST_ENTRIES = 10_000  # files in the archive; pictures and textures are some
MATERIALS = 1  # the id of the one group of materials; objects follow


def write(mesh: SurfaceMesh, path: Path) -> None:
    bodies = _bodies(mesh)
    vertices = [np.unique(mesh.triangles[members]) for _, members, _ in bodies]
    record = {
        "groups": mesh.groups.plain(),
        "points": len(mesh.points),
        "solids": [solid for solid, _, _ in bodies],
        "vertices": None if len(bodies) == 1 else [own.tolist() for own in vertices],
    }
    unit = UNITS.get(mesh.groups.unit, "millimeter")
    colours: dict[str, int] = {}
    packed = BytesIO()  # zipfile cannot be closed well on a disk that is full
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr(_entry("[Content_Types].xml"), CONTENT_TYPES)
        archive.writestr(_entry("_rels/.rels"), RELATIONS)
        with archive.open(_entry(MODEL), "w", force_zip64=True) as raw:
            file = _Text(raw)
            file.write('<?xml version="1.0" encoding="UTF-8"?>\n')
            file.write(f'<model unit="{unit}" xml:lang="en-US" xmlns="{CORE}" ')
            file.write(f'xmlns:t="{SETS}" xmlns:s="{OWN}">\n')
            file.write('<metadata name="Application">surfmesh</metadata>\n')
            text = json.dumps(record, separators=(",", ":"))
            file.write(f'<metadata name="s:groups">{escape(text)}</metadata>\n<resources>\n')
            of_faces = _materials(mesh, bodies, colours)
            if colours:
                file.write(f'<basematerials id="{MATERIALS}">')
                for colour in colours:
                    file.write(f'<base name="{colour}" displaycolor="{colour}"/>')
                file.write("</basematerials>\n")
            for number, ((solid, members, turned), own) in enumerate(zip(bodies, vertices)):
                _write_object(file, mesh, number, solid, members, turned, own, of_faces[number])
            file.write("</resources>\n<build>")
            for number in range(len(bodies)):
                file.write(f'<item objectid="{MATERIALS + 1 + number}"/>')
            file.write("</build>\n</model>\n")
    path.write_bytes(packed.getbuffer())


def _entry(name: str) -> zipfile.ZipInfo:
    """Dated by ``SOURCE_DATE_EPOCH``, or by the first day of zip: the same bytes at any time."""
    date = asked_date() or EARLIEST
    entry = zipfile.ZipInfo(name, min(max(date, EARLIEST), LATEST).timetuple()[:6])
    entry.compress_type, entry.create_system = zipfile.ZIP_DEFLATED, UNIX
    entry.external_attr = 0o644 << 16
    return entry


class _Text:
    """Text into a binary stream."""

    def __init__(self, raw: IO[bytes]) -> None:
        self.raw = raw

    def write(self, text: str) -> None:
        self.raw.write(text.encode())


Body = tuple[int, NDArray, NDArray]  # solid or -1, its triangles, which of them are turned over


def _bodies(mesh: SurfaceMesh) -> list[Body]:
    solids = np.full((len(mesh.triangles), 2), -1) if mesh.solid_ids is None else mesh.solid_ids
    found = []
    for solid in np.unique(solids).tolist():
        own = (solids < 0).all(axis=1) if solid < 0 else (solids == solid).any(axis=1)
        members = np.flatnonzero(own)
        if len(members):
            members = members[np.argsort(mesh.face_ids[members], kind="stable")]
            found.append((solid, members, (solids[members, 0] != solid) & (solid >= 0)))
    return found


def _materials(mesh: SurfaceMesh, bodies: list[Body], colours: dict[str, int]) -> list[dict]:
    """The number of the colour of each face of each body; fills in ``colours``."""
    found = []
    for solid, members, _ in bodies:
        of = {}
        for face in np.unique(mesh.face_ids[members]).tolist():
            colour = colour_of(mesh, face, solid)
            if colour is not None:
                of[face] = colours.setdefault(hexadecimal(colour), len(colours))
        found.append(of)
    return found


def _write_object(
    file: _Text, mesh: SurfaceMesh, number: int, solid: int, members: NDArray,
    turned: NDArray, own: NDArray, material: dict[int, int],
) -> None:  # fmt: skip
    groups = mesh.groups
    name = groups.solid_label(solid) if solid >= 0 else "surface"
    kind = "model" if solid >= 0 else "surface"  # a model has to be closed
    default = next(iter(material.values()), None)
    paint = "" if default is None else f' pid="{MATERIALS}" pindex="{default}"'
    file.write(
        f'<object id="{MATERIALS + 1 + number}" type="{kind}" name={quoteattr(name)}{paint}>'
        "<mesh>\n<vertices>\n"
    )
    write_rows(file, '<vertex x="%.17g" y="%.17g" z="%.17g"/>\n', mesh.points[own])
    file.write("</vertices>\n<triangles>\n")
    rows = np.searchsorted(own, mesh.triangles[members])
    rows = np.where(turned[:, None], rows[:, ::-1], rows)
    starts = np.flatnonzero(np.diff(mesh.face_ids[members], prepend=-1))
    ends = np.append(starts[1:], len(members))
    faces = mesh.face_ids[members[starts]].tolist()
    for face, start, end in zip(faces, starts.tolist(), ends.tolist()):
        paint = f' pid="{MATERIALS}" p1="{material[face]}"' if face in material else ""
        write_rows(file, f'<triangle v1="%d" v2="%d" v3="%d"{paint}/>\n', rows[start:end])
    file.write("</triangles>\n<t:trianglesets>\n")
    for face, start, end in zip(faces, starts.tolist(), ends.tolist()):
        label = quoteattr(groups.face_label(face))
        file.write(f'<t:triangleset name={label} identifier="face-{face}">\n')
        # one by one: lib3mf does not know ranges
        write_rows(file, '<t:ref index="%d"/>\n', np.arange(start, end)[:, None])
        file.write("</t:triangleset>\n")
    file.write("</t:trianglesets>\n</mesh></object>\n")


def read(path: Path) -> SurfaceMesh:
    """What ``write`` wrote in full; of other files the meshes of all objects, as they stand."""
    found = _Model()
    with zipfile.ZipFile(path) as archive:
        xml_reading.parse(path, _unpacked(path, archive), found.start, found.end, found.text)
    bodies = found.bodies
    if not bodies:
        raise FileFormatError(f"{path}: there are no meshes in it")
    points, triangles = [body.points() for body in bodies], [body.rows() for body in bodies]
    if not found.record:
        shifts = np.cumsum([0, *map(len, points)])
        return SurfaceMesh(
            points=np.concatenate(points),
            triangles=np.concatenate([t + shift for t, shift in zip(triangles, shifts)]),
        )
    record = json.loads("".join(found.record))
    nodes = np.zeros((_count_of_points(path, record["points"], points), 3))
    numbers = record["vertices"] or [np.arange(len(nodes))]
    corners: dict[int, NDArray] = {}
    solids: dict[int, list[int]] = {}
    for body, solid, own, xyz, rows in zip(bodies, record["solids"], numbers, points, triangles):
        own = np.asarray(own, np.int64)
        if own.ndim != 1 or (len(own) and own.min() < 0):
            raise FileFormatError(f"{path}: the numbers of its vertices are damaged")
        nodes[own] = xyz
        spans = sorted((start, end) for _, start, end in body.sets)
        starts, ends = [start for start, _ in spans], [end for _, end in spans]
        once = len({face for face, _, _ in body.sets}) == len(spans)
        if not once or [*starts, len(rows)] != [0, *ends] or any(a >= b for a, b in spans):
            raise FileFormatError(f"{path}: its triangle sets do not hold each triangle once")
        for face, start, end in body.sets:
            if face in solids:
                solids[face][1] = solid  # the one before it
                continue
            solids[face] = [solid, -1]
            corners[face] = own[rows[start:end]]
    faces = sorted(corners)
    face_ids = np.repeat(faces, [len(corners[face]) for face in faces])
    known = any(solid >= 0 for solid in record["solids"])
    return SurfaceMesh(
        points=nodes,
        triangles=np.concatenate([corners[face] for face in faces]),
        face_ids=face_ids,
        solid_ids=[solids[face] for face in face_ids.tolist()] if known else None,
        groups=MeshGroups.of_plain(record["groups"]),
    )


def _unpacked(path: Path, archive: zipfile.ZipFile) -> Iterator[bytes]:
    """The model in pieces; raises before it grows beyond what such a file can hold."""
    if len(archive.infolist()) > MOST_ENTRIES:
        raise FileFormatError(f"{path}: holds more than {MOST_ENTRIES} files")
    entry = archive.getinfo(MODEL)
    if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise FileFormatError(f"{path}: is compressed otherwise than 3MF allows; use deflate")
    size = path.stat().st_size
    Expansion(path, size).take(entry.file_size)  # what is announced
    expansion = Expansion(path, size)
    with archive.open(entry) as file:
        while piece := file.read(xml_reading.PIECE):
            expansion.take(len(piece))  # what there is
            yield piece


def _count_of_points(path: Path, count: int, points: list[NDArray]) -> int:
    """The number of vertices of the whole mesh: no more than its bodies have."""
    there = sum(map(len, points))
    if not 0 <= count <= there:
        raise FileFormatError(f"{path}: is of {count} vertices and holds {there}")
    return count


class _Body:
    """The mesh of one object while it is read."""

    def __init__(self) -> None:
        self.coordinates, self.corners = array("d"), array("q")
        self.sets: list[tuple[int, int, int]] = []  # face, first triangle, end

    def points(self) -> NDArray[np.float64]:
        return np.array(self.coordinates).reshape(-1, 3)

    def rows(self) -> NDArray[np.int64]:
        return np.array(self.corners, np.int64).reshape(-1, 3)


class _Model:
    """What there is in the model, element by element; the rest is passed over."""

    def __init__(self) -> None:
        self.bodies: list[_Body] = []
        self.record: list[str] = []  # pieces of the text of surfmesh's own metadata
        self.open: list[str] = []  # tags around the place
        self.face = -1
        self.recording = False

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        get = attributes.__getitem__
        if tag == VERTEX:
            if self.bodies:
                xyz = (float(get("x")), float(get("y")), float(get("z")))
                self.bodies[-1].coordinates.extend(xyz)
        elif tag == TRIANGLE:
            if self.bodies:
                rows = (int(get("v1")), int(get("v2")), int(get("v3")))
                self.bodies[-1].corners.extend(rows)
        elif tag == MESH and self.open[-1:] == [OBJECT]:
            self.bodies.append(_Body())
        elif tag == TRIANGLE_SET:
            number = attributes.get("identifier", "").partition("-")[2]
            self.face = int(number) if number.isdecimal() else -1  # other programs' say nothing
        elif tag == REF and self.bodies and self.face >= 0:
            self._add(int(get("index")))
        elif tag == RANGE and self.bodies and self.face >= 0:
            span = self.face, int(get("startindex")), int(get("endindex")) + 1
            self.bodies[-1].sets.append(span)
        elif tag == METADATA and attributes.get("name") == "s:groups" and not self.record:
            self.recording = True
        self.open.append(tag)

    def _add(self, triangle: int) -> None:
        """One triangle more of the set that is open."""
        sets = self.bodies[-1].sets
        if sets and sets[-1][0] == self.face and sets[-1][2] == triangle:
            sets[-1] = self.face, sets[-1][1], triangle + 1
        else:
            sets.append((self.face, triangle, triangle + 1))

    def end(self, tag: str) -> None:
        self.open.pop()
        self.recording = False

    def text(self, text: str) -> None:
        if self.recording:
            self.record.append(text)
