"""Lost area and volume: in the figures, and in the problems beyond what distances explain."""

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.quality.measures.area_and_volume import explained_areas, explained_volume
from surfmesh.quality.measures.deviation import deviation
from surfmesh.quality.measures.joined import joined_triangles
from surfmesh.quality.measures.shape import shapes
from surfmesh.result.model_facts import ModelFacts
from surfmesh.result.surface_mesh import SurfaceMesh

SIZINGS = [
    sm.Sizing(chord=0.05),
    sm.Sizing(size=0.5),
    sm.Sizing(size=1.2),
    sm.Sizing(chord=0.05, anisotropy=10),
]


def pin():
    return cq.Workplane().circle(1).extrude(8)


def knob():
    return cq.Workplane().box(6, 6, 2).union(cq.Workplane().sphere(2)).edges("|Z").fillet(0.7)


def ring():
    return cq.Workplane(obj=cq.Solid.makeTorus(3, 1.2))


def spline():
    points = [(2, 0), (1, 2), (0, 1.5), (-2, 0.3), (0, -2)]
    return cq.Workplane().spline(points, periodic=True).close().extrude(2)


@pytest.mark.parametrize("make", [pin, knob, ring, spline])
@pytest.mark.parametrize("sizing", SIZINGS, ids=["chord", "size", "coarse", "stretched"])
def test_what_facets_lose_is_a_figure_and_no_problem(make, sizing):
    mesh = sm.mesh(sm.from_cadquery(make()), sizing)
    report = mesh.report
    assert not any("volume" in said or "area" in said for said in report.problems)
    assert report.volume_error == pytest.approx(report.volume / report.volume_exact - 1)
    assert report.area_error == pytest.approx(report.area / report.area_exact - 1)
    row = report.by_solid[0]
    assert row.volume_error == pytest.approx(report.volume_error, rel=1e-9)
    assert abs(row.volume_error) > 1e-6
    for face in report.by_face:
        assert face.area_error == pytest.approx(face.area / face.area_exact - 1)
    text = report.to_text()
    assert f"{100 * row.volume_error:+.2g} %" in text


def test_an_arc_cut_aslant_that_is_one_segment():
    """A plane across a cylinder: their edge lies farther from its chord than the cylinder does."""
    solid = cq.Workplane().circle(2).extrude(6).cut(
        cq.Workplane().box(9, 9, 9).rotate((0, 0, 0), (1, 0, 0), 60).translate((0, 3.2, 7))
    )  # fmt: skip
    for sizing in (sm.Sizing(size=2.0), sm.Sizing(chord=0.3, anisotropy=4)):
        report = sm.mesh(sm.from_cadquery(solid), sizing).report
        assert not any("has the area" in said for said in report.problems), report.problems


def test_exact_volume_of_an_extruded_spline():
    """Adaptive integration of the CAD kernel gives up to 3 % too much or too little."""
    model = sm.from_cadquery(spline())
    fine = sm.mesh(model, sm.Sizing(chord=0.0005)).report
    assert abs(fine.volume_error) < 2e-3


def dented(mesh, face, share):
    """The mesh with the points of a plane face drawn together about their middle."""
    points = mesh.points.copy()
    own = np.unique(mesh.triangles[mesh.face_ids == face])
    rim = np.unique(mesh.triangles[mesh.face_ids != face])
    inner = np.setdiff1d(own, rim)
    points[inner] += share * (points[own].mean(axis=0) - points[inner])
    return points


def remade(mesh, **changes):
    return SurfaceMesh(
        **{name: getattr(mesh, name) for name in mesh.__dataclass_fields__} | changes
    )


def test_area_of_a_face_that_lies_on_itself():
    mesh = sm.mesh(sm.from_cadquery(cq.Workplane().box(4, 4, 4)), 0.8)
    assert mesh.report.clean
    folded = remade(mesh, points=dented(mesh, 0, 2.2)).report
    said = [text for text in folded.problems if "has the area" in text]
    assert len(said) == 1 and said[0].startswith("face 0 has the area ")
    assert folded.by_face[0].area_error > 0.1


def test_volume_that_is_missing():
    """A model that says it is larger than its mesh, whose triangles lie on its surface."""
    mesh = sm.mesh(sm.from_cadquery(pin()), sm.Sizing(chord=0.02))
    solid = mesh.facts.solids[0]
    facts = {name: getattr(mesh.facts, name) for name in mesh.facts.__dataclass_fields__}
    larger = type(solid)(solid.name, solid.area, 1.1 * solid.volume, solid.euler, solid.closed)
    report = remade(mesh, facts=ModelFacts(**facts | {"solids": (larger,)})).report
    assert len(report.problems) == 1 and "solid 0 (workplane) has the volume" in report.problems[0]
    assert "distances from the surface explain" in report.problems[0]


@pytest.mark.parametrize(
    "sizing", [0.3, sm.Sizing(chord=0.05), sm.Sizing(chord=0.05, anisotropy=8)]
)
def test_area_of_a_formula_with_a_bent_rim(sizing):
    facts = {"area": np.pi}
    disc = sm.ParametricSurface("u*cos(v)", "u*sin(v)", "0*u", u=(0, 1), v=(0, "2*pi"), facts=facts)
    report = sm.mesh(disc, sizing).report
    assert report.clean, report.problems
    facts["area"] = 1.3 * np.pi
    wrong = sm.ParametricSurface(
        "u*cos(v)", "u*sin(v)", "0*u", u=(0, 1), v=(0, "2*pi"), facts=facts
    )
    said = sm.mesh(wrong, sizing).report.problems
    assert len(said) == 1 and said[0].startswith("the area is 3."), said


def test_what_a_ball_loses_is_explained():
    ball = sm.mesh(sm.from_cadquery(cq.Workplane().sphere(1)), 0.4)
    row = ball.report.by_solid[0]
    shape = shapes(ball)
    away = deviation(ball, shape.area).by_triangle
    areas = explained_areas(ball, joined_triangles(ball), shape.area, away)
    volume = explained_volume(shape.area, away, np.ones(len(away), bool))
    lost = row.volume_exact - row.volume
    assert lost < volume < 4 * lost
    assert row.area_exact - row.area < areas.sum()
