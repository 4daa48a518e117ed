"""Reading VTK's XML files, .vtu and .vtp, without VTK, whose readers crash on damaged ones.

How the arrays in them are written is in ``vtk_xml_arrays``.
Format: "VTK XML file formats", https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html

    <VTKFile type="UnstructuredGrid">         type="PolyData"
      <UnstructuredGrid>                        <PolyData>
        <FieldData> arrays                        <FieldData> arrays
        <Piece>                                   <Piece>
          <PointData> <CellData> <Points>           <PointData> <CellData> <Points>
          <Cells> connectivity offsets types        <Verts> <Lines> <Strips> <Polys> each with
      <AppendedData> _bytes                                  connectivity offsets
"""

from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import FileFormatError
from surfmesh.io.vtk_xml_arrays import VtkArrays
from surfmesh.io.xml_reading import root_of

TRIANGLE, QUADRATIC_TRIANGLE = 5, 22  # VTK's numbers of cell types
CORNERS = {TRIANGLE: 3, QUADRATIC_TRIANGLE: 6}
NOT_POLYGONS = ("Verts", "Lines", "Strips")


class VtkContent(NamedTuple):
    """What a file holds, all its pieces one after the other."""

    points: NDArray  # (n, 3)
    cells: NDArray[np.int64]  # (m, 3), or (m, 6) of quadratic triangles: rows of ``points``
    point_data: dict[str, NDArray]  # (n,) or (n, components)
    cell_data: dict[str, NDArray]  # (m,) or (m, components)
    field_data: dict[str, NDArray]


def read_vtk(
    path: Path, point_data: tuple[str, ...], cell_data: tuple[str, ...], field_data: tuple[str, ...]
) -> VtkContent:
    """Points, triangles and those of the arrays named that are there; the others are not unpacked.

    Raises ``FileFormatError`` for cells that are not triangles, for numbers that do not fit each
    other, and for what is damaged or cut short.
    """
    data = path.read_bytes()
    kind = "UnstructuredGrid" if path.suffix.lower() == ".vtu" else "PolyData"
    document, appended = _split(path, data)
    root = root_of(path, document)
    found = root.find(kind) if root.tag == "VTKFile" else None
    if found is None:
        raise FileFormatError(f"{path}: not a {path.suffix} file")
    arrays = VtkArrays.of(path, root, appended, len(data))
    pieces = [_Piece(path, arrays, piece) for piece in found.findall("Piece")]
    pieces = [piece for piece in pieces if piece.points or piece.cells]
    cells = [(_grid_cells if kind == "UnstructuredGrid" else _polygons)(p) for p in pieces]
    if len({rows.shape[1] for rows in cells if len(rows)}) > 1:
        raise FileFormatError(f"{path}: holds triangles of three and of six nodes")
    width = next((rows.shape[1] for rows in cells if len(rows)), 3)
    shifts = np.cumsum([0, *(piece.points for piece in pieces)])
    rows = [own + shift for own, shift in zip(cells, shifts) if len(own)]
    points = [piece.coordinates() for piece in pieces]
    names = [(n, c) for n in field_data if (c := _named(found.find("FieldData"), n)) is not None]
    return VtkContent(
        points=np.concatenate([np.empty((0, 3), np.float32), *points]),
        cells=np.concatenate([np.empty((0, width), np.int64), *rows]),
        point_data=_values(path, pieces, "PointData", point_data),
        cell_data=_values(path, pieces, "CellData", cell_data),
        field_data={name: arrays.field(element) for name, element in names},
    )


def read_index(path: Path, field_data: tuple[str, ...]) -> tuple[list[str], dict[str, NDArray]]:
    """The files that a .pvtu file names, and those of the arrays named in its own field data.

    Raises ``FileFormatError`` for what is damaged, or is no such file.
    """
    data = path.read_bytes()
    root = root_of(path, data)
    found = root.find("PUnstructuredGrid") if root.tag == "VTKFile" else None
    if found is None:
        raise FileFormatError(f"{path}: not a .pvtu file")
    arrays = VtkArrays.of(path, root, b"", len(data))
    names = [(n, c) for n in field_data if (c := _named(found.find("FieldData"), n)) is not None]
    sources = [piece.get("Source", "") for piece in found.findall("Piece")]
    return sources, {name: arrays.field(element) for name, element in names}


