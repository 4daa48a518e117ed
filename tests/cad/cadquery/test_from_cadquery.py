"""Shapes made in CadQuery become models whose numbers are known from analysis."""

import math
import pickle
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest

cq = pytest.importorskip("cadquery")

import shapes  # noqa: E402

from surfmesh.cad.cadquery.from_cadquery import from_cadquery  # noqa: E402
from surfmesh.cad.model.invariants import ENDS, signed_area  # noqa: E402
from surfmesh.errors import CadError  # noqa: E402

PI = math.pi


def model_of(obj, **options):
    model = from_cadquery(obj, **options)
    assert model.broken_invariant() == ""
    return model


# name: (shape, solids, faces, edges, degenerate, seams, area, volume)
KNOWN = {
    "box": (lambda: cq.Workplane().box(1, 2, 3), 1, 6, 12, 0, 0, 22.0, 6.0),
    "cylinder": (lambda: cq.Workplane().cylinder(3, 2), 1, 3, 3, 0, 1, 20 * PI, 12 * PI),
    "sphere": (lambda: cq.Workplane().sphere(2), 1, 1, 3, 2, 1, 16 * PI, 32 / 3 * PI),
    "cone": (
        lambda: cq.Solid.makeCone(3, 0, 4), 1, 2, 3, 1, 1, 24 * PI, 12 * PI,
    ),
    "torus": (lambda: cq.Solid.makeTorus(5, 1), 1, 1, 2, 0, 2, 20 * PI**2, 10 * PI**2),
    "box with a hole": (
        shapes.box_with_hole, 1, 7, 15, 0, 1, 2200 - 8 * PI + 120 * PI, 6000 - 120 * PI,
    ),
    "boxes that share a face": (shapes.cut_boxes, 2, 11, 20, 0, 0, 15.0, 3.0),
    "boxes that touch": (
        lambda: cq.Compound.makeCompound(
            [cq.Solid.makeBox(1, 1, 1), cq.Solid.makeBox(2, 1, 1, cq.Vector(1, 0, 0))]
        ), 2, 12, 24, 0, 0, 16.0, 3.0,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", KNOWN)
def test_counts_and_exact_sizes(name):
    make, solids, faces, edges, degenerate, seams, area, volume = KNOWN[name]
    model = model_of(make())
    assert (len(model.solids), len(model.faces), len(model.edges)) == (solids, faces, edges)
    assert sum(edge.degenerate for edge in model.edges) == degenerate
    assert len({c.edge for f in model.faces for c in f.coedges if c.seam}) == seams
    assert model.area == pytest.approx(area, rel=1e-7)
    assert model.volume == pytest.approx(volume, rel=1e-7)
    assert all(solid.closed for solid in model.solids)
    assert model.healing == ()


def test_a_face_between_two_bodies_is_one_and_counts_against_the_second():
    model = model_of(shapes.cut_boxes())
    first, second = (dict(solid.shells[0]) for solid in model.solids)
    (shared,) = set(first) & set(second)
    assert (first[shared], second[shared]) == (False, True)
    assert not any(first.values())


def test_outward_normals():
    model = model_of(shapes.box_with_hole())
    for number, against in model.solids[0].shells[0]:
        face = model.faces[number]
        uv = np.mean(face.surface.domain, axis=1)[None]
        r, r_u, r_v = face.surface.evaluate(uv, 1)
        normal = np.cross(r_u, r_v)[0] * (-1 if face.reversed != against else 1)
        if face.kind == "cylinder":  # a hole: outside is towards its axis
            assert normal[:2] @ r[0, :2] < 0
        else:
            assert normal @ r[0] > 0


def test_both_images_of_a_seam_are_a_period_apart():
    model = model_of(cq.Workplane().cylinder(3, 2))
    face = next(face for face in model.faces if face.kind == "cylinder")
    there, back = (coedge for coedge in face.coedges if coedge.seam)
    assert there.edge == back.edge and there.reversed != back.reversed
    assert np.abs(there.uv(ENDS) - back.uv(ENDS))[:, 0] == pytest.approx([2 * PI, 2 * PI])
    assert model.faces_of_edge(there.edge) == (model.faces.index(face),) * 2


def test_a_pole_is_a_point_in_space_and_a_line_in_uv():
    model = model_of(cq.Workplane().sphere(2))
    for coedge in model.faces[0].coedges:
        edge = model.edges[coedge.edge]
        if edge.degenerate:
            assert edge.curve is None and edge.start == edge.end and edge.length == 0.0
            assert abs(model.vertices[edge.start].point) == pytest.approx([0, 0, 2], abs=1e-12)
            assert np.ptp(coedge.uv(ENDS), axis=0) == pytest.approx([2 * PI, 0])


def test_holes_run_clockwise_after_the_outer_loop():
    model = model_of(shapes.box_with_hole())
    pierced = [face for face in model.faces if len(face.loops) == 2]
    assert len(pierced) == 2
    for face in pierced:
        outer, hole = map(signed_area, face.loops)
        assert outer == pytest.approx(200.0)
        assert hole == pytest.approx(-4 * PI, rel=0.02)


def test_edge_lengths():
    model = model_of(cq.Workplane().cylinder(3, 2))
    assert sorted(edge.length for edge in model.edges) == pytest.approx([3, 4 * PI, 4 * PI])


def test_a_circle_without_vertex_gets_one():
    model = model_of(shapes.circle_without_vertex())
    assert len(model.vertices) == 1 and model.edges[0].closed
    assert model.area == pytest.approx(4 * PI)


def test_edges_inside_a_face_are_walked_there_and_back():
    model = model_of(shapes.square_with_inner_edges())
    (inner,) = model.faces[0].loops[1:]
    assert [c.edge for c in inner] == [inner[0].edge, inner[1].edge, inner[1].edge, inner[0].edge]
    assert all(coedge.seam for coedge in inner)
    assert signed_area(inner) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("heal", [True, False])
def test_missing_images_are_made(heal):
    model = model_of(shapes.patch_without_pcurves(), heal=heal)
    assert model.faces[0].kind == "cylinder" and len(model.faces[0].loops[0]) == 4


def test_a_missing_seam_is_added_and_told():
    model = model_of(shapes.cylinder_without_seam())
    assert model.area == pytest.approx(12 * PI)
    assert model.healing == ("face 0: missing seam-edge added",)
    assert "is open in (u, v)" in "; ".join(
        from_cadquery(shapes.cylinder_without_seam(), heal=False).problems()
    )


def test_a_hole_that_runs_the_wrong_way_is_turned_and_told():
    face = shapes.reversed_loop()
    model = model_of(face)
    assert model.area == pytest.approx(16 - PI)
    assert model.healing == ("face 0: loop orientation reversed",)
    # the caller's own shape is as it was
    assert "second outer loop" in from_cadquery(face, heal=False).broken_invariant()


def test_a_whole_sphere_without_edges_gets_its_natural_boundary():
    model = model_of(shapes.bare_sphere(), heal=False)
    assert model.area == pytest.approx(16 * PI)
    assert model.healing == ("face 0: no edges, natural boundary added",)


def test_an_inside_out_solid_is_turned():
    box = cq.Solid.makeBox(1, 2, 3).wrapped.Complemented()
    model = model_of(box)
    assert model.volume == pytest.approx(6.0)
    assert "inside out" in " ".join(model.healing)


def test_a_void_is_a_second_shell():
    hollow = cq.Workplane().sphere(3).cut(cq.Workplane().sphere(1))
    model = model_of(hollow)
    assert [len(shell) for shell in model.solids[0].shells] == [1, 1]
    outer = model.faces[model.solids[0].shells[0][0][0]]
    assert outer.area == pytest.approx(36 * PI)
    assert model.volume == pytest.approx(104 / 3 * PI)


def test_workplane_selection_and_tags():
    work = cq.Workplane().box(1, 2, 3).faces(">Z").tag("lid").end()
    model = model_of(work)
    assert [face.name for face in model.faces].count("lid") == 1
    top = model_of(work.faces(">Z"))
    assert (len(top.solids), len(top.faces), top.area) == (0, 1, pytest.approx(2.0))
    assert top.free_faces == (0,)
    assert len(model_of(work.edges("|Z")).solids) == 1  # what the edges were selected from


def test_sketch():
    sketch = cq.Sketch().rect(4, 3).circle(1, mode="s")
    assert model_of(sketch).area == pytest.approx(12 - PI)


def assembly():
    cube = cq.Workplane().box(1, 1, 1)
    inner = cq.Assembly(name="pair").add(cube, name="left", color=cq.Color("red"))
    inner.add(cube, name="right", loc=cq.Location(cq.Vector(2, 0, 0)))
    whole = cq.Assembly(name="whole", color=cq.Color(0, 0, 1))
    return whole.add(inner, loc=cq.Location(cq.Vector(0, 0, 5), cq.Vector(0, 0, 1), 90))


def test_assembly_tree_places_and_colours():
    model = model_of(assembly())
    assert [line.strip() for line in model.tree.lines()] == [
        "whole", "pair", "left: solids 0", "right: solids 1",
    ]  # fmt: skip
    assert [solid.name for solid in model.solids] == ["left", "right"]
    assert model.solids[0].colour == pytest.approx((1, 0, 0))
    assert model.faces[-1].colour == pytest.approx((0, 0, 1))
    middle = np.mean([vertex.point for vertex in model.vertices[8:]], axis=0)
    assert middle == pytest.approx([0, 2, 5])  # turned by the parent's place


def test_units_scale_everything():
    inches = model_of(assembly(), units="in")
    assert inches.unit == "in"
    assert inches.volume == pytest.approx(2 / 25.4**3)
    middle = np.mean([vertex.point for vertex in inches.vertices[8:]], axis=0)
    assert middle == pytest.approx(np.array([0, 2, 5]) / 25.4)
    with pytest.raises(CadError, match="furlong"):
        from_cadquery(assembly(), units="furlong")


def test_a_mirrored_place_changes_the_geometry():
    from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf
    from OCP.TopLoc import TopLoc_Location

    from surfmesh.cad.conversion.model_of_parts import model_of as assembled
    from surfmesh.cad.parts import Part

    mirror = gp_Trsf()
    mirror.SetMirror(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)))
    cone = cq.Solid.makeCone(3, 1, 4, cq.Vector(5, 0, 0)).wrapped
    model = assembled(Part("mirrored", cone, TopLoc_Location(mirror)), heal=True)
    assert model.broken_invariant() == ""
    assert np.mean([vertex.point for vertex in model.vertices], axis=0)[0] < -4
    assert model.volume == pytest.approx(52 / 3 * PI)


