"""The promise of a face is its own; a min_size that forbids it is a limit the user stated."""

import json
from dataclasses import replace
from pathlib import Path

import cadquery as cq
import jsonschema
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.cli import main
from surfmesh.io import read

SCHEMA = json.loads((Path(__file__).parents[3] / "docs/report-schema.json").read_text())


@pytest.fixture(scope="module")
def rounded():
    return sm.from_cadquery(cq.Workplane().box(10, 20, 30).edges("|Z and >X and >Y").fillet(2))


def cylinder(model):
    return next(k for k, face in enumerate(model.faces) if face.kind == "cylinder")


def test_a_min_size_that_forbids_the_chord_is_said_in_one_line(rounded):
    sizes = {"*": sm.Sizing(chord=0.01), "type:cylinder": {"min_size": 1.5}}
    report = sm.check(sm.mesh(rounded, sizes))
    assert report.clean and report.chord == 0.01 and report.above_chord_share > 0
    (limit,) = report.limits
    assert (limit.face, limit.option, limit.asked) == (cylinder(rounded), "chord", 0.01)
    # two of the unit triangles that fit into a radius of 2: between 1.5^2 / 16 and its double
    assert 0.1 < limit.reached < 0.3 and limit.min_size == 1.5 and limit.share > 0.5
    line = f"min_size 1.5 keeps face {limit.face} from the chord 0.01: {limit.reached:.3g} away"
    assert str(limit) == line and line in report.warnings
    assert f"! warning: {line}" in str(report)
    assert "clean, but for a stated limit" in str(report)
    row = report.by_face[limit.face]
    assert row.limit == line and row.chord == 0.01 and row.above_chord_share > 0.5
    content = json.loads(report.to_json())
    jsonschema.validate(content, SCHEMA)
    assert content["limits"][0]["min_size"] == 1.5 and content["clean"] is True


def test_many_faces_with_one_limit_are_one_line():
    rod = cq.Workplane().box(10, 20, 30).edges("|Z").fillet(2)
    report = sm.check(sm.mesh(rod, sm.Sizing(chord=0.01, min_size=1.5)))
    assert len(report.limits) == 4 and len(report.warnings) == 1
    assert report.warnings[0].startswith("min_size 1.5 keeps faces ")
    assert "up to" in report.warnings[0] and "on face" in report.warnings[0]


def test_a_limit_of_the_angle(rounded):
    sizes = {"*": sm.Sizing(angle=5), "type:cylinder": {"min_size": 1.0}}
    report = sm.check(sm.mesh(rounded, sizes))
    (limit,) = report.limits
    assert report.clean and limit.option == "angle" and limit.reached > 15
    assert str(limit).endswith(f"from the angle 5°: neighbours turn by {limit.reached:.3g}°")
    assert report.by_face[limit.face].angle == 5.0
    jsonschema.validate(json.loads(report.to_json()), SCHEMA)


def test_each_face_is_compared_with_its_own_chord(rounded):
    number = cylinder(rounded)
    # the default of the whole model is finer than what is asked for here
    coarse = sm.check(sm.mesh(rounded, {"type:cylinder": sm.Sizing(chord=0.2), "type:plane": 3.0}))
    assert coarse.clean and not coarse.limits and coarse.above_chord_share == 0
    assert coarse.chord < coarse.deviation_max < coarse.by_face[number].chord == 0.2
    # and here there is none but that of the cylinder
    mesh = sm.mesh(rounded, {"*": 3.0, "type:cylinder": sm.Sizing(chord=0.01)})
    fine = sm.check(mesh)
    assert fine.clean and fine.chord is None and fine.above_chord_share == 0
    assert 0.4 < fine.chord_used < 1 and fine.by_face[0].chord is None
    tight = mesh.promises.copy()
    tight[number, 0] = 0.004
    broken = sm.check(replace(mesh, promises=tight))
    assert not broken.clean and not broken.limits and broken.above_chord_share > 0
    (said,) = broken.problems
    assert f"0.004 was asked for on face {number}" in said and "worst in triangle" in said
    allowed = tight.copy()
    allowed[number, 2] = 10.0  # larger than any triangle
    assert sm.check(replace(mesh, promises=allowed)).clean


def test_an_angle_of_one_face(rounded):
    number = cylinder(rounded)
    mesh = sm.mesh(rounded, {"*": 3.0, "type:cylinder": sm.Sizing(angle=10)})
    report = sm.check(mesh)
    assert report.clean and report.by_face[number].above_angle_share == 0
    assert report.by_face[0].angle is None and report.by_face[number].angle == 10.0
    tight = mesh.promises.copy()
    tight[number, 1] = 5.0
    (said,) = sm.check(replace(mesh, promises=tight)).problems
    assert f"5° was asked for on face {number}" in said


