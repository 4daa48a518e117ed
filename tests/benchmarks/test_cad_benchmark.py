"""The benchmark's own arithmetic: Euler numbers of B-reps, verdicts on solids, parts."""

import json

import numpy as np
import pytest

pytest.importorskip("OCP")

import cadquery as cq
from shapes import box_with_hole

import surfmesh as sm

pytestmark = pytest.mark.usefixtures("benchmarks_in_path")


def _euler(shape) -> list[int]:
    from brep_facts import solid_facts

    model = sm.from_cadquery(shape)
    return [solid_facts(model, solid)["euler"] for solid in model.solids]


def _two_blind_holes():
    return cq.Workplane().box(9, 9, 4).faces(">Z").workplane().pushPoints([(-2, 0), (2, 0)]).hole(
        2, 2
    )  # fmt: skip


@pytest.mark.parametrize(
    ("shape", "euler"),
    [
        (cq.Solid.makeBox(1, 2, 3), 2),
        (cq.Solid.makeSphere(2), 2),  # two poles and a seam
        (cq.Solid.makeCone(2, 0, 3), 2),  # an apex
        (cq.Solid.makeCylinder(1, 2), 2),  # faces with one closed edge
        (cq.Solid.makeTorus(5, 1), 0),  # two seams
        (box_with_hole(), 0),  # faces with two loops
        (_two_blind_holes(), 2),  # a face with three loops
    ],
)
def test_euler_number_of_a_solid(shape, euler):
    assert _euler(shape) == [euler]


def test_euler_numbers_of_the_parts():
    from cad_parts import EULER, PARTS, part

    assert EULER.keys() == PARTS.keys()
    for name in ("elbow", "shelled_box", "touching_boxes", "hollow_ball", "bracket"):
        assert _euler(part(name)) == EULER[name], name


def test_holes_that_touch_a_loop_are_one_piece_with_it():
    from brep_facts import solid_facts

    triangle = cq.Workplane().polyline([(2, 0), (-1, 1), (-1, -1)]).close().extrude(2)
    plate = cq.Workplane().box(4, 4, 1).cut(triangle.translate((0, 0, -1)))
    model = sm.from_cadquery(plate)
    (solid,) = model.solids
    facts = solid_facts(model, solid)
    mesh = sm.mesh(model, 1.0)
    table = mesh.connectivity
    assert facts["most"] == table.uses.max() == 4  # all four sides meet at one edge
    assert facts["euler"] == len(mesh.points) - len(table.edges) + len(mesh.triangles)


def _cube(missing: int = 0, turned: int = 0):
    """Twelve triangles of the unit cube."""
    from cad_measures import own_vertices

    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    triangles[:turned] = triangles[:turned, ::-1]
    return own_vertices(corners, triangles[missing:])


FACT = {"closed": True, "euler": 2, "most": 2, "volume": 1.0, "area": 6.0, "faces": [0]}


def test_verdicts_on_a_cube():
    from cad_measures import solid_figures
    from cad_summary import _good, _verdict

    whole = _verdict(solid_figures(_cube()), FACT, 0.01)
    assert _good(whole)
    assert whole["volume_error"] < 1e-12
    holed = _verdict(solid_figures(_cube(missing=1)), FACT, 0.01)
    assert not holed["watertight"] and not holed["euler"]
    turned = _verdict(solid_figures(_cube(turned=1)), FACT, 0.01)
    assert turned["watertight"] and not turned["oriented"]
    # more than chord x area is missing
    assert not _good(_verdict(solid_figures(_cube()), FACT | {"volume": 1.1}, 0.01))


def test_a_hole_that_was_named_is_not_silent():
    from cad_measures import solid_figures
    from cad_summary import _silent, _verdict

    verdict = _verdict(solid_figures(_cube(missing=1)), FACT, 0.01)
    assert _silent({"judged": [verdict], "failed_faces": [0]}) == 0
    assert _silent({"judged": [verdict], "failed_faces": [7]}) == 1
    assert _silent({"judged": [], "bare_faces": [3]}) == 1


def test_a_crack_in_a_sheet_is_seen():
    from dataclasses import replace

    from cad_measures import stray_edges

    sheet = cq.Workplane().box(2, 2, 2).faces("not <Z").vals()
    model = sm.from_cadquery(cq.Shell.makeShell(sheet))
    mesh = sm.mesh(model, 1.0)
    assert len(mesh.boundary_edges) and not stray_edges(mesh, model, set())
    keep = np.arange(len(mesh.triangles)) != 5
    pieces = {"triangles": mesh.triangles[keep], "uv_triangles": mesh.uv_triangles[keep]}
    cracked = replace(mesh, **pieces, face_ids=mesh.face_ids[keep], solid_ids=mesh.solid_ids[keep])
    assert stray_edges(cracked, model, set())
    bare = mesh.face_ids != 2
    pieces = {"triangles": mesh.triangles[bare], "uv_triangles": mesh.uv_triangles[bare]}
    holed = replace(mesh, **pieces, face_ids=mesh.face_ids[bare], solid_ids=mesh.solid_ids[bare])
    assert stray_edges(holed, model, set())
    assert not stray_edges(holed, model, {2})


def test_solids_of_other_meshers_go_by_their_volumes():
    from cad_summary import _judged

    facts = [FACT | {"volume": 8.0, "euler": 0}, FACT]
    solid = {"triangles": 12, "open": 0, "uneven": 0, "crowded": 0, "area": 6.0}
    solids = [
        solid | {"euler": 2, "volume": 1.0, "volume_exact": 1.0},
        solid | {"euler": 0, "volume": 8.0, "volume_exact": 8.0},
    ]
    assert all(v["euler"] for v in _judged(solids, facts, 0.01, ordered=False))
    assert not any(v["euler"] for v in _judged(solids, facts, 0.01, ordered=True))
    assert _judged(solids[:1], facts, 0.01, ordered=False) == [{"meshed": False}] * 2


def test_a_child_is_ended_in_time_and_what_it_said_is_kept(tmp_path):
    import child_process

    script = tmp_path / "script.py"
    script.write_text(
        "import json, os, sys, time\n"
        "request = json.load(sys.stdin)\n"
        "print(json.dumps({'known': 1}), flush=True)\n"
        "os.abort() if request['crash'] else time.sleep(60)\n"
    )
    found = child_process.run(str(script), {"crash": False}, 2.0)
    assert (found["known"], found["ended"]) == (1, "hang")
    found = child_process.run(str(script), {"crash": True}, 20.0)
    assert (found["known"], found["ended"]) == (1, "crash")


def test_the_summary_of_what_could_not_be_read(capsys):
    from cad_summary import show

    records = [{"file": "a.step", "mesher": "ours", "error": "no", "ended": "refusal"}]
    assert show(json.loads(json.dumps(records))) == 1
    assert "a.step" in capsys.readouterr().out