def test_whatever_wraps_a_shape():
    wrapped = cq.Solid.makeBox(1, 1, 1).wrapped
    thing = SimpleNamespace(wrapped=wrapped, label="bracket", color=None, children=())
    assert model_of(thing).solids[0].name == "bracket"
    assert len(model_of([wrapped, thing]).solids) == 1  # the same shape, taken once
    for nothing in (3, "box.step", cq.Edge.makeLine((0, 0, 0), (1, 0, 0)), cq.Workplane()):
        with pytest.raises(CadError):
            from_cadquery(nothing)


def test_the_data_is_free_of_ocp(tmp_path):
    model = model_of(shapes.box_with_hole())
    (tmp_path / "model.pickle").write_bytes(pickle.dumps(model))
    program = (
        "import pickle, sys\n"
        "model = pickle.load(open(sys.argv[1], 'rb'))\n"
        "assert model.broken_invariant() == '' and len(model.faces) == 7\n"
        "assert not any(m.split('.')[0] in ('OCP', 'cadquery') for m in sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", program, tmp_path / "model.pickle"], check=True)


def test_text_forms():
    model = model_of(shapes.box_with_hole())
    assert repr(model) == (
        "CadModel('workplane', solids=1, faces=7, edges=15, unit='mm', diagonal=37.4166)"
    )
    assert "6 plane, 1 cylinder" in model.summary()
