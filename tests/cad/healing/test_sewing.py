"""Loose faces are joined along their edges; closed shells of them become solids."""

import math
import random

import pytest

cq = pytest.importorskip("cadquery")

from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy  # noqa: E402

import surfmesh as sm  # noqa: E402
from surfmesh.cad.selection.selection import select  # noqa: E402

PI = math.pi


def box(x, y, z, at=(0, 0, 0)):
    return cq.Solid.makeBox(x, y, z, cq.Vector(*at))


def loose(shape, turned=False, moved=0.0, without=()):
    """The faces of a shape, each with edges of its own; some turned over, all moved a little."""
    chance = random.Random(1)
    found = []
    for number, face in enumerate(shape.Faces()):
        copy = BRepBuilderAPI_Copy(face.wrapped).Shape()
        if turned and chance.random() < 0.5:
            copy = copy.Reversed()
        where = cq.Vector(*(moved * chance.uniform(-1, 1) for _ in range(3)))
        if number not in without:
            found.append(cq.Shape.cast(copy).moved(cq.Location(where)))
    return found


def rounded():
    return cq.Workplane().box(10, 8, 6).edges("|Z").fillet(1).faces(">Z").hole(3).val()


def cavity():
    return box(6, 6, 6).cut(box(2, 2, 2, (2, 2, 2)))


def pair(second):
    return cq.Compound.makeCompound([box(2, 2, 2), second])


# name: (faces, volumes, faces after, joined edges, free edges)
CASES = {
    "box": (loose(box(3, 2, 1)), [6], 6, 12, 0),
    "turned at random": (loose(box(3, 2, 1), turned=True), [6], 6, 12, 0),
    "not quite in place": (loose(box(3, 2, 1), moved=1e-5), [6], 6, 12, 0),
    "a face is missing": (loose(box(3, 2, 1), without=(2,)), [], 5, 8, 4),
    "rounded, with a hole": (
        loose(rounded(), turned=True), [480 - 6 * (4 - PI) - 6 * 2.25 * PI], 11, 26, 0,
    ),
    "with a cavity": (loose(cavity()), [208], 12, 24, 0),
    "a sphere": (loose(cq.Workplane().sphere(2).val()), [32 / 3 * PI], 1, 0, 0),
    "two that touch": (loose(pair(box(2, 2, 2, (2, 0, 0)))), [8, 8], 11, 20, 0),
    "two that touch in part": (loose(pair(box(2, 3, 2, (2, 0.5, 0)))), [8, 12], 13, 26, 0),
    "a long edge along two": (
        [cq.Face.makePlane(4, 4), *(cq.Face.makePlane(2, 2, (3, y, 0)) for y in (-1, 1))],
        [], 3, 3, 7,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("apart", [True, False])
def test_exact_figures(name, apart):
    faces, volumes, after, joined, free = CASES[name]
    model = sm.from_cadquery(faces if apart else cq.Compound.makeCompound(faces), sew=1e-3)
    assert model.broken_invariant() == ""
    assert sorted(s.volume for s in model.solids) == pytest.approx(volumes, rel=1e-4)
    assert all(solid.closed for solid in model.solids)
    assert len(model.faces) == after
    words = f"{joined} edge{'' if joined == 1 else 's'} joined, {free} are free"
    assert words in model.healing[0]
    if apart:  # every part still knows its faces
        assert all(part.faces or part.solids for part in model.tree.children)


def test_faces_farther_apart_than_the_tolerance_stay_loose():
    model = sm.from_cadquery(loose(box(3, 2, 1), moved=1e-2), sew=1e-4)
    assert not model.solids and "0 edges joined, 24 are free" in model.healing[0]


def test_the_tolerance_is_in_units_of_the_model():
    model = sm.from_cadquery(loose(box(3, 2, 1), moved=1e-2), sew=1e-4, units="m")
    assert model.volume == pytest.approx(6e-9, rel=0.05) and model.broken_invariant() == ""


def test_solids_that_are_closed_are_left_alone():
    model = sm.from_cadquery([box(1, 1, 1), box(1, 1, 1, (1, 0, 0))], sew=1e-3)
    assert len(model.faces) == 12 and model.healing == ("sewn: there are no loose faces",)


def test_names_and_colours():
    whole = cq.Assembly(name="skin")
    for number, face in enumerate(loose(box(3, 2, 1))):
        colour = cq.Color(number / 5, 0, 0) if number else None
        whole.add(face, name=f"side {number}", color=colour)
    model = sm.from_cadquery(whole, sew=1e-3)
    assert [solid.name for solid in model.solids] == ["skin"]
    assert [child.name for child in model.tree.children] == [f"side {k}" for k in range(6)]
    for number in range(6):
        (face,) = select(model, f"side {number}").faces
        colour = model.faces[face].colour
        assert colour is None if not number else colour == pytest.approx((number / 5, 0, 0))


def test_tags_outlive_sewing_and_imprinting():
    skin = cq.Workplane().newObject(loose(box(3, 2, 1)))
    skin.faces(">Z").tag("top")
    model = sm.from_cadquery([skin, box(1, 1, 1, (1, 1, 1))], sew=1e-3, imprint=True)
    assert sorted(solid.volume for solid in model.solids) == pytest.approx([1, 6])
    top = [model.faces[k].area for k in select(model, "top").faces]
    assert sorted(top) == pytest.approx([1, 5])


def test_a_clean_mesh_of_six_faces_from_a_file(tmp_path):
    path = tmp_path / "loose.brep"
    cq.Compound.makeCompound(loose(box(3, 2, 1), turned=True)).exportBrep(str(path))
    mesh = sm.mesh(sm.load(path, sew=1e-3), 0.5)
    report = sm.check(mesh)
    assert report.clean and report.closed and report.components == 1
    assert report.volume == pytest.approx(6)
