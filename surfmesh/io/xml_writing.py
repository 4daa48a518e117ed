"""VTK's XML files written piece by piece: every failure of the file system is an ``OSError``.

VTK's own writers say a full disk on their console alone, or end the process. Numbers are binary
within the XML text (base64), in blocks compressed by zlib, as VTK writes them.
Format: VTK User's Guide, "VTK File Formats", "XML File Formats"; version 0.1, as heads are UInt32.
"""

import base64
import sys
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

BLOCK = 1 << 15  # bytes compressed together, as in VTK
LEVEL = 5  # of zlib, as in VTK
KINDS = {"f8": "Float64", "i4": "Int32", "i8": "Int64", "u1": "UInt8"}
CELL_TYPES = {3: 5, 6: 22, 4: 10, 10: 24}
"""VTK's numbers of triangles and tetrahedra, straight and quadratic, by their nodes."""

Arrays = Mapping[str, NDArray]
POINT_IDS, CELL_IDS = "GlobalPointIds", "GlobalCellIds"
"""Arrays (n,) of points and (m,) of cells: their numbers in a mesh that lies in several files."""


class Content(NamedTuple):
    """What a file holds: one piece of cells that have as many corners each."""

    points: NDArray  # (n, 3) float
    cells: NDArray  # (m, 3), (m, 6), (m, 4) or (m, 10) int
    of_points: Arrays  # (n,) or (n, k)
    of_cells: Arrays  # (m,) or (m, k)
    of_all: Arrays  # field data, of any length


def write_grid(content: Content, path: Path) -> None:
    """A .vtu file: an unstructured grid of triangles or of tetrahedra."""
    count, corners = content.cells.shape
    kind = CELL_TYPES[corners]
    cells = _runs(content.cells, np.int64) | {"types": np.full(count, kind, np.uint8)}
    counts = {"Points": len(content.points), "Cells": count}
    _write(path, "UnstructuredGrid", content, counts, {"Cells": cells})


def write_polygons(content: Content, path: Path) -> None:
    """A .vtp file: polygons."""
    kind = np.int32 if content.cells.size < 2**31 else np.int64
    parts = {name: _runs(np.empty((0, 3)), kind) for name in ("Verts", "Lines", "Strips")}
    parts["Polys"] = _runs(content.cells, kind)
    counts = {name: len(cells["offsets"]) for name, cells in parts.items()}
    _write(path, "PolyData", content, {"Points": len(content.points)} | counts, parts)


def write_index(pieces: Sequence[str], like: Content, of_all: Arrays, path: Path) -> None:
    """A .pvtu file that names .vtu files, which hold the same arrays as ``like``.

    of_all: field data of the whole, which VTK passes over here.
    """
    with open(path, "wb") as file:
        file.write(_head("PUnstructuredGrid", ' GhostLevel="0"'))
        _write_section(file, "FieldData", of_all, counted=True)
        for name, arrays in (
            ("PPointData", like.of_points), ("PCellData", like.of_cells),
            ("PPoints", {"Points": like.points}),
        ):  # fmt: skip
            file.write(f"<{name}{_ids_among(arrays)}>\n".encode())
            for title, values in arrays.items():
                file.write(f"<PDataArray {_described(title, values)}/>\n".encode())
            file.write(f"</{name}>\n".encode())
        for piece in pieces:
            file.write(f"<Piece Source={_quoted(piece)}/>\n".encode())
        file.write(b"</PUnstructuredGrid>\n</VTKFile>\n")


def _head(kind: str, more: str = "") -> bytes:
    order = "LittleEndian" if sys.byteorder == "little" else "BigEndian"
    return (
        f'<?xml version="1.0"?>\n<VTKFile type="{kind}" version="0.1" byte_order="{order}" '
        f'header_type="UInt32" compressor="vtkZLibDataCompressor">\n<{kind}{more}>\n'
    ).encode()


def _runs(cells: NDArray, kind: type) -> dict[str, NDArray]:
    """Corners of all cells in a row, and where those of each cell end."""
    ends = cells.shape[1] * np.arange(1, len(cells) + 1)
    return {"connectivity": cells.ravel().astype(kind), "offsets": ends.astype(kind)}


def _write(
    path: Path, kind: str, content: Content, counts: Mapping[str, int], parts: Mapping[str, Arrays]
) -> None:  # fmt: skip
    sizes = "".join(f' NumberOf{name}="{count}"' for name, count in counts.items())
    with open(path, "wb") as file:
        file.write(_head(kind))
        _write_section(file, "FieldData", content.of_all, counted=True)
        file.write(f"<Piece{sizes}>\n".encode())
        _write_section(file, "PointData", content.of_points)
        _write_section(file, "CellData", content.of_cells)
        _write_section(file, "Points", {"Points": content.points})
        for name, arrays in parts.items():
            _write_section(file, name, arrays)
        file.write(f"</Piece>\n</{kind}>\n</VTKFile>\n".encode())


def _write_section(file: BinaryIO, name: str, arrays: Arrays, counted: bool = False) -> None:
    """counted: with the number of rows, which nothing else in the file tells."""
    file.write(f"<{name}{_ids_among(arrays)}>\n".encode())
    for title, values in arrays.items():
        words = _described(title, values)
        if counted:
            words += f' NumberOfTuples="{len(values)}"'
        file.write(f'<DataArray {words} format="binary">\n'.encode())
        _write_numbers(file, values)
        file.write(b"\n</DataArray>\n")
    file.write(f"</{name}>\n".encode())


def _described(title: str, values: NDArray) -> str:
    words = f'type="{KINDS[values.dtype.str[1:]]}" Name={_quoted(title)}'
    return words + (f' NumberOfComponents="{values.shape[1]}"' if values.ndim > 1 else "")


def _quoted(text: str) -> str:
    """As the value of an attribute; ``xml.sax`` would import all that opens addresses."""
    for sign, name in (("&", "amp"), ("<", "lt"), (">", "gt"), ('"', "quot"), ("\n", "#10")):
        text = text.replace(sign, f"&{name};")
    return f'"{text}"'


def _ids_among(arrays: Arrays) -> str:
    """What tells VTK which array holds the numbers in the whole."""
    return "".join(f' GlobalIds="{name}"' for name in (POINT_IDS, CELL_IDS) if name in arrays)


def _write_numbers(file: BinaryIO, values: NDArray) -> None:
    """Head and blocks: their number, the bytes of each and of the last, those compressed."""
    data = np.ascontiguousarray(values).data.cast("B") if values.size else b""
    blocks = [zlib.compress(data[at : at + BLOCK], LEVEL) for at in range(0, len(data), BLOCK)]
    head = [len(blocks), BLOCK, len(data) % BLOCK, *map(len, blocks)]
    file.write(base64.b64encode(np.array(head, np.uint32).tobytes()))
    file.write(base64.b64encode(b"".join(blocks)))
