"""Our own reader of .vtu and .vtp gives what VTK's gives, for every way in which VTK writes."""

import base64
import itertools
import lzma
import struct
import zlib
from dataclasses import replace

import numpy as np
import pytest
import pyvista
import vtkmodules.vtkIOXML as vtk_xml

from surfmesh.errors import FileFormatError
from surfmesh.io import read
from surfmesh.io.lz4_block import decompressed
from surfmesh.io.vtk_xml_reading import read_vtk

WRITERS = {".vtu": vtk_xml.vtkXMLUnstructuredGridWriter, ".vtp": vtk_xml.vtkXMLPolyDataWriter}
WAYS = list(itertools.product(("Ascii", "Binary", "Appended"), ("None", "ZLib", "LZ4", "LZMA")))


@pytest.mark.parametrize("suffix", WRITERS)
@pytest.mark.parametrize(("mode", "compressor"), WAYS)
def test_every_way_of_writing(suffix, mode, compressor, saddle, tmp_path):
    path = saddle.save(tmp_path / f"saddle{suffix}")
    content, wanted = pyvista.read(path), read(path)
    for header, order, in_base64 in ((32, "Little", 0), (64, "Big", 1), (64, "Little", 1)):
        writer = WRITERS[suffix]()
        writer.SetInputData(content)
        writer.SetFileName(str(path))
        getattr(writer, f"SetDataModeTo{mode}")()
        getattr(writer, f"SetCompressorTypeTo{compressor}")()
        getattr(writer, f"SetHeaderTypeToUInt{header}")()
        getattr(writer, f"SetByteOrderTo{order}Endian")()
        writer.SetEncodeAppendedData(in_base64)
        writer.SetBlockSize(4096 if compressor == "LZMA" else 256)
        assert writer.Write()
        found = read(path)
        for name in ("points", "triangles", "uv_points", "sizes", "face_ids"):
            assert np.array_equal(getattr(found, name), getattr(wanted, name)), name


