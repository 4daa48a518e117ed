"""Reading PLY, text or binary of either byte order: vertices, triangles and their columns.

Format: G. Turk, "The PLY Polygon File Format", 1994. Elements come one after the other, rows of
numbers and lists; a list is its length and its entries. Only lists of one length are read, as
triangles have: an array then holds an element as it stands, and no number makes more memory than
there are bytes.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import FileFormatError

TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2",
    "ushort": "u2", "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4",
    "float": "f4", "float32": "f4", "double": "f8", "float64": "f8",
}  # fmt: skip
ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
CORNERS = ("vertex_indices", "vertex_index")
LONGEST = 64  # entries of a list


class PlyContent(NamedTuple):
    """Columns by their names; lists are (count, entries)."""

    lines: list[str]  # of the header
    vertex: dict[str, NDArray]
    face: dict[str, NDArray]

    def corners(self) -> NDArray[np.int64] | None:
        """(m, 3) or (m, 4) vertices of the faces; None when there is no such column."""
        lists = {name: values for name, values in self.face.items() if values.ndim == 2}
        known = [lists[name] for name in CORNERS if name in lists]
        found = known[0] if known else next(iter(lists.values())) if len(lists) == 1 else None
        return None if found is None else found.astype(np.int64)


class _Property(NamedTuple):
    name: str
    kind: str  # of numpy
    length: str  # the kind of the length of a list, or empty


@dataclass(frozen=True)
class _Element:
    name: str
    count: int
    properties: list[_Property]


def read_ply(path: Path) -> PlyContent:
    """The elements ``vertex`` and ``face``.

    Raises ``FileFormatError`` for a header that cannot be understood, lists of several lengths,
    and a file that is shorter, or longer, than its header says.
    """
    data = path.read_bytes()
    head, mark, rest = data.partition(b"end_header")
    if not mark or not head.lstrip()[:3].lower() == b"ply":
        raise FileFormatError(f"{path}: not a .ply file, or its header does not end")
    body = rest[rest.find(b"\n") + 1 :]
    lines = head.decode(errors="replace").splitlines()
    order, elements = _header(path, lines)
    source = _Words(path, body) if order == "" else _Bytes(path, body, order)
    found: dict[str, dict[str, NDArray]] = {}
    for element in elements:
        if {"vertex", "face"} <= set(found) and any(p.length for p in element.properties):
            source.finished = True  # lists of any length, and nothing that is wanted
            break
        found[element.name] = source.columns(element)
    source.require_end()
    return PlyContent(lines, found.get("vertex", {}), found.get("face", {}))


def _header(path: Path, lines: list[str]) -> tuple[str, list[_Element]]:
    """The byte order, empty for text, and the elements in their order."""
    order, elements = None, []
    try:
        for words in map(str.split, lines):
            if words[:1] == ["format"]:
                order = ORDERS[words[1]]
            elif words[:1] == ["element"]:
                count = int(words[2])
                if not 0 <= count < 1 << 62:
                    raise ValueError
                elements.append(_Element(words[1], count, []))
            elif words[:2] == ["property", "list"]:
                made = _Property(words[4], TYPES[words[3]], TYPES[words[2]])
                elements[-1].properties.append(made)
            elif words[:1] == ["property"]:
                elements[-1].properties.append(_Property(words[2], TYPES[words[1]], ""))
    except (KeyError, IndexError, ValueError):
        line = " ".join(words)[:60]
        raise FileFormatError(f"{path}: the header has a line {line!r}") from None
    if order is None:
        raise FileFormatError(f"{path}: the header names no format")
    return order, elements


class _Words:
    """The numbers of a text, element by element."""

    def __init__(self, path: Path, body: bytes) -> None:
        self.path, self.words, self.at, self.finished = path, body.split(), 0, False

    def columns(self, element: _Element) -> dict[str, NDArray]:
        if not element.count:
            return {}
        lengths, width = {}, 0
        for item in element.properties:
            if item.length:
                lengths[item.name] = _list_length(self.path, element, self._word(width))
                width += lengths[item.name]
            width += 1
        end = self.at + width * element.count
        if end > len(self.words):
            raise _short(self.path, element)
        rows = np.array(self.words[self.at : end], float).reshape(element.count, width)
        self.at, column = end, 0
        found = {}
        for item in element.properties:
            if item.length:
                length = lengths[item.name]
                _require_one_length(self.path, element, rows[:, column])
                found[item.name] = rows[:, column + 1 : column + 1 + length].astype(item.kind)
                column += length + 1
            else:
                found[item.name] = rows[:, column].astype(item.kind)
                column += 1
        return found

    def _word(self, ahead: int) -> float:
        at = self.at + ahead
        return float(self.words[at]) if at < len(self.words) else 0.0

    def require_end(self) -> None:
        """Text behind the last element is passed over."""


class _Bytes:
    """The numbers of a binary file, element by element."""

    def __init__(self, path: Path, body: bytes, order: str) -> None:
        self.path, self.body, self.order, self.at = path, body, order, 0
        self.finished = False

    def columns(self, element: _Element) -> dict[str, NDArray]:
        if not element.count or not element.properties:
            return {}
        record: list[tuple] = []
        for item in element.properties:
            kind = self.order + item.kind
            if not item.length:
                record.append((item.name, kind))
                continue
            length = np.dtype(self.order + item.length)
            at = self.at + np.dtype(record).itemsize
            if at + length.itemsize > len(self.body):
                raise _short(self.path, element)
            first = float(np.frombuffer(self.body, length, 1, at)[0])
            record.append((f"length of {item.name}", length))
            record.append((item.name, kind, (_list_length(self.path, element, first),)))
        dtype = np.dtype(record)
        if self.at + dtype.itemsize * element.count > len(self.body):
            raise _short(self.path, element)
        rows = np.frombuffer(self.body, dtype, element.count, self.at)
        self.at += rows.nbytes
        for item in element.properties:
            if item.length:
                _require_one_length(self.path, element, rows[f"length of {item.name}"])
        return {i.name: rows[i.name].astype(i.kind) for i in element.properties}

    def require_end(self) -> None:
        if not self.finished and self.at != len(self.body):
            left = len(self.body) - self.at
            raise FileFormatError(f"{self.path}: has {left} bytes behind its last element")


def _list_length(path: Path, element: _Element, found: float) -> int:
    if not (found == int(found) and 0 <= found <= LONGEST):
        raise FileFormatError(
            f"{path}: a list of element {element.name!r} has length {found:g}: it is damaged"
        )
    return int(found)


def _require_one_length(path: Path, element: _Element, lengths: NDArray) -> None:
    if (lengths != lengths[0]).any():
        what = "faces that are not triangles" if element.name == "face" else "lists of any length"
        raise FileFormatError(f"{path}: holds {what}")


def _short(path: Path, element: _Element) -> FileFormatError:
    return FileFormatError(
        f"{path}: ends before the last of {element.count} of element {element.name!r}: it is "
        "damaged or incomplete"
    )
