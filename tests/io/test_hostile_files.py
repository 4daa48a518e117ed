"""Files that want to take the reader down: each is refused in one line, or read in little memory.

Made here, of some hundred bytes each; what they announce is gigabytes, other files or nonsense.
"""

import json
import math
import struct
import sys
import zipfile

import numpy as np
import pytest

from surfmesh.errors import FileFormatError
from surfmesh.io import read
from surfmesh.io.expansion import FREE, LARGEST_RATIO
from surfmesh.quality import check
from surfmesh.view import html_report

CORNERS = ["0 0 0", "1 0 0", "0 1 0"]
TWO_BILLION = 2_000_000_000


def obj(numbers=(0,), corners=CORNERS, record=()):
    lines = [f"# {line}" for line in record] + [f"v {corner}" for corner in corners]
    for number in numbers:
        lines += [f"# face_id {number}", "f 1 2 3"]
    return "\n".join(lines) + "\n"


def record(**fields):
    """Surfmesh's own lines in comments."""
    text = json.dumps({"groups": {}, **fields}, separators=(",", ":"))
    return [f"surfmesh-groups {len(text)}:{text}"]


def bdf(number, name=""):
    lines = [f'$HMNAME COMP{number:20d}"{name}"'] if name else []
    lines += [f"GRID,{i},,{','.join(c.split())}" for i, c in enumerate(CORNERS, 1)]
    return "\n".join([*lines, f"CTRIA3,1,{number},1,2,3", "ENDDATA"])


def xdmf(head="", face_id=0, corners=CORNERS):
    return (
        f'{head}<Xdmf Version="3.0"><Domain><Grid><Topology TopologyType="Triangle"><DataItem>'
        f"0 1 2</DataItem></Topology><Geometry><DataItem>{' '.join(corners)}</DataItem></Geometry>"
        f'<Attribute Name="face_id"><DataItem>{face_id}</DataItem></Attribute>'
        "</Grid></Domain></Xdmf>"
    )


def ply(vertices=3, faces=1, corners="0 1 2", extra=""):
    return (
        f"ply\nformat ascii 1.0\n{extra}element vertex {vertices}\nproperty double x\n"
        f"property double y\nproperty double z\nelement face {faces}\n"
        "property list uchar int vertex_indices\nend_header\n" + "\n".join(CORNERS)
        + f"\n3 {corners}\n"
    )  # fmt: skip


def gltf(**changes):
    """Binary glTF of one triangle, of another program."""
    body = np.array([c.split() for c in CORNERS], "<f4").tobytes() + struct.pack("<3I", 0, 1, 2)
    content = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3},
            {"bufferView": 1, "componentType": 5125, "type": "SCALAR", "count": 3},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 12},
        ],
        "buffers": [{"byteLength": 48}],
    } | changes
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    size = 28 + len(text) + len(body)
    head = struct.pack("<4sII", b"glTF", 2, size) + struct.pack("<I4s", len(text), b"JSON")
    return head + text + struct.pack("<I4s", len(body), b"BIN\0") + body


def threemf(path, model):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("3D/3dmodel.model", model)


DOCTYPE = '<?xml version="1.0"?><!DOCTYPE x [<!ENTITY a SYSTEM "file:///etc/hostname">]>'
ACCESSOR = {"componentType": 5126, "type": "VEC3", "count": 300_000_000}
VIEW = {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 10**9}
BEYOND = [VIEW, {"bufferView": 1, "componentType": 5125, "type": "SCALAR", "count": 3}]

