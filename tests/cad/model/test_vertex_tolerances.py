"""Curves and vertices of a model moved to where all p-curves of their faces have them."""

import cadquery as cq
import numpy as np

import surfmesh as sm


def test_vertices_follow_curves_that_are_replaced():
    """Two balls meet in a circle that their faces start right across from where it starts."""
    ball = cq.Workplane().sphere(1)
    (lens,) = ball.intersect(ball.translate((1.99, 0, 0))).solids().vals()
    model = sm.from_cadquery(lens)
    (edge,) = model.edges
    for vertex, end in zip((edge.start, edge.end), edge.evaluate(np.array([0.0, 1.0]))[0]):
        np.testing.assert_allclose(model.vertices[vertex].point, end, atol=1e-7)
    mesh = sm.mesh(model, chord=1e-3)
    assert mesh.report.clean
    height = 0.005
    volume = 2 * np.pi * height**2 * (1 - height / 3)
    assert abs(mesh.report.volume / volume - 1) < 0.2


def test_a_p_curve_that_goes_round_from_another_start_is_replaced():
    """The tolerance of the circle was its diameter, so that nothing seemed to stray."""
    ball = cq.Workplane("XY").sphere(2)
    cut = ball.cut(cq.Workplane("XZ", origin=(-1.1, 0.5, 1.7)).sphere(1.4))
    model = sm.from_cadquery(cut)
    assert max(edge.tolerance for edge in model.edges) < 1e-4
    assert any("p-curve on a face replaced" in text for text in model.healing)
    report = sm.check(sm.mesh(model, chord=0.02))
    assert report.clean