def _split(path: Path, data: bytes) -> tuple[bytes, bytes]:
    """The XML without its appended data, and these from behind their underscore."""
    start = data.find(b"<AppendedData")
    if start < 0:
        return data, b""
    end = data.find(b">", start) + 1
    mark = data.find(b"_", end) + 1
    if not end or not mark or data[end : mark - 1].strip():
        raise FileFormatError(f"{path}: its appended data do not start with an underscore")
    closing = b"</VTKFile>"
    last = data.rfind(b"</AppendedData")
    if last < mark or not data.rstrip().endswith(closing):
        raise FileFormatError(f"{path}: the file is cut short: it does not end with </VTKFile>")
    return data[:end] + b"</AppendedData></VTKFile>", data[mark:last]


class _Piece:
    """One piece: its numbers of points and cells, and its arrays."""

    def __init__(self, path: Path, arrays: VtkArrays, element: Element) -> None:
        self.path, self.arrays, self.element = path, arrays, element
        self.points = self._count("NumberOfPoints")
        if path.suffix.lower() == ".vtu":
            self.cells = self._count("NumberOfCells")
        else:
            others = [self._count(f"NumberOf{name}") for name in NOT_POLYGONS]
            self.cells = self._count("NumberOfPolys")
            if any(others):
                raise FileFormatError(f"{path}: holds cells that are not triangles")

    def _count(self, name: str) -> int:
        text = self.element.get(name, "0").strip()
        if not (text.isascii() and text.isdigit() and len(text) < 19):
            raise FileFormatError(f"{self.path}: {name} is {text[:40]!r}, which is no count")
        return int(text)

    def array(self, parent: str, name: str, count: int) -> NDArray:
        """(count,) or (count, components) values of an array that has to be there."""
        element = _named(self.element.find(parent), name)
        if element is None:
            raise FileFormatError(f"{self.path}: {parent} has no array {name!r}")
        return self.arrays.rows(element, count)

    def coordinates(self) -> NDArray:
        if not self.points:
            return np.empty((0, 3), np.float32)
        parent = self.element.find("Points")
        element = None if parent is None else parent.find("DataArray")
        if element is None:
            raise FileFormatError(f"{self.path}: its points are missing")
        found = self.arrays.rows(element, self.points)
        if found.shape != (self.points, 3):
            raise FileFormatError(f"{self.path}: points have to have three coordinates")
        return found

    def connectivity(self, parent: str, width: int) -> NDArray[np.int64]:
        """(m, width) rows of points of cells that all have ``width`` corners."""
        ends = self.array(parent, "offsets", self.cells)
        if ends.shape != (self.cells,) or (np.diff(ends, prepend=0) != width).any():
            raise FileFormatError(f"{self.path}: holds cells that are not triangles")
        rows = self.array(parent, "connectivity", self.cells * width)
        if rows.ndim != 1 or rows.dtype.kind not in "iu":
            raise FileFormatError(f"{self.path}: the corners of cells are not whole numbers")
        if len(rows) and not 0 <= int(rows.min()) <= int(rows.max()) < self.points:
            place = int(np.flatnonzero((rows < 0) | (rows >= self.points))[0])
            raise FileFormatError(
                f"{self.path}: cell {place // width} has corner {rows[place]}, which is outside "
                f"0..{self.points - 1}"
            )
        return rows.astype(np.int64).reshape(-1, width)


def _grid_cells(piece: _Piece) -> NDArray[np.int64]:
    if not piece.cells:
        return np.empty((0, 3), np.int64)
    kinds = set(np.unique(piece.array("Cells", "types", piece.cells)).tolist())
    if len(kinds) > 1 or not kinds <= set(CORNERS):
        raise FileFormatError(f"{piece.path}: holds cells that are not triangles")
    return piece.connectivity("Cells", CORNERS[kinds.pop()])


def _polygons(piece: _Piece) -> NDArray[np.int64]:
    return piece.connectivity("Polys", 3) if piece.cells else np.empty((0, 3), np.int64)


def _named(parent: Element | None, name: str) -> Element | None:
    """The first array called ``name``."""
    found = () if parent is None else parent.findall("DataArray")
    return next((element for element in found if element.get("Name") == name), None)


def _values(
    path: Path, pieces: list[_Piece], parent: str, names: tuple[str, ...]
) -> dict[str, NDArray]:
    """The arrays on points or cells that all pieces have, these one after the other."""
    found = {}
    for name in names:
        there = [_named(piece.element.find(parent), name) is not None for piece in pieces]
        if not any(there):
            continue
        if not all(there):
            raise FileFormatError(f"{path}: {name!r} is in some of the pieces only")
        counts = [piece.points if parent == "PointData" else piece.cells for piece in pieces]
        parts = [piece.array(parent, name, count) for piece, count in zip(pieces, counts)]
        if len({part.shape[1:] for part in parts}) > 1:
            raise FileFormatError(f"{path}: {name!r} has other components in other pieces")
        found[name] = np.concatenate(parts)
    return found