REFUSED = {
    "nan.obj": (obj(corners=["nan 0 0", *CORNERS[1:]]), "numbers have to be finite"),
    "large.obj": (obj(corners=["1e300 0 0", *CORNERS[1:]]), "at most 1e+30"),
    "digits.obj": (obj(["1" * 30]), "too many digits"),
    "runs.obj": (obj().replace("# face_id 0\n", "").replace("f 1 2 3", "f 1 2 4"), "outside 0..2"),
    "runs.off": ("OFF\n# " + record(runs=[[0, 10**10]])[0] + "\n3 1 0\n" + "\n".join(CORNERS)
                 + "\n3 0 1 2\n", "not of 1 triangles"),
    "segments.obj": (obj(record=record(edge_segments=[[0, 99]], edge_ids=[0])), "edge_segments"),
    "edges.obj": (obj(record=record(edge_segments=[[0, 1]])), "1 segments of edges and 0 numbers"),
    "vertices.obj": (obj(record=record(vertex_ids=[7])), "vertex_ids"),
    "colours.obj": (obj(record=record(groups={"face_colours": [[1, 2]]})), "three numbers"),
    "record.obj": (obj(record=record(groups=5)), "the record of groups is damaged"),
    "names.obj": (obj(record=record(groups={"face_names": 5})), "no lists"),
    "unit.obj": (obj(record=record(groups={"unit": {"mm": 1}})), "is no text"),
    "solids.obj": (obj(record=record(solids=[], runs=[[5, 1]])), "solids of 0 faces"),
    "nested.off": ("OFF\n# surfmesh-groups 90000:" + "[" * 90_000 + "\n3 1 0\n"
                   + "\n".join(CORNERS) + "\n3 0 1 2\n", "nested too deep"),
    "minus.off": ("OFF\n-5 1 0\n0 0 0\n3 0 0 0\n", "announces -5"),
    "count.ply": (ply(vertices=10**9), "ends before the last of 1000000000"),
    "faces.ply": (ply(faces=10**15), "ends before the last of 10"),
    "corner.ply": (ply(corners="0 1 99"), "outside 0..2"),
    "polygon.ply": (ply().replace("3 0 1 2", "5 0 1 2 0 1"), "not triangles"),
    "list.ply": (ply().replace("3 0 1 2", "9e9 0 1 2"), "has length 9e"),
    "count.stl": (b" " * 80 + struct.pack("<I", 2**32 - 1), "does not hold the 4294967295"),
    "doctype.xdmf": (xdmf(DOCTYPE), "document type"),
    "deep.xdmf": ("<a>" * 100_000, "nested more than 100 deep"),
    "other.xdmf": (xdmf().replace("<DataItem>", '<DataItem Format="HDF">'), "in another file"),
    "bits.xdmf": (xdmf(face_id=2**40), "no number of 32 bits"),
    "doctype.vtu": (DOCTYPE + "<VTKFile/>", "document type"),
    "doctype.vtp": (DOCTYPE + "<VTKFile/>", "document type"),
    "uri.glb": (gltf(buffers=[{"byteLength": 48, "uri": "../../secret.bin"}]), "is another file"),
    "count.glb": (gltf(accessors=BEYOND), "accessor 0 has count 1000000000"),
    "zeros.glb": (gltf(accessors=[ACCESSOR, BEYOND[1]]), "accessor 0 has count 300000000"),
    "ring.glb": (gltf(nodes=[{"mesh": 0, "children": [0]}]), "in a ring"),
    "shared.glb": (gltf(nodes=[{"mesh": 0, "children": [1]}, {"children": [1]}]), "no tree"),
    "points.glb": (gltf(asset={"extras": {"surfmesh": {"groups": {}, "points": 10**9}}}),
                   "of 1000000000 vertices"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_refused_in_one_line(name, tmp_path, recwarn, capfd):
    content, reason = REFUSED[name]
    path = tmp_path / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(FileFormatError) as caught:
        read(path)
    said = str(caught.value)
    assert reason in said and said.startswith(str(path)) and "\n" not in said
    assert said.count(str(path)) == 1 and len(said) < len(str(path)) + 300
    assert not recwarn.list and capfd.readouterr() == ("", "")


@pytest.mark.parametrize(
    ("name", "content", "labels"),
    [
        ("faces.obj", obj([TWO_BILLION, 7]), ["face 7", "face 2000000000"]),
        ("minus.obj", obj([3, -5]), ["face -5", "face 3"]),
        ("property.bdf", bdf(TWO_BILLION), ["face 1999999999"]),
        ("named.bdf", bdf(TWO_BILLION, "skin"), ["skin"]),
        ("faces.xdmf", xdmf(face_id=TWO_BILLION), ["face 2000000000"]),
    ],
)
def test_numbers_of_ten_digits_are_counted_anew_and_stay_in_the_names(
    name, content, labels, tmp_path
):
    path = tmp_path / name
    path.write_text(content)
    mesh = read(path)
    assert [mesh.face_name(face) for face in range(len(labels))] == labels
    assert sorted(set(mesh.face_ids.tolist())) == list(range(len(labels)))
    assert any("they are counted from 0 here" in warning for warning in mesh.warnings)
    html_report(mesh, tmp_path / "page.html", report=check(mesh))


def test_solids_and_edges_are_counted_anew_too(tmp_path):
    held = record(runs=[[0, 1]], solids=[[TWO_BILLION, -1]], edge_segments=[[0, 1]], edge_ids=[-7])
    (tmp_path / "part.obj").write_text(obj(record=held))
    mesh = read(tmp_path / "part.obj")
    assert mesh.solid_ids.tolist() == [[0, -1]] and mesh.edge_ids.tolist() == [0]
    assert mesh.groups.solid_label(0) == "solid 2000000000"
    assert mesh.groups.edge_label(0) == "edge -7"
    check(mesh)


def test_a_name_of_a_number_that_no_face_has_makes_no_table(tmp_path):
    (tmp_path / "part.bdf").write_text(
        f'$HMNAME COMP{TWO_BILLION:20d}"unused"\n$HMNAME COMP{1:20d}"skin"\n' + bdf(1)
    )
    mesh = read(tmp_path / "part.bdf")
    assert mesh.groups.face_names == ("skin",)


def test_points_of_gmsh_that_are_numbered_far_apart(tmp_path, tetrahedron):
    from dataclasses import replace

    path = tmp_path / "part.msh"
    replace(tetrahedron, vertex_ids=[0, 3]).save(path)
    data = path.read_bytes()
    tag = struct.pack("<i", 2)
    nodes = data.index(b"$Nodes")
    entity = data.index(struct.pack("<3i", 0, 2, 0), nodes) + 4
    path.write_bytes(data[:entity] + struct.pack("<i", TWO_BILLION) + data[entity + len(tag) :])
    found = read(path)
    assert found.vertex_ids is None or len(found.vertex_ids) <= 2


def test_elements_of_xml_without_end(tmp_path, monkeypatch):
    monkeypatch.setattr("surfmesh.io.xml_reading.MOST_ELEMENTS", 100)
    (tmp_path / "part.xdmf").write_text("<a>" + "<b/>" * 100 + "</a>")
    with pytest.raises(FileFormatError, match="more than 100 XML elements"):
        read(tmp_path / "part.xdmf")


def test_small_archives_of_gigabytes(tmp_path):
    path = tmp_path / "bomb.3mf"
    threemf(path, "<a>" + " " * (FREE + LARGEST_RATIO * 50_000))
    with pytest.raises(FileFormatError, match=r"more than 40 times its \d+ bytes and 32 MB"):
        read(path)
    data = bytearray(path.read_bytes())  # the same, announced as little
    for signature, place in ((b"PK\1\2", 24), (b"PK\3\4", 22)):
        at = data.rindex(signature) + place
        data[at : at + 4] = struct.pack("<I", 1000)
    path.write_bytes(data)
    with pytest.raises(FileFormatError):
        read(path)


def test_the_ratio_is_far_above_that_of_meshes(tmp_path):
    from surfmesh.result.surface_mesh import SurfaceMesh

    side = 100  # a flat grid of whole numbers is packed best
    x, y = (c.ravel() for c in np.meshgrid(np.arange(side + 1.0), np.arange(side + 1.0)))
    corner = np.arange(side * (side + 1)).reshape(side, side + 1)[:, :-1].ravel()
    square = corner[:, None] + [0, 1, side + 2, 0, side + 2, side + 1]
    mesh = SurfaceMesh(points=np.column_stack((x, y, 0 * x)), triangles=square.reshape(-1, 3))
    path = mesh.save(tmp_path / "grid.3mf")
    with zipfile.ZipFile(path) as archive:
        size = max(entry.file_size for entry in archive.infolist())
    assert size < LARGEST_RATIO / 4 * path.stat().st_size


@pytest.mark.parametrize(
    ("model", "reason"),
    [
        ("<a>" * 200, "nested more than 100 deep"),
        (DOCTYPE + "<model/>", "document type"),
        ("<model/>", "no meshes in it"),
        ("<model>", "not whole XML"),
    ],
)
def test_models_of_3mf(model, reason, tmp_path):
    threemf(tmp_path / "part.3mf", model)
    with pytest.raises(FileFormatError, match=reason):
        read(tmp_path / "part.3mf")


def test_triangle_sets_of_3mf_hold_each_triangle_once(tmp_path, tetrahedron):
    path = tetrahedron.save(tmp_path / "part.3mf")
    with zipfile.ZipFile(path) as archive:
        model = archive.read("3D/3dmodel.model").decode()
    assert read(path).triangles.tolist() == tetrahedron.triangles.tolist()
    rows = "".join(f'<t:ref index="{k}"/>\n' for k in range(4))
    ranged = '<t:refrange startindex="0" endindex="3"/>'
    threemf(path, model.replace(rows, ranged))
    assert read(path).triangles.tolist() == tetrahedron.triangles.tolist()
    changes = [('index="3"', f'index="{k}"') for k in (2, 9_000_000_000, -5)]
    changes += [(rows, ranged.replace("3", str(k))) for k in (2, 9_000_000_000, -5)]
    for told, changed in changes:
        assert told in model
        threemf(path, model.replace(told, changed))
        with pytest.raises(FileFormatError, match="each triangle once"):
            read(path)
    threemf(path, model.replace('"points":4', '"points":9000000000').replace(
        "&quot;points&quot;:4", "&quot;points&quot;:9000000000"))  # fmt: skip
    with pytest.raises(FileFormatError, match="of 9000000000 vertices and holds 4"):
        read(path)


def test_arrays_of_med_that_were_never_written_or_are_elsewhere(tetrahedron, tmp_path):
    pytest.importorskip("meshio")
    h5py = pytest.importorskip("h5py")
    path = tetrahedron.save(tmp_path / "part.med")
    with h5py.File(path, "r+") as file:
        file.create_dataset("more", (10**9,), "f8", chunks=(1000,))
    with pytest.raises(FileFormatError, match="would unpack to more than"):
        read(path)
    with h5py.File(path, "r+") as file:
        del file["more"]
        file["round"] = h5py.SoftLink("/ENS_MAA")
        file["ENS_MAA"]["up"] = file["ENS_MAA"]
        file["other"] = h5py.ExternalLink("secret.med", "/")
    with pytest.raises(FileFormatError, match="in another file"):
        read(path)


def test_pictures_that_a_file_names_are_not_opened(tmp_path, caplog, capfd):
    (tmp_path / "part.ply").write_text(ply(extra="comment TextureFile ../../etc/passwd\n"))
    (tmp_path / "part.glb").write_bytes(gltf(images=[{"uri": "../../etc/passwd"}]))
    opened = []
    sys.addaudithook(lambda event, held: opened.append(held[0]) if event == "open" else None)
    for name in ("part.ply", "part.glb"):
        assert len(read(tmp_path / name).triangles) == 1
    assert not [place for place in opened if "passwd" in str(place)]
    assert capfd.readouterr() == ("", "")


def test_text_of_ply_is_read_as_its_binary_form(tmp_path):
    text = ply().replace("property list", "property int face_id\nproperty list")
    (tmp_path / "text.ply").write_text(text.replace("\n3 0 1 2", "\n4 3 0 1 2"))
    found = read(tmp_path / "text.ply")
    assert found.face_ids.tolist() == [4] and found.triangles.tolist() == [[0, 1, 2]]
    head = text.partition("end_header")[0].replace("ascii", "binary_big_endian")
    body = np.array([c.split() for c in CORNERS], ">f8").tobytes() + struct.pack(
        ">iB3i", 4, 3, 0, 1, 2
    )
    (tmp_path / "big.ply").write_bytes(head.encode() + b"end_header\n" + body)
    other = read(tmp_path / "big.ply")
    assert other.face_ids.tolist() == [4] and (other.points == found.points).all()
    (tmp_path / "short.ply").write_bytes(head.encode() + b"end_header\n" + body[:-1])
    with pytest.raises(FileFormatError, match="ends before the last"):
        read(tmp_path / "short.ply")


def test_edges_of_ply_by_numbers_that_are_no_vertices_are_passed_over(tmp_path):
    edges = "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header"
    (tmp_path / "part.ply").write_text(ply().replace("end_header", edges) + "0 99999999\n")
    assert len(read(tmp_path / "part.ply").triangles) == 1


@pytest.mark.parametrize("size", [1e29, 1e-30, 1e-100, 1e-300, 0.0])
def test_meshes_of_any_size_are_checked_without_a_warning(size, tetrahedron, tmp_path, recwarn):
    from dataclasses import replace

    path = replace(tetrahedron, points=tetrahedron.points * size).save(tmp_path / "part.off")
    recwarn.clear()
    report = check(read(path))
    assert not recwarn.list and math.isfinite(report.area or 0.0)
