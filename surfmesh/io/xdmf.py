"""XDMF 3 with all numbers in the file itself: one grid, attributes on cells and nodes.

Names, colours and the like are an Information element; what XDMF has no place for.
Format: XDMF Model and Format, version 3.
"""

import json
from pathlib import Path
from typing import Any, TextIO
from xml.etree.ElementTree import Element
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import FileFormatError
from surfmesh.io.colours import NO_COLOUR, triangle_colours
from surfmesh.io.group_record import as_cad_numbers, cad_numbers
from surfmesh.io.text_columns import write_rows
from surfmesh.io.xml_reading import root_of
from surfmesh.result.mesh_groups import MeshGroups
from surfmesh.result.quadratic_triangles import split_six_nodes
from surfmesh.result.surface_mesh import SurfaceMesh

TOPOLOGY = {1: "Triangle", 2: "Triangle_6"}
NAMES = {"triangle": 3, "triangle_6": 6, "tri_6": 6}
RECORD = "surfmesh-groups"


def write(mesh: SurfaceMesh, path: Path) -> None:
    record = {"groups": mesh.groups.plain()}
    record |= {name: numbers.tolist() for name, numbers in cad_numbers(mesh).items()}
    cells: dict[str, NDArray] = {"face_id": mesh.face_ids}
    if mesh.solid_ids is not None:
        cells |= {"solid_behind": mesh.solid_ids[:, 0], "solid_before": mesh.solid_ids[:, 1]}
    colours = triangle_colours(mesh)
    if colours is not None:
        cells["colour"] = np.where(colours < 0, NO_COLOUR, colours)
    with open(path, "w", encoding="utf-8", newline="\n") as file:
        file.write('<?xml version="1.0"?>\n<Xdmf Version="3.0"><Domain>\n')
        file.write('<Grid Name="mesh" GridType="Uniform">\n')
        text = json.dumps(record, separators=(",", ":"))
        file.write(f'<Information Name="{RECORD}" Value={quoteattr(text)}>')
        file.write(f"<![CDATA[{_names(mesh)}]]></Information>\n")
        file.write(
            f'<Topology TopologyType="{TOPOLOGY[mesh.order]}" '
            f'NumberOfElements="{len(mesh.triangles)}" NodesPerElement="{mesh.elements.shape[1]}">'
        )
        _write_item(file, mesh.elements)
        file.write('</Topology>\n<Geometry GeometryType="XYZ">')
        _write_item(file, mesh.nodes)
        file.write("</Geometry>\n")
        for name, values in cells.items():
            _write_attribute(file, name, "Cell", values)
        if mesh.node_sizes is not None:
            _write_attribute(file, "size", "Node", mesh.node_sizes)
        file.write("</Grid></Domain></Xdmf>\n")


def _names(mesh: SurfaceMesh) -> str:
    """Names of faces as meshio wants them: it refuses an Information element without."""
    maps = "".join(
        f"<map key={quoteattr(mesh.groups.face_label(face))} dim='2'>{face}</map>"
        for face in np.unique(mesh.face_ids).tolist()
    )
    return f"<main>{maps}</main>"


def _write_attribute(file: TextIO, name: str, centre: str, values: NDArray) -> None:
    kind = "Scalar" if values.ndim == 1 else "Vector"
    file.write(f'<Attribute Name="{name}" AttributeType="{kind}" Center="{centre}">')
    _write_item(file, values)
    file.write("</Attribute>\n")


def _write_item(file: TextIO, values: NDArray) -> None:
    real = values.dtype.kind == "f"
    kind, precision, number = ("Float", 8, "%.17g") if real else ("Int", 4, "%d")
    shape = " ".join(map(str, values.shape))
    file.write(
        f'<DataItem DataType="{kind}" Dimensions="{shape}" Format="XML" Precision="{precision}">\n'
    )
    rows = values.reshape(len(values), -1)
    write_rows(file, " ".join([number] * rows.shape[1]) + "\n", rows)
    file.write("</DataItem>")


def read(path: Path) -> SurfaceMesh:
    """The first grid of a file whose numbers stand in it; data in HDF5 are not read."""
    grid = root_of(path, path.read_bytes()).find(".//Grid")
    topology = None if grid is None else grid.find("Topology")
    if grid is None or topology is None:
        raise FileFormatError(f"{path}: there is no grid in it")
    kind = (topology.get("TopologyType") or topology.get("Type") or "").lower()
    if kind not in NAMES:
        raise FileFormatError(f"{path}: holds cells {kind!r} that are not triangles")
    elements = _numbers(path, topology, np.int64).reshape(-1, NAMES[kind])
    points = _numbers(path, grid.find("Geometry"), float).reshape(-1, 3)
    values = {item.get("Name"): item for item in grid.findall("Attribute")}
    fields: dict[str, Any] = {}
    for item in grid.findall("Information"):
        if item.get("Name") == RECORD:
            record = json.loads(item.get("Value") or "")
            fields = {"groups": MeshGroups.of_plain(record["groups"]), **as_cad_numbers(record)}
    if "face_id" in values:
        fields["face_ids"] = _numbers(path, values["face_id"], np.int64)
    if "solid_behind" in values:
        sides = [_numbers(path, values[f"solid_{side}"], np.int64) for side in ("behind", "before")]
        fields["solid_ids"] = np.column_stack(sides)
    sizes = _numbers(path, values["size"], float) if "size" in values else None
    if elements.shape[1] == 6:
        points, elements, fields["mid_points"], kept = split_six_nodes(points, elements)
        sizes = None if sizes is None else sizes[kept]
    return SurfaceMesh(points=points, triangles=elements, sizes=sizes, **fields)


def _numbers(path: Path, parent: Element | None, kind: type) -> NDArray:
    item = None if parent is None else parent.find("DataItem")
    if item is None or item.get("Format", "XML") != "XML":
        raise FileFormatError(f"{path}: numbers are missing or in another file; write them as XML")
    return np.array((item.text or "").split(), kind)