@pytest.mark.parametrize("kind", ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f4", "f8"])
@pytest.mark.parametrize("binary", [True, False])
def test_every_type_of_number(kind, binary, saddle, tmp_path):
    faces = np.column_stack((np.full(len(saddle.triangles), 3), saddle.triangles))
    data = pyvista.PolyData(saddle.points.astype("f4"), faces.ravel())
    data.cell_data["face_id"] = saddle.face_ids.astype(kind)
    for content, suffix in ((data, ".vtp"), (data.cast_to_unstructured_grid(), ".vtu")):
        content.save(tmp_path / f"part{suffix}", binary=binary)
        found = read(tmp_path / f"part{suffix}")
        assert found.face_ids.tolist() == saddle.face_ids.tolist()
        assert (found.points == saddle.points.astype("f4")).all()


def test_pieces_come_one_after_the_other(saddle, tmp_path):
    content = pyvista.read(saddle.save(tmp_path / "whole.vtu"))
    writer = WRITERS[".vtu"]()
    writer.SetInputData(content)
    writer.SetFileName(str(tmp_path / "pieces.vtu"))
    writer.SetNumberOfPieces(3)
    assert writer.Write()
    assert (tmp_path / "pieces.vtu").read_bytes().count(b"<Piece") == 3
    found, wanted = read(tmp_path / "pieces.vtu"), pyvista.read(tmp_path / "pieces.vtu")
    assert (found.points == wanted.points).all()
    assert (found.triangles.ravel() == wanted.cell_connectivity).all()
    assert len(found.triangles) == 3 * len(saddle.triangles)  # the writer repeats them


@pytest.mark.parametrize(
    "content",
    [pyvista.Plane(), pyvista.Line(), pyvista.Sphere().strip(), pyvista.PolyData([0.0, 0.0, 0.0])],
)
def test_what_is_not_triangles_is_refused(content, tmp_path):
    content.save(tmp_path / "part.vtp")
    with pytest.raises(FileFormatError, match=r"not triangles|no triangles"):
        read(tmp_path / "part.vtp")


def arrays(**changes):
    """A tetrahedron as text: type, components and numbers of each array."""
    held = {
        "Points": ("Float64", 3, "1 1 1 1 -1 -1 -1 1 -1 -1 -1 1"),
        "connectivity": ("Int64", 1, "0 1 2 0 2 3 0 3 1 1 3 2"),
        "offsets": ("Int64", 1, "3 6 9 12"),
        "types": ("UInt8", 1, "5 5 5 5"),
        "face_id": ("Int32", 1, "0 1 2 3"),
    }
    return held | changes


def grid(held, points="4", cells="4", written=None, root="", behind=""):
    def array(name):
        kind, width, text = held[name]
        form, content = (written or {}).get(name, ('format="ascii"', text))
        head = f'type="{kind}" Name="{name}" NumberOfComponents="{width}" {form}'
        return f"<DataArray {head}>{content}</DataArray>"

    cell_arrays = "".join(map(array, ("connectivity", "offsets", "types")))
    return (
        f'<VTKFile type="UnstructuredGrid" {root}><UnstructuredGrid>'
        f'<Piece NumberOfPoints="{points}" NumberOfCells="{cells}"><CellData>'
        f"{array('face_id')}</CellData><Points>{array('Points')}</Points>"
        f"<Cells>{cell_arrays}</Cells></Piece></UnstructuredGrid>{behind}</VTKFile>"
    )


def packed(*numbers):
    return struct.pack(f"<{len(numbers)}I", *numbers)


BINARY = 'format="binary"'
ZLIB = 'compressor="vtkZLibDataCompressor"'
IDS = np.arange(4, dtype="<i4").tobytes()


def binary(data, head=None):
    """face_id in base64; head: of a compressed array, written by itself."""
    text = b"" if head is None else base64.b64encode(head)
    return {"face_id": (BINARY, (text + base64.b64encode(data)).decode())}


GOOD = {
    "text": grid(arrays()),
    "base64": grid(arrays(), written=binary(packed(16) + IDS)),
    "zlib": grid(
        arrays(),
        root=ZLIB,
        written=binary(zlib.compress(IDS), packed(1, 16, 0, len(zlib.compress(IDS)))),
    ),
    "two blocks": grid(
        arrays(),
        root=ZLIB,
        written=binary(
            zlib.compress(IDS[:12]) + zlib.compress(IDS[12:]),
            packed(2, 12, 4, len(zlib.compress(IDS[:12])), len(zlib.compress(IDS[12:]))),
        ),
    ),
    "one number a triangle more": grid(arrays(face_id=("Int32", 1, "0 1 2 3 9"))),
}


@pytest.mark.parametrize("name", GOOD)
def test_good_files_by_hand(name, tmp_path):
    (tmp_path / "part.vtu").write_text(GOOD[name])
    found = read(tmp_path / "part.vtu")
    assert found.face_ids.tolist() == [0, 1, 2, 3] and found.points[1].tolist() == [1, -1, -1]


ONE = zlib.compress(bytes(1 << 20))
MANY = 4000
BAD = {
    "a count beyond the bytes": (
        grid(arrays(), written=binary(packed(2**32 - 1) + IDS)),
        "announced",
    ),
    "blocks beyond the bytes": (
        grid(arrays(), root=ZLIB, written=binary(b"", packed(2**32 - 1, 16, 0))),
        "announced",
    ),
    "a block larger than it says": (
        grid(arrays(), root=ZLIB, written=binary(ONE, packed(1, 16, 0, len(ONE)))),
        "does not unpack to 16",
    ),
    "a block smaller than it says": (
        grid(arrays(), root=ZLIB, written=binary(zlib.compress(IDS), packed(1, 2**31, 0, 20))),
        "would unpack|does not unpack",
    ),
    "gigabytes of zeros": (
        grid(
            arrays(),
            root=ZLIB,
            written=binary(ONE * MANY, packed(MANY, 1 << 20, 0, *[len(ONE)] * MANY)),
        ),
        "would unpack",
    ),
    "a last block larger than the others": (
        grid(arrays(), root=ZLIB, written=binary(b"", packed(1, 16, 17, 9))),
        "last block",
    ),
    "half a number": (grid(arrays(), written=binary(packed(15) + IDS)), "no whole numbers"),
    "no base64": (grid(arrays(), written={"face_id": (BINARY, "!!!!")}), "damaged"),
    "other marks": (grid(arrays(), written={"face_id": (BINARY, "€" * 40)}), "damaged"),
    "another compressor": (
        grid(arrays(), root='compressor="x"', written=binary(IDS)),
        "save with zlib",
    ),
    "another byte order": (grid(arrays(), root='byte_order="x"'), "byte_order"),
    "too many cells": (grid(arrays(), cells="2000000000"), "instead of 2000000000"),
    "too many points": (grid(arrays(), points=str(10**17)), "instead of 1"),
    "a number of points that is none": (grid(arrays(), points="-1"), "no count"),
    "no points": (grid(arrays(), points="0"), "outside 0..-1|points"),
    "a corner that is no point": (
        grid(arrays(connectivity=("Int64", 1, "0 1 2 0 2 3 0 3 1 1 3 4"))),
        "cell 3 has corner 4",
    ),
    "a corner below zero": (
        grid(arrays(connectivity=("Int64", 1, "0 1 2 0 2 3 0 3 1 1 3 -1"))),
        "cell 3 has corner -1",
    ),
    "a corner of 64 bits": (
        grid(arrays(connectivity=("UInt64", 1, f"0 1 2 0 2 3 0 3 1 1 3 {2**64 - 1}"))),
        "cell 3 has corner",
    ),
    "corners between points": (
        grid(arrays(connectivity=("Float32", 1, "0 1 2 0 2 3 0 3 1 1 3 .5"))),
        "whole numbers",
    ),
    "offsets that go back": (grid(arrays(offsets=("Int64", 1, "3 6 3 12"))), "not triangles"),
    "cells of other types": (grid(arrays(types=("UInt8", 1, "5 5 9 5"))), "not triangles"),
    "text for numbers": (grid(arrays(face_id=("Int32", 1, "0 1 2 x"))), "damaged"),
    "numbers beyond their type": (grid(arrays(face_id=("Int8", 1, "0 1 2 300"))), "damaged"),
    "strings": (grid(arrays(face_id=("String", 1, "0 1 2 3"))), "none of numbers"),
    "components without end": (
        grid(arrays(face_id=("Int32", 4294967295, "0 1 2 3"))),
        "times 4294967295",
    ),
    "components that are none": (
        grid(arrays(face_id=("Int32", "1" * 40, "0 1 2 3"))),
        "NumberOfComponents",
    ),
    "an offset outside": (
        grid(arrays(), written={"face_id": ('format="appended" offset="9"', "")}),
        "outside the appended",
    ),
    "appended without underscore": (
        grid(arrays(), behind='<AppendedData encoding="raw">x</AppendedData>'),
        "underscore",
    ),
    "a document type": ("<!DOCTYPE x>" + grid(arrays()), "document type"),
    "half a file": (grid(arrays())[:-20], "XML"),
    "another kind": (
        grid(arrays())
        .replace("<UnstructuredGrid>", "<PolyData>")
        .replace("</UnstructuredGrid>", "</PolyData>"),
        "not a .vtu file",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_damaged_files_by_hand(name, tmp_path, recwarn):
    content, reason = BAD[name]
    path = tmp_path / "part.vtu"
    path.write_text(content, encoding="utf-8")
    with pytest.raises(FileFormatError, match=reason) as caught:
        read(path)
    assert str(caught.value).count(str(path)) == 1 and not recwarn.list


def test_pieces_that_show_the_same_bytes_again_and_again(tmp_path):
    points = np.zeros((5000, 3)).tobytes()
    data = base64.b64encode(packed(len(points)) + points).decode()
    form = {"Points": ('format="appended" offset="0"', "")}
    text = grid(arrays(), points="5000", written=form,
                behind=f'<AppendedData encoding="base64">_{data}</AppendedData>')  # fmt: skip
    piece = text[text.index("<Piece") : text.index("</Unst")]
    (tmp_path / "part.vtu").write_text(text.replace(piece, piece * 1000))
    with pytest.raises(FileFormatError, match="would unpack to more than"):
        read(tmp_path / "part.vtu")


def test_mutations_end_as_one_error(saddle, tmp_path):
    mesh = replace(saddle, surfaces=())
    rng = np.random.default_rng(3)
    for suffix in WRITERS:
        good = mesh.save(tmp_path / f"good{suffix}").read_bytes()
        path = tmp_path / f"bad{suffix}"
        for _ in range(150):
            data = bytearray(good)
            for _ in range(rng.integers(1, 4)):
                at, length = rng.integers(len(data)), rng.integers(1, 20)
                kind = rng.integers(3)
                new = [bytes(rng.integers(32, 127, length, dtype=np.uint8)), b"", b"4294967295"][
                    kind
                ]
                data[at : at + length] = new
            path.write_bytes(data)
            try:
                read(path)
            except FileFormatError as error:
                assert "\n" not in str(error)


def test_lz4_against_known_blocks():
    # literals "abc", then nine bytes copied from three back, then "xyz", by the description
    assert decompressed(b"\x35abc\x03\x00\x30xyz", 15) == b"abcabcabcabcxyz"
    assert decompressed(b"\x1fa\x01\x00\xff\x01\x10b", 1 + 4 + 15 + 256 + 1) == b"a" * 276 + b"b"
    for damaged in (
        b"",
        b"\x35abc\x03",
        b"\x35abc\x04\x00\x30xyz",
        b"\xf0\xff\xff",
        b"\x35abc\x00\x00",
    ):
        with pytest.raises(ValueError):
            decompressed(damaged, 15)


def test_a_dictionary_of_lzma_beyond_its_memory_is_refused(tmp_path, monkeypatch):
    block = lzma.compress(IDS)
    root = 'compressor="vtkLZMADataCompressor"'
    text = grid(arrays(), root=root, written=binary(block, packed(1, 16, 0, len(block))))
    (tmp_path / "part.vtu").write_text(text)
    assert read(tmp_path / "part.vtu").face_ids.tolist() == [0, 1, 2, 3]
    monkeypatch.setattr("surfmesh.io.vtk_xml_arrays.LZMA_MEMORY", 1 << 20)
    with pytest.raises(FileFormatError, match=r"damaged: Memory usage limit"):
        read(tmp_path / "part.vtu")


def test_arrays_that_nobody_asks_for_are_not_unpacked(tmp_path):
    (tmp_path / "part.vtu").write_text(grid(arrays(face_id=("Int32", 1, "nonsense"))))
    assert len(read_vtk(tmp_path / "part.vtu", (), (), ()).cells) == 4
