"""Bodies that touch share their faces; names, colours, tags and volumes outlive the fuse."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

cq = pytest.importorskip("cadquery")

import surfmesh as sm  # noqa: E402
from surfmesh.cad.selection.selection import select  # noqa: E402
from surfmesh.cli.arguments import parse  # noqa: E402
from surfmesh.errors import CadError  # noqa: E402

PI = math.pi


def box(x, y, z, at=(0, 0, 0)):
    return cq.Solid.makeBox(x, y, z, cq.Vector(*at))


def sheet(*points):
    return cq.Face.makeFromWires(cq.Wire.makePolygon(points, close=True))


def plate_with_hole():
    return cq.Workplane().box(10, 10, 4).faces(">Z").workplane().hole(3)


def box_with_cavity():
    return box(6, 6, 6).cut(box(2, 2, 2, (2, 2, 2)))


def sheets_in_a_t():
    floor = sheet((0, 0, 0), (5, 0, 0), (5, 5, 0), (0, 5, 0))
    return [floor, sheet((0, 2, 0), (5, 2, 0), (5, 2, 4), (0, 2, 4))]


# name: (bodies, volumes of solids, faces, faces between two solids, area)
CASES = {
    "face to face": ([box(4, 4, 4), box(4, 4, 4, (4, 0, 0))], [64, 64], 11, 1, 176),
    "in part": ([box(4, 4, 4), box(4, 4, 4, (4, 1, 1))], [64, 64], 13, 1, 183),
    "pin in a hole": (
        [plate_with_hole(), cq.Solid.makeCylinder(1.5, 4, cq.Vector(0, 0, -2))],
        [400 - 9 * PI, 9 * PI], 10, 2, 360 + 12 * PI,  # the seams of wall and pin differ
    ),
    "three round an edge": (
        [box(4, 4, 4), box(4, 4, 4, (-4, 0, 0)), box(8, 4, 4, (-4, -4, 0))],
        [64, 64, 128], 16, 3, 304,
    ),
    "body in a cavity": ([box_with_cavity(), box(2, 2, 2, (2, 2, 2))], [208, 8], 12, 6, 240),
    "overlap": ([box(4, 4, 4), box(4, 4, 4, (2, 1, 1))], [46, 18, 46], 18, 6, 192),
    "one inside the other": ([box(4, 4, 4), box(2, 2, 2, (1, 1, 1))], [56, 8], 12, 6, 120),
    "the same twice": ([box(2, 2, 2), box(2, 2, 2)], [8], 6, 0, 24),
    "sheet on a body": (
        [box(4, 4, 4), sheet((1, 1, 4), (3, 1, 4), (3, 3, 4), (1, 3, 4))], [64], 7, 0, 96,
    ),
    "sheet through a body": (
        [box(4, 4, 4), sheet((-1, -1, 2), (5, -1, 2), (5, 5, 2), (-1, 5, 2))],
        [32, 32], 12, 1, 132,
    ),
    "sheets in a T": (sheets_in_a_t(), [], 3, 0, 45),
    "a row": ([box(2, 2, 2, (2 * k, 0.3 * k, 0)) for k in range(6)], [8] * 6, 41, 5, 127),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_exact_figures(name):
    bodies, volumes, faces, shared, area = CASES[name]
    model = sm.from_cadquery(bodies, imprint=True)
    assert model.broken_invariant() == ""
    assert [solid.volume for solid in model.solids] == pytest.approx(volumes, rel=1e-7)
    assert all(solid.closed for solid in model.solids)
    held = [face for solid in model.solids for shell in solid.shells for face, _ in shell]
    assert len(model.faces) == faces and len(held) - len(set(held)) == shared
    assert model.area == pytest.approx(area, rel=1e-7)
    assert any(sentence.startswith("imprinted: bodies share") for sentence in model.healing)


def boundary_is_empty(mesh, solid):
    """Whether each edge of the triangles round a solid is used once each way."""
    behind, before = (mesh.solid_ids == solid).T
    around = np.concatenate([mesh.triangles[behind], mesh.triangles[before][:, ::-1]])
    edges = np.concatenate([around[:, [0, 1]], around[:, [1, 2]], around[:, [2, 0]]])
    there, back = ({tuple(edge) for edge in way} for way in (edges, edges[:, ::-1]))
    return len(there) == len(edges) and there == back


@pytest.mark.parametrize("name", ["in part", "pin in a hole", "three round an edge", "overlap"])
def test_conformal_meshes(name):
    model = sm.from_cadquery(CASES[name][0], imprint=True)
    mesh = sm.mesh(model, sm.Sizing(chord=0.05, max_size=2))
    report = sm.check(mesh)
    assert report.clean and report.self_intersections == 0 and report.contacts == 0
    assert len(np.unique(mesh.points.round(9), axis=0)) == len(mesh.points)
    assert all(boundary_is_empty(mesh, solid) for solid in range(len(model.solids)))
    for row, solid in zip(report.by_solid, model.solids):
        assert row.euler == row.euler_exact
        assert row.volume == pytest.approx(solid.volume, rel=0.03)


def ball(turned=0.0):
    return cq.Workplane().sphere(2).rotate((0, 0, 0), (1, 0, 0), turned).translate((0, 0, 2))


def fin_on_a_tube():
    fin = sheet((-2, 0, -1), (-4, 0, -1), (-4, 0, 1), (-2, 0, 1))
    return [cq.Solid.makeCylinder(2, 6, cq.Vector(0, 0, -3)), fin]


def fin_on_a_ball():
    start = cq.Workplane("XY").moveTo(-3.5, -1).lineTo(-3.5, 1).lineTo(-math.sqrt(3), 1)
    rim = start.threePointArc((-2, 0), (-math.sqrt(3), -1)).close().wire().val()
    return [cq.Workplane().sphere(2), cq.Face.makeFromWires(rim)]


PLATE = box(10, 10, 1, (-5, -5, -1))
TOUCHING = {  # name: (bodies, what of them is shared)
    "a fin on a tube": (fin_on_a_tube(), "1 edge, 2 vertices"),
    "a fin on a ball": (fin_on_a_ball(), "1 edge, 2 vertices"),
    "a sheet on end": (
        [box(4, 4, 4), sheet((1, 1, 4), (3, 1, 4), (3, 1, 6), (1, 1, 6))], "1 edge, 2 vertices",
    ),
    "an apex on a plate": ([PLATE, cq.Solid.makeCone(0, 2, 3)], "1 vertex"),
    "a pole on a plate": ([PLATE, ball()], "1 vertex"),
    "a ball on a plate": ([PLATE, ball(90)], "1 vertex"),  # a vertex inside both faces
    "two corners": ([box(2, 2, 2), box(2, 2, 2, (2, 2, 2))], "1 vertex"),
    "two edges": ([box(2, 2, 2), box(2, 2, 2, (2, 2, 0))], "1 edge, 2 vertices"),
}  # fmt: skip


@pytest.mark.parametrize("name", TOUCHING)
def test_bodies_that_touch_along_a_line_or_in_a_point(name):
    bodies, shared = TOUCHING[name]
    model = sm.from_cadquery(bodies, imprint=True)
    assert model.broken_invariant() == ""
    assert model.healing[0] == f"imprinted: bodies share {shared}"
    mesh = sm.mesh(model, sm.Sizing(chord=0.1, max_size=2))
    report = sm.check(mesh)
    assert report.clean, report.problems
    assert report.self_intersections == 0 and report.contacts == 0
    assert all(boundary_is_empty(mesh, solid) for solid in range(len(model.solids)))
    assert len(np.unique(mesh.points.round(9), axis=0)) == len(mesh.points)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_scaled_and_turned(scale):
    turn = cq.Location(cq.Plane((3, 2, 1), (1, 2, 3), (3, -3, 1)))
    bodies = [box(4, 4, 4), box(2, 2, 2, (4, 1, 1)), box(4, 4, 1, (0, 0, -1))]
    bodies = [body.scale(scale).moved(turn) for body in bodies]
    model = sm.from_cadquery(bodies, imprint=True)
    assert model.broken_invariant() == ""
    assert model.volume == pytest.approx(88 * scale**3)
    assert model.area == pytest.approx((96 + 24 + 48 - 4 - 16) * scale**2)
    assert len(model.faces) == 7 + 5 + 5


CHOICES = st.sampled_from([0.0, 0.5, 1.0, 1.3, 2.0])


@settings(max_examples=6, deadline=None)
@given(st.lists(st.tuples(CHOICES, CHOICES, CHOICES), min_size=2, max_size=4), CHOICES, CHOICES)
def test_nothing_is_lost_and_nothing_is_there_twice(corners, angle, radius):
    """Boxes on a grid, so that faces often coincide in part, and a pin through all of them."""
    bodies = [box(2, 1.5, 1, corner) for corner in corners]
    if radius:
        bodies.append(cq.Solid.makeCylinder(0.4 * radius, 4, cq.Vector(1, 1, -0.5)))
    turn = cq.Location((0.3, 0.2, 0.1), (1, 2, 3), 37 * angle)
    bodies = [body.moved(turn) for body in bodies]
    model = sm.from_cadquery(bodies, imprint=True)
    assert model.broken_invariant() == "" and all(solid.closed for solid in model.solids)
    together = bodies[0].fuse(*bodies[1:]).Volume()
    assert model.volume == pytest.approx(together, rel=1e-6)
    for body, part in zip(bodies, model.tree.children):
        volume = sum(model.solids[number].volume for number in part.solids)
        assert volume == pytest.approx(body.Volume(), rel=1e-6)
    sides = [face for solid in model.solids for shell in solid.shells for face, _ in shell]
    assert max(map(sides.count, set(sides))) <= 2


def named_assembly():
    """Three blocks on top of each other, the second and the third the same part."""
    base = cq.Workplane().box(8, 8, 2)
    base.faces(">Z").tag("lid")
    block = cq.Workplane().box(4, 4, 4)
    block.faces("<Z").tag("foot")
    whole = cq.Assembly(name="stack")
    whole.add(base, name="base", color=cq.Color(1, 0, 0))
    whole.add(block, name="low", loc=cq.Location((1, 1, 3)), color=cq.Color(0, 1, 0))
    whole.add(block, name="high", loc=cq.Location((2, 2, 7), (0, 0, 1), 30))
    return whole


def test_names_of_a_shared_face():
    base = cq.Workplane().box(8, 8, 2).faces(">Z").tag("lid").end()
    block = cq.Workplane().box(4, 4, 4).translate((1, 1, 3)).faces("<Z").tag("foot").end()
    model = sm.from_cadquery([base, block], imprint=True)
    (between,) = (f for f in model.faces if f.name == "lid + foot")  # in the order of the tree
    assert between.names == ("lid", "foot") and between.area == pytest.approx(16)
    lid, foot = (select(model, name).faces for name in ("lid", "foot"))
    assert select(model, "face:lid").faces == lid and len(lid) == 2
    assert sum(model.faces[k].area for k in lid) == pytest.approx(64)
    assert [model.faces[k] for k in foot] == [between]
    mesh = sm.mesh(model, 2.0)
    assert mesh.face_name(foot[0]) == "lid + foot"
    assert {tuple(pair) for pair in mesh.solid_ids[mesh.face_ids == foot[0]]} == {(0, 1)}


def test_parts_colours_and_tags_of_an_assembly():
    model = sm.from_cadquery(named_assembly(), imprint=True)
    assert model.broken_invariant() == ""
    assert [solid.name for solid in model.solids] == ["base", "low", "high"]
    assert [child.solids for child in model.tree.children] == [(0,), (1,), (2,)]
    lid, foot = (select(model, name).faces for name in ("lid", "foot"))
    assert sum(model.faces[k].area for k in lid) == pytest.approx(64)
    assert sum(model.faces[k].area for k in foot) == pytest.approx(32)
    (between,) = set(lid) & set(foot)
    assert model.faces[between].area == pytest.approx(16)
    assert model.faces[between].colour == pytest.approx((1, 0, 0))  # of the first


def test_pieces_of_bodies_that_overlap():
    whole = cq.Assembly(name="pair")
    whole.add(cq.Workplane().box(4, 4, 4), name="one", color=cq.Color(1, 0, 0))
    whole.add(cq.Workplane().box(4, 4, 4), name="two", loc=cq.Location((2, 1, 1)))
    model = sm.from_cadquery(whole, imprint=True)
    assert [solid.name for solid in model.solids] == ["one", "one + two", "two"]
    assert model.solids[1].names == ("one", "two")
    assert [child.solids for child in model.tree.children] == [(0, 1), (1, 2)]
    assert select(model, "solid:one").solids == (0, 1)
    assert select(model, "two").solids == (1, 2)
    said = "solid 1: common to 'one' and 'two', which overlap: a piece of its own"
    assert said in model.healing and "'one' was cut into 2 solids" in model.healing


def test_an_assembly_from_a_step_file(tmp_path):
    path = tmp_path / "stack.step"
    named_assembly().export(str(path))
    model = sm.load(path, "m", imprint=True)
    assert model.broken_invariant() == ""
    scale = 1e-3
    assert [solid.name for solid in model.solids] == ["base", "low", "high"]
    assert model.volume == pytest.approx((128 + 128) * scale**3)
    assert model.area == pytest.approx((192 + 96 + 96 - 16 - shared_by_turned()) * scale**2)
    colours = {face.colour for face in model.faces}
    assert any(colour == pytest.approx((0, 1, 0)) for colour in colours if colour)


def shared_by_turned():
    """Area that two squares of side 4 share, one moved by (1, 1) and turned by 30 degrees."""
    from shapely import affinity, box

    square = box(-2, -2, 2, 2)
    return square.intersection(affinity.translate(affinity.rotate(square, 30), 1, 1)).area


def test_a_gap_is_closed_within_the_tolerance():
    bodies = [box(1, 1, 1), box(1, 1, 1, (1.0005, 0, 0))]
    apart = sm.from_cadquery(bodies, imprint=True)
    assert len(apart.faces) == 12
    assert apart.healing[0].startswith("imprinted: no two bodies touch within")
    for units, near in ((None, 1e-3), ("m", 1e-6)):
        model = sm.from_cadquery(bodies, imprint=near, units=units)
        assert len(model.faces) == 11 and model.broken_invariant() == ""


def test_the_callers_shapes_are_left_alone():
    one, two = box(4, 4, 4), box(4, 4, 4, (4, 1, 1))
    sm.from_cadquery([one, two], imprint=True)
    assert [len(one.Faces()), len(two.Faces()), len(one.Edges())] == [6, 6, 12]
    model = sm.from_cadquery([one, two])
    assert len(model.faces) == 12


def test_a_single_body_stays_as_it_is():
    model = sm.from_cadquery(plate_with_hole(), imprint=True)
    assert len(model.faces) == 7
    assert model.healing == ("imprinted: there is one body alone",)


@pytest.mark.parametrize("wrong", ["yes", -1.0, 0.0, math.nan, math.inf, [1]])
def test_what_is_no_tolerance(wrong):
    with pytest.raises(CadError, match=r"imprint is .* True, False or a tolerance above 0"):
        sm.from_cadquery(box(1, 1, 1), imprint=wrong)
    with pytest.raises(CadError, match=r"sew is .* a tolerance above 0"):
        sm.from_cadquery(box(1, 1, 1), sew=wrong)


def test_a_surface_of_formulas_is_no_model():
    with pytest.raises(CadError, match="are for CAD models"):
        sm.load("sphere", imprint=True)


@pytest.mark.parametrize("command", ["mesh", "report", "view", "estimate", "explain"])
def test_on_the_command_line(command):
    more = {"mesh": ["-o", "x"], "report": ["-o", "x"], "explain": ["--at", "0", "0", "0"]}
    given = [command, *more.get(command, [])]
    for words, imprint, sew in (
        (["a.step", "--imprint"], True, None),
        (["--imprint", "a.step"], True, None),  # the file is no tolerance
        (["--imprint", "1e-3", "a.step", "--sew", "0.01"], 1e-3, 0.01),
        (["a.step", "--imprint=.5"], 0.5, None),
        (["a.step"], False, None),
    ):
        options = parse([*given, *words])
        found = options.reading["imprint"], options.reading["sew"]
        assert (options.input, *found) == ("a.step", imprint, sew)
    with pytest.raises(SystemExit):
        parse([*given, "a.step", "--imprint", "0"])
