"""Nastran bulk data: GRID*, CTRIA3 or CTRIA6; the property of an element is its face.

Names of properties stand in comments as HyperMesh writes them, sets of elements for solids in
the case control section, what else is known of faces and edges in comments before ENDDATA.
Properties are shells of thickness 1 of one material with a modulus of 1, so that all references
are met; both are there to be replaced. A coordinate has 16 characters, thus 15 digits between
0.001 and 1 and 11 at least.
Format: MSC Nastran Quick Reference Guide, "Bulk Data Entries".
"""

from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from surfmesh.errors import FileFormatError
from surfmesh.io.group_record import group_fields, group_lines
from surfmesh.io.inp import placed
from surfmesh.io.numbers_of_groups import named_faces
from surfmesh.result.mesh_groups import MeshGroups
from surfmesh.result.quadratic_triangles import split_six_nodes
from surfmesh.result.surface_mesh import SurfaceMesh

CARD = {1: "CTRIA3  ", 2: "CTRIA6  "}
SHORT, LONG = 8, 16  # characters in a field
NO_PROPERTY = "1"  # elements without a property are one face; Nastran takes the element's number


def write(mesh: SurfaceMesh, path: Path) -> None:
    groups = mesh.groups
    with open(path, "w", encoding="ascii", errors="replace", newline="\n") as file:
        file.write(f"$ surfmesh{', unit ' + groups.unit if groups.unit else ''}\n")
        file.write("CEND\n")
        for solid, members in _solids(mesh):
            file.write(f"$ SET {solid + 1}: {groups.solid_label(solid)}\n")
            file.writelines(f"{line}\n" for line in _set_lines(solid + 1, members))
        file.write("BEGIN BULK\n")
        file.write("$ placeholders: thickness 1.0, Young's modulus 1.0, Poisson's ratio 0.3\n")
        file.write(f"MAT1    {1:8d}{1.0:8}{'':8}{0.3:8}\n")
        for face in np.unique(mesh.face_ids).tolist():
            file.write(f'$HMNAME COMP{face + 1:20d}"{groups.face_label(face)}"\n')
            file.write(f"PSHELL  {face + 1:8d}{1:8d}{1.0:8}{1:8d}\n")
        for number, (x, y, z) in enumerate(mesh.nodes.tolist(), 1):
            file.write(f"GRID*   {number:16d}{'':16}{real(x):>16}{real(y):>16}*\n")
            file.write(f"*       {real(z):>16}\n")
        rows = np.column_stack((np.arange(len(mesh.triangles)), mesh.face_ids, mesh.elements)) + 1
        card = CARD[mesh.order]
        file.writelines(card + "".join(f"{i:8d}" for i in row) + "\n" for row in rows.tolist())
        file.writelines(f"$ {line}\n" for line in group_lines(mesh, numbered=True))
        file.write("ENDDATA\n")


def real(value: float) -> str:
    """A number in 16 characters, to as many digits as these hold: .125, -1.25-7."""
    if value == 0.0 or 1e-3 <= abs(value) < 1e14:
        whole = len(str(int(abs(value)))) if abs(value) >= 1.0 else 0
        text = f"{value:.{LONG - 1 - whole - (value < 0)}f}"
        text = text.replace("0.", ".", 1) if abs(value) < 1.0 and "0." in text[:3] else text
        text = text[:LONG].rstrip("0")
        return "0.0" if text in (".", "-.") else text
    mantissa, exponent = f"{value:.{LONG - 5 - (value < 0) - (abs(value) < 1e-99)}e}".split("e")
    power = f"{int(exponent):+d}"
    return f"{float(mantissa):.{LONG - 2 - len(power) - (value < 0)}f}{power}"


def _solids(mesh: SurfaceMesh) -> Iterator[tuple[int, np.ndarray]]:
    """Solids and the numbers of their triangles, ascending."""
    if mesh.solid_ids is not None:
        for solid in np.unique(mesh.solid_ids[mesh.solid_ids >= 0]).tolist():
            yield solid, np.flatnonzero((mesh.solid_ids == solid).any(axis=1))


