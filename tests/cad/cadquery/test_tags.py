"""Tags of CadQuery select what stands for them in the final shape."""

import math

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.cad.cadquery.motions import motion_between
from surfmesh.cad.selection.selection import select
from surfmesh.errors import SizingError


def block():
    return cq.Workplane().box(10, 10, 10)


def tagged():
    return block().faces(">Z").tag("top").end()


def selected(work, key="top"):
    model = sm.from_cadquery(work)
    return model, select(model, key)


SINCE = {
    "nothing": (lambda: tagged(), 100.0),
    "a hole": (lambda: block().faces(">Z").tag("top").hole(4), 100.0 - 4 * math.pi),
    "a fillet of another edge": (lambda: tagged().edges("|Z and >X").fillet(1), None),
    "a fillet beside it": (lambda: tagged().edges(">Z").fillet(2), 36.0),
    "split by another body": (lambda: tagged().union(cq.Workplane().box(4, 20, 20)), 60.0),
    "a coplanar body": (lambda: tagged().union(cq.Workplane().box(4, 20, 10)), 140.0),
    "a move": (lambda: tagged().translate((1, 2, 10)), 100.0),
    "a hole, then a turn": (
        lambda: tagged().faces(">Z").hole(4).rotate((0, 0, 0), (1, 1, 0), 33), 100 - 4 * math.pi
    ),
    "a mirror, then a hole": (
        lambda: tagged().mirror("XY").translate((0, 0, 10)).faces(">Z").hole(4), None
    ),
    "many holes": (
        lambda: tagged().faces(">Z").workplane().rarray(2, 2, 4, 4).hole(1), 100 - 4 * math.pi
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", SINCE)
def test_a_face_after(name):
    make, area = SINCE[name]
    model, found = selected(make())
    assert not found.edges and not found.solids
    total = sum(model.faces[k].area for k in found.faces)
    if area is None:
        assert total == pytest.approx(100.0, rel=0.2)
    else:
        assert total == pytest.approx(area, rel=1e-6)
    assert len(found.faces) == (2 if name.startswith("split") else 1)
    assert all(model.faces[k].kind == "plane" for k in found.faces)


def test_the_bottom_is_not_taken_for_a_mirrored_top():
    model, found = selected(SINCE["a mirror, then a hole"][0]())
    surface = model.faces[found.faces[0]].surface
    (point,) = surface.evaluate(np.array(surface.domain)[:, :1].T, 0)[0]
    assert point[2] == pytest.approx(5.0)  # -5 by the mirror, up again by 10


def test_edges_and_vertices():
    work = block().edges("|Z").tag("up").end().vertices(">Z").tag("corners").end()
    model = sm.from_cadquery(work.edges("|Z and >X").fillet(1))
    assert len(select(model, "up").edges) == 2
    found = select(model, "corners")
    assert len(found.vertices) == 2 and not found.edges
    assert {tuple(model.vertices[k].point) for k in found.vertices} == {(-5, -5, 5), (-5, 5, 5)}
    assert select(model, "vertex:corners") == found and select(model, "edge:up").edges
    rim = cq.Workplane().circle(5).extrude(10).faces(">Z").edges().tag("rim").end(2)
    model = sm.from_cadquery(rim.faces(">Z").workplane().rect(2, 20).cutBlind(-3))
    found = select(model, "rim").edges
    assert len(found) == 3  # the seam cuts one of the two arcs
    assert sum(model.edges[k].length for k in found) == pytest.approx(
        2 * math.pi * 5 - 4 * 5 * math.asin(0.2)
    )


def test_curved_faces_and_solids():
    rod = cq.Workplane().circle(5).extrude(10).faces("%CYLINDER").tag("side").end()
    model, found = selected(rod.faces(">Z").workplane().rect(2, 20).cutBlind(-3), "side")
    assert [model.faces[k].kind for k in found.faces] == ["cylinder"]
    model, found = selected(block().tag("body").faces(">Z").hole(2), "body")
    assert not found.solids and len(found.faces) == 6  # not that of the hole
    assert selected(block().tag("body"), "body")[1].solids == (0,)


def test_a_tag_that_lost_all_it_held_is_an_error():
    gone = tagged().cut(cq.Workplane().box(20, 20, 5).translate((0, 0, 4)))
    message = r"tag 'top' stands for nothing in the final shape: .* held \(1 face\)"
    with pytest.raises(SizingError, match=message):
        selected(gone)
    with pytest.raises(SizingError, match=message):
        sm.mesh(gone, {"*": 3.0, "tag:top": 1.0})
    sm.mesh(gone, 5.0)  # nobody asks for it
    uprights = block().edges("|Z").tag("up").end().edges("|Z").fillet(1)
    with pytest.raises(SizingError, match=r"tag 'up' .* held \(4 edges\)"):
        selected(uprights, "up")


def test_units_scale_what_tags_stand_for():
    work = SINCE["a hole, then a turn"][0]()
    model = sm.from_cadquery(work, units="m")
    (number,) = select(model, "top").faces
    assert model.faces[number].area == pytest.approx(1e-6 * (100 - 4 * math.pi))
    assert model.faces[number].name == "top"


def test_tags_of_parts_of_an_assembly():
    part = block().faces(">Z").tag("top").hole(4)
    whole = cq.Assembly(name="pair").add(part, name="a")
    whole.add(part, name="b", loc=cq.Location(cq.Vector(30, 0, 0)))
    assert len(select(sm.from_cadquery(whole), "top").faces) == 2


def test_a_finer_mesh_where_the_tag_is():
    mesh = sm.mesh(block().faces(">Z").tag("top").hole(4), {"*": 3.0, "top": 0.5})
    top = np.isclose(mesh.points[mesh.triangles][:, :, 2], 5.0).all(axis=1)
    edges = mesh.points[mesh.triangles[top]] - mesh.points[np.roll(mesh.triangles[top], 1, axis=1)]
    assert np.linalg.norm(edges, axis=2).mean() == pytest.approx(0.5, rel=0.15)


def test_motions_are_found_back():
    solid = cq.Workplane().box(1, 2, 3).faces(">Z").hole(0.5).val()
    moved = solid.rotate((0, 0, 0), (1, 2, 3), 40).translate((5, 6, 7))
    motion = motion_between(solid.wrapped, moved.wrapped)
    there = solid.moved(cq.Location(motion))
    assert there.Center().toTuple() == pytest.approx(moved.Center().toTuple())
    assert motion_between(solid.wrapped, solid.wrapped).Form().name == "gp_Identity"
    assert motion_between(solid.wrapped, cq.Workplane().box(1, 2, 3).val().wrapped) is None
    assert motion_between(solid.wrapped, solid.mirror("XY").wrapped) is not None
