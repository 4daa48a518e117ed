"""Reading VTK's XML files, .vtu and .vtp, without VTK, whose readers crash on damaged ones.

Arrays as text, in base64 or appended; compressed by zlib, lzma or lz4; of either byte order. No
number of the file makes memory before the bytes that it counts are known to be there.
Format: "VTK XML file formats", https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html

    <VTKFile type="UnstructuredGrid">         type="PolyData"
      <UnstructuredGrid>                        <PolyData>
        <FieldData> arrays                        <FieldData> arrays
        <Piece>                                   <Piece>
          <PointData> <CellData> <Points>           <PointData> <CellData> <Points>
          <Cells> connectivity offsets types        <Verts> <Lines> <Strips> <Polys> each with
      <AppendedData> _bytes                                  connectivity offsets
"""

import binascii
import lzma
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import FileFormatError
from surfmesh.io.expansion import Expansion
from surfmesh.io.lz4_block import decompressed as lz4_decompressed
from surfmesh.io.xml_reading import root_of

TRIANGLE, QUADRATIC_TRIANGLE = 5, 22  # VTK's numbers of cell types
CORNERS = {TRIANGLE: 3, QUADRATIC_TRIANGLE: 6}
NOT_POLYGONS = ("Verts", "Lines", "Strips")
NUMBERS = {
    "Int8": "i1", "UInt8": "u1", "Int16": "i2", "UInt16": "u2", "Int32": "i4", "UInt32": "u4",
    "Int64": "i8", "UInt64": "u8", "Float32": "f4", "Float64": "f8",
}  # fmt: skip
LZMA_MEMORY = 256 << 20  # bytes of its dictionary; VTK's largest level needs 65 MB


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
    arrays = _Arrays.of(path, root, appended, len(data))
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
    arrays = _Arrays.of(path, root, b"", len(data))
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

    def __init__(self, path: Path, arrays: "_Arrays", element: Element) -> None:
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


@dataclass(frozen=True)
class _Arrays:
    """How the arrays of one file are written, and the bytes of those that are appended."""

    path: Path
    order: str  # of bytes, as numpy has it: < or >
    header: np.dtype  # of the sizes before the bytes of an array
    unpack: Callable[[bytes, int], bytes] | None  # a block to so many bytes; None: as it is
    appended: bytes
    appended_as_text: bool  # in base64
    expansion: Expansion

    @classmethod
    def of(cls, path: Path, root: Element, appended: bytes, size: int) -> "_Arrays":
        order = {"LittleEndian": "<", "BigEndian": ">"}.get(root.get("byte_order", "LittleEndian"))
        header = {"UInt32": "u4", "UInt64": "u8"}.get(root.get("header_type", "UInt32"))
        if order is None or header is None:
            raise FileFormatError(f"{path}: byte_order or header_type is not one of VTK's")
        compressor = root.get("compressor", "")
        if compressor and compressor not in UNPACK:
            known = ", ".join(UNPACK)
            raise FileFormatError(
                f"{path}: compressor {compressor[:60]!r} is not one of {known}; save with zlib"
            )
        element = root.find("AppendedData")
        encoding = "" if element is None else element.get("encoding", "base64")
        if encoding not in ("", "raw", "base64"):
            raise FileFormatError(f"{path}: appended data are {encoding[:60]!r}, not raw or base64")
        return cls(
            path=path,
            order=order,
            header=np.dtype(order + header),
            unpack=UNPACK[compressor] if compressor else None,
            appended=appended,
            appended_as_text=encoding == "base64",
            expansion=Expansion(path, size),
        )

    def rows(self, element: Element, count: int) -> NDArray:
        """(count,) or (count, components) from the start of an array; it may hold more."""
        width = self._number(element, "NumberOfComponents", 1)
        found = self.values(element)
        if width < 1 or len(found) < count * width:
            name = element.get("Name", "")[:60]
            raise FileFormatError(
                f"{self.path}: the array {name!r} holds {len(found)} numbers instead of "
                f"{count} times {width}"
            )
        found = found[: count * width]
        return found if width == 1 else found.reshape(count, width)

    def field(self, element: Element) -> NDArray:
        """An array of field data, which says itself how long it is."""
        count = self._number(element, "NumberOfTuples", -1)
        return self.values(element) if count < 0 else self.rows(element, count)

    def values(self, element: Element) -> NDArray:
        """All numbers of an array."""
        kind = element.get("type", "")
        if kind not in NUMBERS:
            raise self._damaged(element, f"its type {kind[:40]!r} is none of numbers")
        dtype = np.dtype(self.order + NUMBERS[kind])
        form = element.get("format", "ascii")
        try:
            if form == "ascii":
                found = np.array((element.text or "").split(), dtype.newbyteorder("="))
            elif form == "binary":
                text = "".join((element.text or "").split()).encode()
                found = self._numbers(_Base64(text), dtype)
            elif form == "appended":
                offset = self._number(element, "offset", -1)
                if not 0 <= offset <= len(self.appended):
                    raise ValueError("its offset is outside the appended data")
                kept = memoryview(self.appended)[offset:]
                found = self._numbers((_Base64 if self.appended_as_text else _Raw)(kept), dtype)
            else:
                raise ValueError(f"its format {form[:40]!r} is not known")
        except FileFormatError:
            raise
        except (ValueError, OverflowError, zlib.error, lzma.LZMAError) as error:
            raise self._damaged(element, str(error)) from None
        return found

    def _numbers(self, source: "_Raw", dtype: np.dtype) -> NDArray:
        data = self._unpacked(source, self.unpack) if self.unpack else self._plain(source)
        if len(data) % dtype.itemsize:
            raise ValueError(f"{len(data)} bytes are no whole numbers of {dtype.itemsize} bytes")
        return np.frombuffer(data, dtype).astype(dtype.newbyteorder("="), copy=False)

    def _plain(self, source: "_Raw") -> bytes:
        """Header: the number of bytes. In base64 the two are one text."""
        word = self.header.itemsize
        size = int(np.frombuffer(source.take(word), self.header)[0])
        data = source.take(word + size)[word:]
        self.expansion.take(size)  # many arrays may show the same bytes
        return data

    def _unpacked(self, source: "_Raw", unpack: Callable[[bytes, int], bytes]) -> bytes:
        """Header: the number of blocks, their size, that of the last or 0, and packed sizes."""
        word = self.header.itemsize
        head = np.frombuffer(source.take(3 * word), self.header)
        blocks, size, last = map(int, head)
        if not blocks:
            return b""
        packed = np.frombuffer(source.take((3 + blocks) * word), self.header)[3:].tolist()
        sizes = [size] * (blocks - bool(last)) + [last] * bool(last)
        if last > size:
            raise ValueError(f"its last block has {last} bytes, the others {size}")
        self.expansion.take(sum(sizes))
        content = source.after((3 + blocks) * word).take(sum(packed))
        found, at = [], 0
        for count, wanted in zip(packed, sizes):
            found.append(unpack(content[at : at + count], wanted))
            at += count
        return b"".join(found)

    def _number(self, element: Element, name: str, default: int) -> int:
        text = element.get(name)
        if text is None:
            return default
        if not (text.strip().isascii() and text.strip().isdigit() and len(text) < 19):
            raise self._damaged(element, f"{name} is {text[:40]!r}")
        return int(text)

    def _damaged(self, element: Element, reason: str) -> FileFormatError:
        name = element.get("Name", "")[:60]
        return FileFormatError(f"{self.path}: the array {name!r} is damaged: {reason}")


