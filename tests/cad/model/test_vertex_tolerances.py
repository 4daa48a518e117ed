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