def _set_lines(number: int, members: np.ndarray) -> list[str]:
    """SET 1 = 1 THRU 62, 70 THRU 99; lines of up to 72 columns."""
    runs = np.split(members, np.flatnonzero(np.diff(members) > 1) + 1)
    words = [f"{a + 1} THRU {b + 1}" if a < b else f"{a + 1}"
             for a, b in ((int(run[0]), int(run[-1])) for run in runs)]  # fmt: skip
    lines = [f"SET {number} = {words[0]}"]
    for word in words[1:]:
        if len(lines[-1]) + len(word) > 68:
            lines[-1] += ","
            lines.append(f"  {word}")
        else:
            lines[-1] += f", {word}"
    return lines


def read(path: Path) -> SurfaceMesh:
    """GRID, CTRIA3 and CTRIA6, in small, large and free fields; other cards but elements pass."""
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    if not any(line.strip().upper() == "ENDDATA" for line in lines):
        raise FileFormatError(f"{path}: does not end with ENDDATA")
    tags, points, rows, names = [], [], [], {}
    for card, *data in _cards(lines):
        if card == "GRID":
            tags.append(int(data[0]))
            points.append([_number(field) for field in (data + [""] * 5)[2:5]])
        elif card in ("CTRIA3", "CTRIA6"):
            number, face, *corners = data[: 5 if card == "CTRIA3" else 8]
            rows.append([int(field) for field in (number, face or NO_PROPERTY, *corners)])
        elif card in ("CQUAD4", "CQUAD8", "CTETRA", "CHEXA", "CPENTA", "CQUADR"):
            raise FileFormatError(f"{path}: holds elements {card} that are not triangles")
    for line in lines:
        if line.startswith("$HMNAME COMP"):
            number, _, name = line[12:].partition('"')
            names[int(number) - 1] = name.rstrip().rstrip('"')
    if len({len(row) for row in rows}) > 1:
        raise FileFormatError(f"{path}: holds triangles of three and of six nodes")
    if not rows:
        raise FileFormatError(f"{path}: there are no triangles in it")
    table = np.array(sorted(rows), np.int64)
    nodes, elements = placed(path, np.array(tags), np.array(points).reshape(-1, 3), table[:, 2:])
    face_ids = table[:, 1] - 1
    fields = group_fields(lines, len(table), face_ids)
    if "groups" not in fields:
        count = max(names, default=-1) + 1
        face_ids, face_names, fields["warnings"] = named_faces(face_ids, names, count)
        fields["groups"] = MeshGroups(face_names=face_names)
    if elements.shape[1] == 6:
        nodes, elements, fields["mid_points"], _ = split_six_nodes(nodes, elements)
    return SurfaceMesh(points=nodes, triangles=elements, face_ids=face_ids, **fields)


def _cards(lines: Iterable[str]) -> Iterator[list[str]]:
    """Cards as lists of their fields, the name first and without a star."""
    fields: list[str] = []
    for line in lines:
        line = line.partition("$")[0].rstrip()
        if not line:
            continue
        found = _fields(line)
        if found[0].rstrip("*+") == "" or found[0].startswith(("+", "*")):  # goes on
            fields += found[1:]
            continue
        if fields:
            yield fields
        fields = [found[0].rstrip("*").upper(), *found[1:]]
    if fields:
        yield fields


def _fields(line: str) -> list[str]:
    """The name and the data of one line; what stands in the field for continuations goes."""
    if "," in line:
        return [word.strip() for word in line.split(",")][:9]
    width = LONG if "*" in line[:SHORT] else SHORT
    data = line[SHORT:72]
    words = [data[at : at + width].strip() for at in range(0, len(data), width)]
    full = 4 if width == LONG else 8
    return [line[:SHORT].strip(), *words, *[""] * (full - len(words))]


def _number(text: str) -> float:
    """Nastran's reals: 1.5, 1.5E-3, 1.5-3, 1.5D-3; blank is zero."""
    if not text:
        return 0.0
    text = text.upper().replace("D", "E")
    for sign in "+-":
        at = text.rfind(sign)
        if at > 0 and text[at - 1] != "E":
            text = f"{text[:at]}E{text[at:]}"
    return float(text)