class _Raw:
    """The bytes of one array and what comes behind it."""

    def __init__(self, data: bytes | memoryview) -> None:
        self.data = memoryview(data)

    def take(self, count: int) -> bytes:
        """The first bytes; ValueError when they are not there."""
        if count > len(self.data):
            raise ValueError(f"{count} bytes are announced, {len(self.data)} are there")
        return bytes(self.data[:count])

    def after(self, count: int) -> "_Raw":
        """What follows the first ``count`` bytes, these written by themselves."""
        return type(self)(self.data[self._written(count) :])

    @staticmethod
    def _written(count: int) -> int:
        return count


class _Base64(_Raw):
    """The same in base64: four characters for three bytes."""

    def take(self, count: int) -> bytes:
        written = self._written(count)
        if written > len(self.data):
            there = len(self.data) // 4 * 3
            raise ValueError(f"{count} bytes are announced, {there} are there")
        text = bytes(self.data[:written])
        try:
            return binascii.a2b_base64(text, strict_mode=True)[:count]
        except binascii.Error as error:
            raise ValueError(f"its base64 is damaged: {error}") from None

    @staticmethod
    def _written(count: int) -> int:
        return (count + 2) // 3 * 4


def _unpack_zlib(data: bytes, size: int) -> bytes:
    work = zlib.decompressobj()
    return _whole(work.decompress(data, size + 1), work.eof, size)


def _unpack_lzma(data: bytes, size: int) -> bytes:
    work = lzma.LZMADecompressor(memlimit=LZMA_MEMORY)
    return _whole(work.decompress(data, size + 1), work.eof, size)


def _whole(found: bytes, ended: bool, size: int) -> bytes:
    if not ended or len(found) != size:
        raise ValueError(f"a block does not unpack to {size} bytes")
    return found


UNPACK: dict[str, Callable[[bytes, int], bytes]] = {
    "vtkZLibDataCompressor": _unpack_zlib,
    "vtkLZMADataCompressor": _unpack_lzma,
    "vtkLZ4DataCompressor": lz4_decompressed,
}
