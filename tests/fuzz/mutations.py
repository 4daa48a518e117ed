"""Damaged copies of good files: each is a function of the file, the seed and a number alone.

A mutant has one change, or two or three. Some changes know nothing of the format (bits, blocks,
truncation, extreme numbers), some know its text (lines, words, keywords), some keep the outside
whole and change what is inside: the model in a .3mf, the JSON of a .glb, the record of groups.
"""

import base64
import contextlib
import io
import json
import re
import struct
import zipfile
from collections.abc import Callable, Sequence
from random import Random
from typing import Any, NamedTuple

EXTREMES = (
    b"0", b"-1", b"1", b"2", b"255", b"65536", b"2147483647", b"2147483648", b"-2147483648",
    b"4294967295", b"4294967296", b"9223372036854775807", b"9223372036854775808",
    b"18446744073709551616", b"1e308", b"-1e308", b"1e-320", b"1e400", b"nan", b"inf", b"-inf",
    b"1" + b"0" * 400, b"1" + b"0" * 5000, b"0x10", b"1_000", b"1.5", b"-0", b"+3", b"1e5", b"",
    b"\xd9\xa3", b"true", b"null", b"3.0000000000000004",
)  # fmt: skip
BINARY = (
    "ff", "00", "80", "7f", "ffff", "ff7f", "ffffffff", "ffffff7f", "00000080", "0000c07f",
    "0000807f", "ffffffffffffffff", "ffffffffffffff7f", "0000000000000080", "000000000000f07f",
    "000000000000f87f", "00e1f50500000000", "00000000",
)  # fmt: skip
ODD_TEXT = (
    b"\0", b"\x1b[2J", b"\r", b"\n", b"\n\n", b"\t", b" ", b"\xef\xbb\xbf", b"\xff\xfe",
    b"\xe2\x80\xa8", b"\x85", b"\xc3\x28", b"#", b"\"", b"'", b"<", b">", b"&", b"&amp;", b"{",
    b"[", b"*", b"$", b",", b"/", b"%", b"\\", b"-", b"(" * 3000, b"[" * 3000, b"A" * 3000,
)  # fmt: skip
ODD_VALUES: tuple[Any, ...] = (
    None, True, 0, -1, 3, 1.5, -0.5, 2**31, 2**63, 10**400, 1e308, "", "x", "nan", "\x1b[2J", [],
    {}, [[]], [1, "a"], [[1, 2], [3]], {"a": []}, "y" * 3000,
)  # fmt: skip

