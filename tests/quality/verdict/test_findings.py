"""What is wrong comes as records: kinds, places and numbers, and sentences made of them."""

import pickle

import numpy as np
import pytest
from handmade_meshes import Saddle, changed, grid, icosphere

import surfmesh as sm
from surfmesh.quality.verdict.finding import Kind, MissingFace, Problem, Remark
from surfmesh.result.findings import Finding, FindingKind


def test_a_clean_mesh_has_no_problem():
    report = sm.check(grid(Saddle(), 6))
    assert report.clean and not report.problems
    assert not [found for found in report.findings if isinstance(found, Problem)]


def test_sentences_are_those_of_the_findings():
    mesh = changed(icosphere(2), sizing=sm.Sizing(chord=1e-3), warnings=("said before",))
    report = sm.check(mesh)
    problems = [found for found in report.findings if isinstance(found, Problem)]
    remarks = [found for found in report.findings if isinstance(found, Remark)]
    assert report.problems == tuple(map(str, problems)) and not report.clean
    assert report.warnings == tuple(found.text for found in remarks)
    assert remarks[0].kind is Kind.WARNING and remarks[0].text == "said before"


def test_a_violation_holds_its_numbers():
    report = sm.check(changed(icosphere(2), sizing=sm.Sizing(chord=1e-3)))
    (found,) = (found for found in report.findings if found.kind is Kind.DEVIATION)
    assert found.violation.reached == pytest.approx(report.deviation_max)
    assert found.violation.asked == 1e-3
    assert found.violation.fraction == report.above_chord_share
    assert found.triangles == (report.deviation_triangle,) and found.place == report.deviation_point


def test_a_hole_and_a_turned_triangle_are_found_by_kind():
    mesh = icosphere(1)
    triangles = mesh.triangles.copy()
    triangles[3] = triangles[3, ::-1]
    report = sm.check(sm.SurfaceMesh(points=mesh.points, triangles=triangles))
    (found,) = (found for found in report.findings if found.kind is Kind.ORIENTATION)
    assert found.count == 3 and len(found.place) == 3
    assert np.linalg.norm(found.place) < 1.0


def test_a_missing_face_is_known_by_its_record_and_not_by_words():
    mesh = grid(Saddle(), 4)
    said = Finding(FindingKind.NOT_MESHED, "no loop closes", face=2, label="face 2 (lid)")
    report = sm.check(mesh.replaced(findings=(said,)))
    (found,) = (found for found in report.findings if isinstance(found, MissingFace))
    assert found.face == 2 and report.problems == (said.text,) and not report.clean
    assert sm.check(mesh.replaced(warnings=("not meshed: words alone",))).clean


def test_findings_outlive_a_pickle():
    report = sm.check(changed(icosphere(2), sizing=sm.Sizing(chord=1e-3)))
    again = pickle.loads(pickle.dumps(report))
    assert again.findings == report.findings and again.problems == report.problems
