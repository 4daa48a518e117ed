"""What the report proves, what it cannot, and that sizes are made smaller until it can."""

import json
from dataclasses import replace
from pathlib import Path

import cadquery as cq
import jsonschema
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.cli import main
from surfmesh.errors import SizingError
from surfmesh.quality.measures.proved_topology import _is_classified
from surfmesh.quality.measures.topology import topology

SCHEMA = json.loads(
    (Path(__file__).parents[3] / "docs" / "report-schema.json").read_text(encoding="utf-8")
)


@pytest.fixture(scope="module")
def plate():
    solid = cq.Workplane().box(20, 10, 4).faces(">Z").workplane().hole(5).edges("|Z").fillet(1)
    return sm.mesh(sm.from_cadquery(solid), sm.Sizing(chord=0.02))


def test_nothing_is_proved_unasked(plate):
    assert sm.check(plate).proof is None


def test_a_part_is_proved(plate):
    report = sm.check(plate, prove=True)
    found = report.proof
    assert found.proved == len(plate.triangles) and found.proved_share == 1.0
    assert report.deviation_two_sided <= found.bound_max <= 0.02
    assert found.bound_over_sampled < 1.1 and found.not_proved == ()
    assert found.edges_bound_max <= 0.02 and found.edges_without_bound == 0
    assert found.homeomorphic.answer is True
    jsonschema.validate(report.to_dict(), SCHEMA)
    assert "100 % of the triangles, both ways" in str(report)


def test_a_triangle_turned_over_in_the_parameters_is_no_disc(plate):
    corners = plate.uv_triangles.copy()
    corners[5] = corners[5][::-1]
    found = sm.check(plate.replaced(uv_triangles=corners), prove=True).proof
    assert found.homeomorphic.answer is None
    assert "do not all run the same way" in found.homeomorphic.because


def test_a_hole_is_not_the_model(plate):
    inner = ~np.isin(plate.triangles, plate.edge_segments).any(axis=1)
    kept = np.ones(len(plate.triangles), bool)
    kept[np.flatnonzero(inner)[0]] = False
    assert sm.check(plate.submesh(kept), prove=True).proof.homeomorphic.answer is False


def test_what_has_no_bounds_is_named():
    surface = sm.NumericSurface(lambda u, v: (u, v, 0.3 * u * v), u=(0, 1), v=(0, 1))
    mesh = sm.mesh(surface, sm.Sizing(chord=0.01, proof=True))
    report = sm.check(mesh)
    assert report.clean and report.proof.proved == 0
    assert any("a function of the caller" in text for text in report.warnings)
    assert "no bounds over boxes" in report.proof.not_proved[0].because
    assert report.to_dict()["proof"]["bound_max"] is None


def test_sizes_are_made_smaller_until_the_chord_is_proved():
    surface, chord = sm.load("two_peaks"), 0.1
    before = sm.mesh(surface, sm.Sizing(chord=chord))
    mesh = sm.mesh(surface, sm.Sizing(chord=chord, proof=True))
    assert sm.check(before, prove=True).proof.proved_share < 1.0
    report = sm.check(mesh)
    assert report.clean and report.proof.proved_share == 1.0
    assert report.proof.bound_max <= chord
    assert len(mesh.triangles) < 1.45 * len(before.triangles)


def test_an_apex_is_proved():
    report = sm.check(sm.mesh(sm.load("cone"), sm.Sizing(chord=0.01, proof=True)))
    assert report.clean and report.proof.proved_share == 1.0


def test_proof_needs_a_chord():
    with pytest.raises(SizingError, match="proof needs a chord"):
        sm.Sizing(size=0.1, proof=True)
    with pytest.raises(SizingError, match="True or False"):
        sm.Sizing(chord=0.1, proof=1)


def test_prove_on_the_command_line(tmp_path, capsys):
    path = str(tmp_path / "torus.vtu")
    assert main(["mesh", "torus", "-o", path, "--chord", "0.05", "--proof"]) == 0
    assert "proved" in capsys.readouterr().out
    assert main(["check", path, "--surface", "torus", "--prove"]) == 0
    assert "both ways; largest bound" in capsys.readouterr().out


def test_bounds_are_the_same_where_a_face_is_turned_over():
    mesh = sm.mesh(sm.load("monkey_saddle"), sm.Sizing(chord=0.03))
    other_way = (0, 2, 1)
    turned = mesh.replaced(
        triangles=np.ascontiguousarray(mesh.triangles[:, other_way]),
        uv_triangles=np.ascontiguousarray(mesh.uv_triangles[:, other_way]),
    )
    first, second = (sm.check(each, prove=True).proof for each in (mesh, turned))
    assert first.bound_max == second.bound_max and first.proved == second.proved


def test_a_face_whose_hole_touches_its_edge_at_a_vertex_is_a_disc_still():
    outside = cq.Wire.makePolygon([(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0)], close=True)
    hole = cq.Wire.makePolygon([(0, 0, 0), (1, 2, 0), (2, 1, 0)], close=True)
    model = sm.from_cadquery(cq.Face.makeFromWires(outside, [hole]))
    found = sm.check(sm.mesh(model, sm.Sizing(size=0.5)), prove=True).proof.homeomorphic
    assert found.answer is True, found


def test_what_closed_surfaces_are_is_known_by_their_euler_number(plate):
    facts = plate.facts
    assert _is_classified(plate, topology(plate))
    for other in (
        replace(facts, euler=facts.euler + 2),
        replace(facts, solids=2 * facts.solids),
        replace(facts, edge_uses=(1,) * len(facts.edge_uses)),
        replace(facts, vertex_fans=(2,) * len(facts.vertex_fans)),
    ):
        mesh = plate.replaced(facts=other)
        assert not _is_classified(mesh, topology(mesh))
