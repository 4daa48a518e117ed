"""``chord`` alone decides, unless ``volume`` is asked for."""

from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.meshing.solids.volumes import volume_errors


def plate(n):
    """n x n holes of diameter 5, 9 apart."""
    side = 9 * n
    holes = [
        cq.Wire.makeCircle(2.5, cq.Vector(9 * i + 4.5, 9 * j + 4.5, 0), cq.Vector(0, 0, 1))
        for i in range(n) for j in range(n)
    ]  # fmt: skip
    corners = [cq.Vector(*p, 0) for p in ((0, 0), (side, 0), (side, side), (0, side))]
    outline = cq.Wire.makePolygon(corners, close=True)
    return cq.Solid.extrudeLinear(outline, holes, cq.Vector(0, 0, 2))


def test_a_hole_has_as_many_triangles_whatever_the_number_of_holes():
    sizing = sm.Sizing(chord=0.1, max_size=4)
    # so many that the outline, which is finer beside holes, counts for little
    each = [len(sm.mesh(plate(n), sizing).triangles) / n**2 for n in (5, 10)]
    assert each[1] == pytest.approx(each[0], rel=0.1)


def test_a_long_cylinder_has_the_triangles_of_its_chord():
    found = sm.estimate(cq.Workplane().circle(1).extrude(50), sm.Sizing(chord=0.0021))
    assert found.triangles == pytest.approx(54_000, rel=0.05)


PARTS = {
    "cylinder": cq.Workplane().circle(1).extrude(50),
    "sphere": cq.Workplane().sphere(3),
    "torus": cq.Workplane(obj=cq.Solid.makeTorus(5, 1)),
    "pipe": cq.Workplane().circle(5).circle(4.5).extrude(20),
    "plate": plate(3),
    "pit": cq.Workplane().box(8, 8, 8).cut(cq.Workplane().sphere(3).translate((0, 0, 4))),
}


@pytest.mark.parametrize("name", PARTS)
@pytest.mark.parametrize(
    "options", [{}, {"size": 2.0}, {"anisotropy": 6}, {"angle": 30}], ids=lambda o: str(o)[1:-1]
)
def test_volumes_are_kept_when_asked_for(name, options):
    model = sm.from_cadquery(PARTS[name])
    sizing = sm.Sizing(volume=0.01, **options)
    report = sm.check(sm.mesh(model, sizing))
    assert report.clean, report.problems
    assert report.volume == pytest.approx(model.volume, rel=0.01)
    assert report.triangles == pytest.approx(sm.estimate(model, sizing).triangles, rel=0.15)


def test_volumes_of_two_solids_are_kept_each_by_itself():
    both = (
        cq.Assembly()
        .add(cq.Workplane().sphere(1))
        .add(cq.Workplane().circle(0.1).extrude(10).translate((3, 0, 0)))
    )
    model = sm.from_cadquery(both)
    errors = volume_errors(model, sm.mesh(model, sm.Sizing(size=0.5, volume=0.02)))
    assert max(errors.values()) <= 0.02


def test_nothing_is_made_finer_than_the_volume_needs():
    ball = sm.from_cadquery(cq.Workplane().sphere(3))
    report = sm.check(sm.mesh(ball, sm.Sizing(size=2.0, volume=0.01)))
    assert 0.6 * 0.01 < 1.0 - report.volume / ball.volume <= 0.01


def test_explain_names_the_volume():
    pin = sm.from_cadquery(cq.Workplane().circle(1).extrude(50))
    found = sm.explain(pin, sm.Sizing(volume=0.005), (1.0, 0.0, 25.0))
    assert found.winner.key == "volume 0.005 of solid 0"
    mesh = sm.mesh(pin, sm.Sizing(volume=0.005))
    side = np.flatnonzero(np.isclose(np.hypot(*mesh.points[:, :2].T), 1.0))
    assert np.median(mesh.sizes[side]) == pytest.approx(found.size, rel=0.1)
    assert "default" in {row.key for row in found.rows}  # its chord is still there


def test_a_derived_chord_is_no_promise():
    mesh = sm.mesh(cq.Workplane().sphere(3), sm.Sizing(size=2.0, volume=0.01))
    assert sm.check(mesh).chord is None


def test_min_size_may_forbid_it():
    mesh = sm.mesh(cq.Workplane().sphere(3), sm.Sizing(min_size=1.5, max_size=2, volume=0.001))
    report = sm.check(mesh)
    assert report.clean
    assert any("min_size 1.5 keeps solid 0" in warning for warning in report.warnings)


def test_a_volume_that_is_not_kept_is_a_problem():
    coarse = sm.mesh(cq.Workplane().sphere(3), 2.0)
    asked = replace(coarse, sizing=sm.Sizing(size=2.0, volume=0.01))
    assert any("volume of solid 0" in problem for problem in sm.check(asked).problems)


@pytest.mark.parametrize(
    "thing", [cq.Face.makePlane(2, 2), sm.load("sphere"), sm.PlanarDomain([(0, 0), (1, 0), (0, 1)])]
)
def test_what_has_no_volume_is_refused(thing):
    with pytest.raises(sm.errors.SizingError, match="volume"):
        sm.mesh(thing, sm.Sizing(volume=0.01))


@pytest.mark.parametrize("value", [0.0, -1.0, 1.0, 5.0])
def test_a_relative_error_is_between_0_and_1(value):
    with pytest.raises(sm.errors.SizingError, match="volume"):
        sm.Sizing(volume=value)
