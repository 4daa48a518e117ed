"""DAGMC's .h5m: each face once, outward from its first solid, and the materials of solids."""

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.errors import FileFormatError

NAMES = ("compound 0", "compound 1")  # of solids that the part calls alike


@pytest.fixture(scope="module")
def boxes():
    """Two boxes that share a face."""
    from OCP.BOPAlgo import BOPAlgo_Builder

    fuse = BOPAlgo_Builder()
    for x in (0, 2):
        fuse.AddArgument(cq.Workplane().box(2, 2, 2).translate((x, 0, 0)).val().wrapped)
    fuse.Perform()
    return sm.mesh(sm.from_cadquery(cq.Shape.cast(fuse.Shape())), 0.8)


def test_solids_are_closed_and_of_their_materials(boxes, tmp_path):
    pytest.importorskip("cad_to_dagmc")
    h5py = pytest.importorskip("h5py")
    materials = dict(zip(NAMES, ("steel", "water")))
    found = boxes.save_dagmc(tmp_path / "part.h5m", materials)
    with h5py.File(found) as file:
        root = file["tstt"]
        points = root["nodes/coordinates"][:]
        corners = root["elements/Tri3/connectivity"][:].astype(int) - 1
        first = int(root["elements/Tri3/connectivity"].attrs["start_id"])
        sets = root["sets/list"]
        ends, base = sets[:, 0], int(sets.attrs["start_id"])
        contents = root["sets/contents"][:].astype(int)
        surfaces = root["tags/GEOM_SENSE_2/id_list"][:].astype(int)
        senses = root["tags/GEOM_SENSE_2/values"][:].astype(int)
        names = [bytes(name).rstrip(b"\0") for name in root["tags/NAME/values"][:]]
    np.testing.assert_array_equal(points, boxes.points)
    assert len(corners) == len(boxes.triangles)
    assert names == [b"mat:steel", b"mat:water"]
    volume = dict.fromkeys(np.unique(senses[senses > 0]).tolist(), 0.0)
    for number, (forward, backward) in zip(surfaces - base, senses):
        held = contents[ends[number - 1] + 1 if number else 0 : ends[number] + 1] - first
        a, b, c = points[corners[held[held >= 0]]].swapaxes(0, 1)
        under = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
        volume[forward] += under
        if backward:
            volume[backward] -= under
    assert list(volume.values()) == pytest.approx([8.0, 8.0])
    assert (senses > 0).all(axis=1).sum() == 1  # the face between them, once


@pytest.mark.parametrize(
    ("path", "materials", "words"),
    [
        ("a.h5", "steel", "extension must be .h5m"),
        ("a.h5m", {"lid": "steel"}, "no solid is called 'lid'; there are 'compound 0'"),
        ("a.h5m", {}, "'compound 0' has no material"),
        ("a.h5m", "", "1 to 28 characters"),
        ("a.h5m", "s" * 29, "1 to 28 characters"),
    ],
)
def test_what_cannot_be_written_is_said(path, materials, words, boxes, tmp_path):
    with pytest.raises(FileFormatError, match=words):
        boxes.save_dagmc(tmp_path / path, materials)
    assert not list(tmp_path.iterdir())


def test_an_open_surface_has_no_solid(tmp_path):
    with pytest.raises(FileFormatError, match="no solid"):
        sm.mesh("monkey_saddle").save_dagmc(tmp_path / "a.h5m", "steel")