NUMBER = re.compile(rb"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
WHOLE = re.compile(rb"(?<![\w.])\d+(?![\w.])")
TAG = re.compile(rb"<(/?)([A-Za-z_:][\w:.]*)([^<>]*)>")
ATTRIBUTE = re.compile(rb"([A-Za-z_:][\w:.]*)=([\"'])(.*?)\2")

# words of the formats, for a word of the file to be put in the place of another
KEYWORDS: dict[str, bytes] = {
    ".vtu": b"VTKFile UnstructuredGrid Piece Points Cells DataArray PointData CellData FieldData "
    b"AppendedData ascii binary appended base64 raw Int8 UInt8 Int32 Int64 UInt64 Float32 Float64 "
    b"String connectivity offsets types LittleEndian BigEndian vtkZLibDataCompressor UInt32",
    ".pvtu": b"VTKFile PUnstructuredGrid Piece Source PPoints PCells PDataArray PPointData "
    b"PCellData FieldData DataArray GlobalPointIds GlobalCellIds ascii Int32 Float64 ../",
    ".vtp": b"VTKFile PolyData Piece Points Polys Strips Verts Lines DataArray ascii binary "
    b"appended base64 raw Int32 Int64 UInt64 Float32 Float64 connectivity offsets NumberOfPolys",
    ".stl": b"solid facet normal outer loop vertex endloop endfacet endsolid",
    ".obj": b"v vn vt f g o s l p usemtl mtllib # face_id call surfmesh-groups -1 1//1 1/1/1",
    ".ply": b"ply format ascii binary_little_endian binary_big_endian 1.0 comment element vertex "
    b"face edge property list uchar char short ushort int uint float double int8 float64 x y z "
    b"vertex_indices face_id alpha size end_header",
    ".off": b"OFF COFF NOFF STOFF 4OFF nOFF BINARY # 3 4 5",
    ".msh": b"$MeshFormat $EndMeshFormat $PhysicalNames $Entities $Nodes $EndNodes $Elements "
    b"$EndElements $NodeData $ElementData $Periodic $Comments 2.2 4.0 4.1 4.2 1 2 3 8 9 15",
    ".inp": b"*NODE *ELEMENT *ELSET *NSET *INCLUDE *HEADING *PART *END *SYSTEM TYPE=S3 TYPE=STRI65 "
    b"TYPE=C3D4 GENERATE ELSET=a NSET=b INPUT=/etc/passwd **",
    ".bdf": b"GRID GRID* CTRIA3 CTRIA6 CQUAD4 CTETRA ENDDATA BEGIN BULK CEND SET THRU INCLUDE "
    b"$HMNAME COMP + * CORD2R 1.5-3 1.5D+3",
    ".xdmf": b"Xdmf Domain Grid Topology Geometry DataItem Attribute Information Triangle "
    b"Triangle_6 Quadrilateral Mixed XYZ XY X_Y_Z HDF XML Binary Int Float UInt Char",
    ".3mf": b"model resources object mesh vertices vertex triangles triangle components component "
    b"build item metadata basematerials base t:triangleset t:refrange millimeter meter inch",
    ".glb": b"",
    ".med": b"",
    "step": b"CARTESIAN_POINT DIRECTION AXIS2_PLACEMENT_3D ADVANCED_FACE EDGE_CURVE VERTEX_POINT "
    b"PLANE CYLINDRICAL_SURFACE B_SPLINE_SURFACE_WITH_KNOTS CIRCLE LINE CLOSED_SHELL .T. .F. $ * "
    b"#1 #10 #999999 ENDSEC; DATA; HEADER; END-ISO-10303-21;",
    "iges": b"100 102 104 106 108 110 112 114 116 118 120 122 124 126 128 141 142 143 144 186 314 "
    b"402 406 408 502 504 508 510 514 , ;",
    "brep": b"Locations Curve2ds Curves Polygon3D PolygonOnTriangulations Surfaces Triangulations "
    b"TShapes Ve Ed Wi Fa Sh So CS Co +1 -1 *",
    "surface": b"name description x y z parameters domain loops sizing facts u v = [sizing] "
    b"[facts] [domain] [parameters] sin(u) u/v sqrt(u) log(v) 1/0 Piecewise lambda pi u**v "
    b"abs(u)**0.1",
    "domain": b"name outer holes constraints points crossings merge simplify sizing near far reach "
    b"facts split refuse = [sizing] [sizing.distance] [[0,0],[1,1],[0,1],[1,0]]",
    "drawing": b"svg path rect circle ellipse line polyline polygon g use defs transform M L H V C "
    b"S Q T A Z m l a z viewBox width height style matrix(0,0,0,0,0,0) scale(1e300) rotate(nan)",
    "sizes": b"sizes chord size min_size max_size angle growth anisotropy volume gap sources near "
    b"lines ball box radius width axis reach = [sizes.\"*\"] [[sizes.\"*\".sources]]",
}  # fmt: skip
KEYWORDS[".pvtu piece"] = KEYWORDS[".vtu"] + b" GlobalPointIds GlobalCellIds vtkGhostType"
XML = (".vtu", ".vtp", ".pvtu", ".pvtu piece", ".xdmf", ".3mf", "drawing")
BINARY_ONLY = (".med", ".glb")
OF_MODELS = (
    "extreme_number", "changed_count", "line_dropped", "line_doubled", "keyword", "odd_text",
    "attribute", "attribute", "tag_dropped", "tag_doubled", "nested", "entities", "other_bytes",
    "dropped", "lines_mixed",
)  # fmt: skip


Change = Callable[[bytes, bytes, str, Random], bytes]
CHANGES: dict[str, Change] = {}


def change(function: Change) -> Change:
    CHANGES[function.__name__] = function
    return function


class Mutant(NamedTuple):
    """The bytes, which of the originals they came from, and the names of the changes."""

    data: bytes
    source: int
    changes: tuple[str, ...]


def mutant(originals: Sequence[bytes], kind: str, seed: int, number: int) -> Mutant:
    """Mutant ``number`` of the files of one kind; the originals take turns."""
    random = Random(f"{kind} {seed} {number}")
    source = number % len(originals)
    data, other = originals[source], random.choice(originals)
    if random.random() < 0.12:
        return Mutant(truncated(data, random), source, ("truncated",))
    done = []
    for _ in range(random.choice((1, 1, 1, 2, 3))):
        name = random.choice(_changes(kind))
        with contextlib.suppress(Exception):  # where the file has not what the change looks for
            data = CHANGES[name](data, other, kind, random)
            done.append(name)
    if not done:
        return Mutant(bits(data, other, kind, random), source, ("bits",))
    return Mutant(data, source, tuple(done))


def truncated(data: bytes, random: Random) -> bytes:
    """Cut anywhere, often near the end, where it is easily overlooked."""
    if random.random() < 0.5:
        return data[: -random.randrange(1, min(len(data), 60) + 1)]
    return data[: random.randrange(len(data))]


def _changes(kind: str) -> list[str]:
    """Names of the changes that suit a kind of file, the likelier ones twice."""
    found = [
        "bits",
        "other_bytes",
        "dropped",
        "doubled",
        "swapped",
        "spliced",
        "extreme_bytes",
        "emptied",
    ]
    if kind not in BINARY_ONLY:
        found += [
            "extreme_number",
            "extreme_number",
            "changed_count",
            "changed_count",
            "line_dropped",
            "line_doubled",
        ]
        found += ["lines_mixed", "keyword", "keyword", "odd_text", "words_swapped", "record"]
    if kind in XML:
        found += ["attribute", "attribute", "tag_dropped", "nested", "entities", "tag_doubled"]
    if kind in (".vtu", ".vtp", ".pvtu", ".pvtu piece"):
        found += ["groups_array", "base64_block"]
    if kind == ".3mf":
        found = ["bits", "extreme_bytes", "dropped", "members", "members"] + ["model"] * 12
    if kind == ".glb":
        found += ["json_chunk"] * 8 + ["buffer"] * 3
    if kind == ".med":
        found += ["hdf5"] * 8
    if kind in ("surface", "domain", "sizes"):
        found += ["toml_value", "toml_value", "toml_value", "toml_key", "deep_toml"]
    if kind == ".xdmf":
        found += ["information", "information"]
    return found


# ---- changes that know nothing of the format: (data, other, kind, random) -> data


@change
def bits(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    changed = bytearray(data)
    for _ in range(random.choice((1, 1, 2, 8, 40))):
        changed[random.randrange(len(changed))] ^= 1 << random.randrange(8)
    return bytes(changed)


@change
def other_bytes(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    changed = bytearray(data)
    for _ in range(random.choice((1, 2, 5, 30))):
        changed[random.randrange(len(changed))] = random.randrange(256)
    return bytes(changed)


def _span(data: bytes, random: Random) -> tuple[int, int]:
    start = random.randrange(len(data))
    return start, min(len(data), start + random.choice((1, 2, 4, 8, 40, 400, 4000)))


@change
def dropped(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    start, end = _span(data, random)
    return data[:start] + data[end:]


@change
def doubled(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    start, end = _span(data, random)
    times = random.choice((2, 2, 3, 20))
    return data[:start] + data[start:end] * times + data[end:]


@change
def swapped(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    a, b, c, d = sorted(random.randrange(len(data) + 1) for _ in range(4))
    return data[:a] + data[c:d] + data[b:c] + data[a:b] + data[d:]


@change
def spliced(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    """The beginning of one file and the end of another."""
    return data[: random.randrange(len(data))] + other[random.randrange(len(other)) :]


@change
def extreme_bytes(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    pattern = bytes.fromhex(random.choice(BINARY))
    pattern = pattern[::-1] if random.random() < 0.3 else pattern
    at = random.randrange(len(data))
    if random.random() < 0.5:  # numbers mostly stand at multiples of four bytes
        at -= at % 4
    return data[:at] + pattern + data[at + len(pattern) :]


@change
def emptied(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    start, end = _span(data, random)
    return data[:start] + bytes([random.choice((0, 32, 255))]) * (end - start) + data[end:]


# ---- changes of text


def _match(pattern: re.Pattern[bytes], data: bytes, random: Random) -> re.Match[bytes]:
    """One of the matches; half of the time one near the beginning, where heads and counts are."""
    found = list(pattern.finditer(data))
    if random.random() < 0.5:
        found = found[:40]
    return random.choice(found)


def _put(data: bytes, found: re.Match[bytes], text: bytes) -> bytes:
    return data[: found.start()] + text + data[found.end() :]


@change
def extreme_number(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    return _put(data, _match(NUMBER, data, random), random.choice(EXTREMES))


@change
def changed_count(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    found = _match(WHOLE, data, random)
    value = int(found[0][:300])
    near = (value + 1, max(value - 1, 0), 2 * value, value // 2, 1000 * value, -value)
    return _put(data, found, str(random.choice(near)).encode())


def _lines(data: bytes, random: Random) -> tuple[list[bytes], int, int]:
    lines = data.splitlines(keepends=True)
    start = random.randrange(len(lines))
    return lines, start, min(len(lines), start + random.choice((1, 1, 2, 10)))


@change
def line_dropped(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    lines, start, end = _lines(data, random)
    return b"".join(lines[:start] + lines[end:])


@change
def line_doubled(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    lines, start, end = _lines(data, random)
    return b"".join(lines[:end] + lines[start:end] * random.choice((1, 1, 5)) + lines[end:])


@change
def lines_mixed(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    lines, start, _ = _lines(data, random)
    part = lines[start : start + random.choice((2, 5, 50))]
    random.shuffle(part)
    return b"".join(lines[:start] + part + lines[start + len(part) :])


WORD = re.compile(rb"[^\s,=\"'<>()]+")


@change
def keyword(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    keywords = KEYWORDS[kind].split()
    return _put(data, _match(WORD, data, random), random.choice(keywords))


@change
def words_swapped(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    word = _match(WORD, data, random)[0]
    return _put(data, _match(WORD, data, random), word)


@change
def odd_text(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    at = random.randrange(len(data))
    return data[:at] + random.choice(ODD_TEXT) + data[at:]


# ---- changes of XML


@change
def attribute(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    found = _match(ATTRIBUTE, data, random)
    if random.random() < 0.2:
        return _put(data, found, b"")
    words = (*EXTREMES, *KEYWORDS[kind].split())
    name = found[1] if random.random() < 0.9 else random.choice(KEYWORDS[kind].split())
    return _put(data, found, name + b'="' + random.choice(words) + b'"')


@change
def tag_dropped(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    return _put(data, _match(TAG, data, random), b"")


def _element(data: bytes, random: Random) -> tuple[int, int]:
    """From an opening tag to the next closing one of its name, or the tag alone."""
    found = _match(TAG, data, random)
    end = data.find(b"</" + found[2] + b">", found.end())
    return found.start(), found.end() if end < 0 else end + len(found[2]) + 3


@change
def tag_doubled(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    start, end = _element(data, random)
    return data[:end] + data[start:end] * random.choice((1, 1, 3)) + data[end:]


@change
def nested(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    start, end = _element(data, random)
    depth = random.choice((1, 2, 100, 5000))
    name = random.choice(KEYWORDS[kind].split()).partition(b"(")[0] or b"a"
    around = b"<" + name + b">", b"</" + name + b">"
    return data[:start] + around[0] * depth + data[start:end] + around[1] * depth + data[end:]


@change
def entities(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    """Entities that grow, or that name a file."""
    steps = "".join(f'<!ENTITY e{n} "{f"&e{n - 1};" * 10}">' for n in range(1, 10))
    growing = f'<!DOCTYPE a [<!ENTITY e0 "0 0 0 ">{steps}]>'.encode()
    named = b'<!DOCTYPE a [<!ENTITY e9 SYSTEM "file:///etc/hostname">]>'
    head = re.match(rb"\s*(<\?.*?\?>)?", data, re.DOTALL)
    at = random.choice([*TAG.finditer(data)]).end()
    body = data[head.end() : at] + b"&e9;" + data[at:] if at > head.end() else data[head.end() :]
    return head[0] + random.choice((growing, named)) + body


@change
def base64_block(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    """The head of a block of numbers (bytes, blocks, sizes of these) in base64, made extreme."""
    found = _match(re.compile(rb"(?:[A-Za-z0-9+/]{4}){6,}(?:[A-Za-z0-9+/=]{4})"), data, random)
    block = bytearray(base64.b64decode(found[0][:24]))
    at = 4 * random.randrange(len(block) // 4)
    pattern = bytes.fromhex(random.choice(BINARY))[: len(block) - at]
    block[at : at + len(pattern)] = pattern
    head = base64.b64encode(bytes(block))
    return data[: found.start()] + head + data[found.start() + len(head) :]


# ---- changes of what is inside, with the outside whole


def changed_value(value: Any, random: Random) -> Any:
    """A JSON value with one change somewhere: odd, left out, doubled, nested, renamed."""
    places: list[tuple[Any, Any]] = []

    def collect(held: Any) -> None:
        entries = held.items() if isinstance(held, dict) else enumerate(held)
        for key, inner in entries:
            places.append((held, key))
            if isinstance(inner, (dict, list)):
                collect(inner)

    collect(value)
    held, key = random.choice(places)
    how = random.randrange(8)
    if how == 0:
        del held[key]
    elif how == 1 and isinstance(held, list):
        held.insert(key, held[key])
    elif how == 1:
        held["odd"] = held.pop(key)
    elif how == 2:
        for _ in range(random.choice((1, 400))):
            held[key] = [held[key]]
    elif how == 3 and isinstance(held[key], (int, float)):
        held[key] = held[key] + random.choice((1, -1, 2**31, 0.5, 1e300))
    else:
        held[key] = random.choice(ODD_VALUES)
    return value


MARK = b"surfmesh-groups "


@change
def record(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    """The record of groups that stands in comments, changed and of the right length again."""
    lines = data.split(b"\n")
    own = [number for number, line in enumerate(lines) if MARK in line]
    text = b"".join(lines[number].partition(MARK)[2].strip() for number in own)
    record = changed_value(json.loads(text.partition(b":")[2]), random)
    written = json.dumps(record, separators=(",", ":")).replace(" ", "\\u0020").encode()
    before = lines[own[0]].partition(MARK)[0] + MARK
    lines[own[0] : own[-1] + 1] = [before + str(len(written)).encode() + b":" + written]
    return b"\n".join(lines)


@change
def information(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    from xml.sax.saxutils import quoteattr, unescape

    found = re.search(rb"Value=('(.*?)'|\"(.*?)\")", data, re.DOTALL)
    text = unescape((found[2] or found[3]).decode(), {"&quot;": '"'})
    return _put(
        data, found, f"Value={quoteattr(_json(changed_value(json.loads(text), random)))}".encode()
    )


@change
def groups_array(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    """The bytes of the record of groups in an array that is written as text."""
    pattern = rb'(<DataArray [^>]*Name="surfmesh_groups"[^>]*"ascii"[^>]*>)([\s\d]*)</DataArray>'
    found = re.search(pattern, data)
    record = json.loads(bytes(map(int, found[2].split())))
    text = _json(changed_value(record, random)).encode()
    array = re.sub(rb'NumberOfTuples="\d+"', b'NumberOfTuples="%d"' % len(text), found[1])
    return _put(data, found, array + b" ".join(b"%d" % c for c in text) + b"</DataArray>")


def _json(value: Any) -> str:
    return json.dumps(value, separators=(",", ":"))


def _chunks(data: bytes) -> tuple[bytes, bytes]:
    size = struct.unpack_from("<I", data, 12)[0]
    return data[20 : 20 + size], data[28 + size :]


def _glb(text: bytes, body: bytes) -> bytes:
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sIII4s", b"glTF", 2, 28 + len(text) + len(body), len(text), b"JSON")
    return head + text + struct.pack("<I4s", len(body), b"BIN\0") + body


@change
def json_chunk(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    text, body = _chunks(data)
    content = json.loads(text)
    for _ in range(random.choice((1, 1, 3))):
        content = changed_value(content, random)
    return _glb(_json(content).encode(), body)


@change
def buffer(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    text, body = _chunks(data)
    changes = (bits, extreme_bytes, dropped, emptied)
    return _glb(text, random.choice(changes)(body, body, kind, random))


@change
def members(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    """Members of an archive: away, twice, under another name, empty, large."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        held = [(name, archive.read(name)) for name in archive.namelist()]
    at, how = random.randrange(len(held)), random.randrange(6)
    name, content = held[at]
    if how == 0:
        del held[at]
    elif how == 1:
        held.append((name, content[: len(content) // 2]))
    elif how == 2:
        names = ("../../up.model", "/abs", "3D/3DMODEL.MODEL", "a" * 300, "3D/other.model")
        held[at] = (random.choice(names), content)
    elif how == 3:
        held[at] = (name, b"")
    elif how == 4:
        held[at] = (name, content + b" " * 30_000_000)
    else:
        held.append(("3D/more.model", content))
    return _zipped(held)


@change
def model(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    """The XML inside of an archive changed as other XML is; its record of groups as JSON."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        held = [(name, archive.read(name)) for name in archive.namelist()]
    at = next(n for n, (name, _) in enumerate(held) if name.endswith(".model"))
    name, content = held[at]
    found = re.search(rb's:groups">(.*?)</metadata>', content)
    if found and random.random() < 0.25:
        record = changed_value(json.loads(found[1]), random)
        content = content[: found.start(1)] + _json(record).encode() + content[found.end(1) :]
    else:
        content = CHANGES[random.choice(OF_MODELS)](content, content, kind, random)
    held[at] = (name, content)
    return _zipped(held)


def _zipped(held: list[tuple[str, bytes]]) -> bytes:
    import warnings

    buffer = io.BytesIO()
    with warnings.catch_warnings(), zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        warnings.simplefilter("ignore")  # of a name that comes twice
        for name, content in held:
            archive.writestr(zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0)), content,
                             zipfile.ZIP_DEFLATED)  # fmt: skip
    return buffer.getvalue()


@change
def hdf5(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    """One dataset, attribute or group of an HDF5 file: other values, another shape, away."""
    import h5py
    import numpy as np

    buffer = io.BytesIO(data)
    with h5py.File(buffer, "r+") as file:
        names: list[str] = []
        file.visit(names.append)
        item = file[random.choice(sorted(names))]
        how = random.randrange(5)
        if how == 0:
            del file[item.name]
        elif how == 1 and len(item.attrs):
            attribute = random.choice(sorted(item.attrs))
            item.attrs[attribute] = random.choice((0, -1, 2**31 - 1, 2**40, 1.5, "x", b""))
        elif isinstance(item, h5py.Dataset) and item.size and item.shape:
            values = item[()]
            if how == 2:
                shorter = values[: len(values) // 2]
                name = item.name
                del file[name]
                file[name] = shorter
            elif values.dtype.kind in "iuf":
                limits = (0, -1, 1, 127) if values.dtype.kind != "f" else (np.nan, np.inf, 1e308, 0)
                values.reshape(-1)[random.randrange(values.size)] = random.choice(limits)
                item[()] = values
        else:
            parent, _, last = item.name.rpartition("/")
            file.move(item.name, f"{parent}/odd_{last}")
    return buffer.getvalue()


# ---- changes of TOML

ODD_TOML = (
    b"[]", b"{}", b"true", b'""', b'"x"', b"nan", b"inf", b"-inf", b"-1", b"0", b"1e308", b"1e-320",
    b"1979-05-27", b"07:32:00", b'[1, [2, 3], "a"]', b"[[1, 2], [3]]", b"[[0, 0], [1, 0], [0]]",
    b"[[[0, 0], [1, 0], [1, 1]]]", b"{a = 1}", b"0xffff", b"1" + b"0" * 400, b'"1" # x', b"[[]]",
    b"'''\n'''", b"1" + b"0" * 4400, b'[0, "2*pi"]', b"[nan, nan]", b'"u\\u0000"',
    b'"\\u001b[2J"', b'"sin("', b'"' + b"sin(" * 90 + b"u" + b")" * 90 + b'"',
    b'"u' + b"+u" * 900 + b'"', b'"' + b"(" * 300 + b"u" + b")" * 300 + b'"', b'"9**9**9**9"',
    b'"1/u"', b'"abs(u)**0.1"', b'"u*1e300*1e300"', b'"sqrt(-1-u**2)"',
)  # fmt: skip
ENTRY = re.compile(rb"^(\s*[\w.\"*-]+\s*=\s*)(.*)$", re.MULTILINE)


@change
def toml_value(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    found = _match(ENTRY, data, random)
    return _put(data, found, found[1] + random.choice(ODD_TOML))


@change
def toml_key(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    """A key under another name, in quotes, with dots, or given twice."""
    found = _match(ENTRY, data, random)
    key, _, value = found[0].partition(b"=")
    names = (
        b"odd",
        b'"\\u001b"',
        key.strip() + b".x",
        b'""',
        random.choice(KEYWORDS[kind].split()),
    )
    if random.random() < 0.3:
        return _put(data, found, found[0] + b"\n" + found[0])
    return _put(data, found, random.choice(names) + b" =" + value)


@change
def deep_toml(data: bytes, other: bytes, kind: str, random: Random) -> bytes:
    depth = random.choice((50, 1500, 30_000))
    found = _match(ENTRY, data, random)
    lists = b"[" * depth + b"]" * depth
    tables = b"{a=" * depth + b"1" + b"}" * depth
    dotted = b".".join([b"a"] * depth)
    if random.random() < 0.3:
        return data + b"\n[" + dotted + b"]\n"
    return _put(data, found, found[1] + random.choice((lists, tables)))
