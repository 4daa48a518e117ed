"""The arrays of VTK's XML files: as text, in base64 or appended, of either byte order; compressed
by zlib, lzma or lz4.

No number of the file makes memory before the bytes that it counts are known to be there.
Format: "VTK XML file formats", https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html
"""

import binascii
import lzma
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import FileFormatError
from surfmesh.io.expansion import Expansion
from surfmesh.io.lz4_block import decompressed as lz4_decompressed

NUMBERS = {
    "Int8": "i1", "UInt8": "u1", "Int16": "i2", "UInt16": "u2", "Int32": "i4", "UInt32": "u4",
    "Int64": "i8", "UInt64": "u8", "Float32": "f4", "Float64": "f8",
}  # fmt: skip
LZMA_MEMORY = 256 << 20  # bytes of its dictionary; VTK's largest level needs 65 MB


@dataclass(frozen=True)
class VtkArrays:
    """How the arrays of one file are written, and the bytes of those that are appended."""

    path: Path
    order: str  # of bytes, as numpy has it: < or >
    header: np.dtype  # of the sizes before the bytes of an array
    unpack: Callable[[bytes, int], bytes] | None  # a block to so many bytes; None: as it is
    appended: bytes
    appended_as_text: bool  # in base64
    expansion: Expansion

    @classmethod
    def of(cls, path: Path, root: Element, appended: bytes, size: int) -> "VtkArrays":
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
