"""The least number of triangles as an estimate foretells it, against the report's."""

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm
from surfmesh.meshing.estimate import least_counts
from surfmesh.sizing.field.metric_area import inner_cells
from surfmesh.sizing.field.size_field import size_field


@pytest.mark.parametrize(
    "name, options",
    [
        ("torus", {"chord": 0.01}),
        ("torus", {"chord": 0.01, "vertices": "balanced"}),
        ("two_peaks", {"chord": 0.02, "anisotropy": 10}),
        ("two_peaks", {"chord": 0.002}),
        ("pierced_saddle", {"chord": 0.005}),
        ("mobius", {"chord": 0.005}),
        ("cylinder", {"chord": 0.002}),
    ],
)
def test_of_formulas(name, options):
    sizing = sm.Sizing(**options)
    found, made = sm.estimate(sm.load(name), sizing), sm.check(sm.mesh(sm.load(name), sizing))
    assert found.least_triangles == pytest.approx(made.least_triangles, rel=0.02)
    assert found.efficiency == found.least_triangles / found.triangles
    assert found.to_dict()["least_triangles"] == found.least_triangles
    assert "times the least that triangles of any shape need" in str(found)


def test_leaves_come_in_fours():
    field = size_field(sm.load("two_peaks"), sm.Sizing(chord=0.005))
    low, step, _ = inner_cells(field, None)
    corners, sides = least_counts._in_fours(low, step)
    four = low.reshape(-1, 4, 2), step.reshape(-1, 4, 2)
    np.testing.assert_allclose(sides, 2 * four[1][:, 0], rtol=1e-9)
    middle = (four[0] + 0.5 * four[1]).mean(axis=1)
    np.testing.assert_allclose(corners + 0.5 * sides, middle, rtol=1e-9)
    assert np.prod(sides, axis=1).sum() == pytest.approx(np.prod(field.chart.extent), rel=1e-9)


def test_of_a_cad_model():
    part = cq.Workplane().box(10, 10, 4).faces(">Z").hole(4).edges("|Z").fillet(1.5)
    part = part.union(cq.Workplane().sphere(2).translate((0, 12, 0)))
    sizing = sm.Sizing(chord=0.005)
    model = sm.from_cadquery(part)
    found, made = sm.estimate(model, sizing), sm.check(sm.mesh(model, sizing))
    assert found.least_triangles == pytest.approx(made.least_triangles, rel=0.02)


def test_nothing_is_foretold_without_a_chord_or_of_quadratic_triangles():
    surface = sm.load("torus")
    assert sm.estimate(surface, sm.Sizing(size=0.5)).efficiency is None
    assert sm.estimate(surface, sm.Sizing(chord=0.01, order=2)).least_triangles is None
    assert sm.estimate(sm.from_cadquery(cq.Workplane().box(1, 1, 1)), 0.3).efficiency is None