def test_one_surface_has_limits_too():
    torus = sm.mesh(sm.load("torus"), sm.Sizing(chord=0.001, min_size=0.3))
    report = sm.check(torus)
    assert report.clean and report.limits[0].called == "face 0 (torus)"
    unsaid = replace(torus, sizing=torus.sizing.replaced(min_size=None))
    assert not sm.check(unsaid).clean


def test_promises_travel_with_the_mesh(rounded, tmp_path, capsys):
    part, path = str(tmp_path / "part.step"), str(tmp_path / "part.vtu")
    cq.exporters.export(cq.Workplane().cylinder(10, 5), part)
    model = sm.load(part)
    mesh = sm.mesh(model, {"*": sm.Sizing(chord=0.01), "type:cylinder": {"min_size": 3.0}})
    mesh.save(path)
    assert np.array_equal(read(path).promises, mesh.promises, equal_nan=True)
    assert main(["check", path, "--surface", part]) == 0  # stated by the user: a warning
    assert "min_size 3 keeps face" in capsys.readouterr().out
    promises = mesh.promises.copy()
    promises[:, 2] = np.nan
    replace(mesh, promises=promises).save(path)
    assert main(["check", path, "--surface", part, "--json"]) == 1
    (said,) = json.loads(capsys.readouterr().out)["problems"]
    assert "from the surface, 0.01 was asked for" in said
    sphere = sm.mesh(sm.load("sphere"), sm.Sizing(chord=0.01))
    sphere.save(path)
    assert np.array_equal(read(path).promises, [[0.01, np.nan, np.nan]], equal_nan=True)
    assert main(["check", path, "--surface", "sphere", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["chord"] == 0.01 and found["above_chord_share"] == 0


@pytest.mark.parametrize("least", [0.115, 0.119, 0.121])
def test_sizes_that_min_size_leaves_no_room_below_are_a_limit_and_no_fault(least):
    """Sizes a little above ``min_size`` are not asked to be smaller: rounds make no request."""
    report = sm.check(sm.mesh("sphere", min_size=least))
    assert report.clean and len(report.limits) == 1


def oval_tube():
    """A face whose curvature changes along it: some sizes lie a little above any ``min_size``."""
    path = cq.Workplane("XZ").spline([(0, 0), (8, 20), (30, 30)])
    return sm.from_cadquery(cq.Workplane().ellipse(3, 1.6).sweep(path))


@pytest.mark.parametrize("anisotropy", [1.0, 6.0])
@pytest.mark.parametrize("least", [0.7, 0.9, 1.0, 1.1, 1.4])
def test_sizes_between_the_chord_and_min_size_are_a_limit_and_no_fault(least, anisotropy):
    sizing = sm.Sizing(chord=0.06, min_size=least, anisotropy=anisotropy)
    report = sm.check(sm.mesh(oval_tube(), sizing))
    assert report.clean, report.problems
    assert report.limits and all(limit.min_size == least for limit in report.limits)


def test_triangles_much_larger_than_min_size_are_a_fault_whatever_their_sizes_say():
    torus = sm.mesh(sm.load("torus"), sm.Sizing(size=0.5))
    asked = torus.sizing.replaced(size=None, chord=0.001, min_size=0.45)
    stated = replace(torus, sizing=asked)
    assert sm.check(stated).clean and sm.check(stated).limits
    claimed = np.full(len(torus.points), 0.04)
    coarse = replace(torus, sizing=asked.replaced(min_size=0.04), sizes=claimed)
    report = sm.check(coarse)
    assert not report.clean and not report.limits


def waves(**asked):
    surface = sm.ParametricSurface("u", "v", "0.3*cos(4*u)*sin(3*v)", u=(-2, 2), v=(-2, 2))
    return sm.mesh(surface, sm.Sizing(chord=0.005, **asked))


@pytest.mark.parametrize("least", [0.25, 0.4, 0.8, 1.5])
def test_waves_that_triangles_of_min_size_cannot_follow_are_a_limit(least):
    """Between the samples of triangles too large for it hides as much as they have seen."""
    report = waves(min_size=least).report
    assert report.clean, report.problems
    (limit,) = report.limits
    assert limit.reached >= max(report.deviation_max, report.unseen_max)


def test_no_rounds_are_made_for_sizes_that_min_size_forbids(caplog):
    with caplog.at_level("INFO", logger="surfmesh"):
        waves(min_size=0.2)
    assert sum(line.startswith("packing") for line in caplog.messages) <= 2
