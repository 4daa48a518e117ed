"""Distances of quadratic triangles and arcs, against closed forms."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh.accuracy.curved_triangles import WITHIN, arc_deviations, points_on, shape_functions
from surfmesh.accuracy.face_triangles import FaceTriangles, twins_of
from surfmesh.accuracy.proof import proved_curved
from surfmesh.geometry.differential.projection import closest_point


def circle(t):
    angle = 0.8 * t
    at = np.stack([np.cos(angle), np.sin(angle), 0 * t], axis=1)
    return at, 0.8 * np.stack([-np.sin(angle), np.cos(angle), 0 * t], axis=1)


def test_a_parabola_misses_its_circle_by_its_closed_form():
    """R (1 - cos a)^2 / 8 for a half angle a, at t^2 = 1/2 of it."""
    ends, middle = (circle(np.array([t]))[0][0] for t in (0.0, 1.0)), circle(np.array([0.5]))[0][0]
    start, end = ends
    nodes = np.array([[start, middle, end]])
    distance, place = arc_deviations(circle, nodes)
    exact = (1.0 - np.cos(0.4)) ** 2 / 8.0
    assert 0.95 * exact < distance[0] <= 1.001 * exact
    assert abs(np.hypot(*place[0, :2]) - 1.0) == pytest.approx(distance[0], rel=1e-9)


def test_functions_are_one_together_and_nodes_are_their_own():
    np.testing.assert_allclose(shape_functions(WITHIN).sum(axis=1), 1.0, rtol=1e-14)
    nodes = np.random.default_rng(3).normal(size=(2, 6, 3))
    corners = np.vstack([np.eye(3), [(0.5, 0.5, 0), (0, 0.5, 0.5), (0.5, 0, 0.5)]])
    np.testing.assert_allclose(points_on(nodes, corners), nodes, atol=1e-15)


@pytest.mark.parametrize(
    "name, chord", [("torus", 0.02), ("monkey_saddle", 0.01), ("two_peaks", 0.1)]
)
def test_curved_triangles_are_no_farther_than_proved(name, chord):
    """From points of each triangle to the surface, and to the piece point by point."""
    mesh = sm.mesh(sm.load(name), sm.Sizing(chord=chord, order=2))
    triangles = np.ascontiguousarray(mesh.triangles)
    table = mesh.connectivity
    twins = twins_of(table.half_edges, table.uses, len(triangles))
    corners, uv = mesh.points[triangles], np.ascontiguousarray(mesh.uv)
    face = FaceTriangles(np.ascontiguousarray(corners), uv, triangles, twins)
    nodes = mesh.nodes[mesh.elements]
    middles = np.ascontiguousarray(nodes[:, 3:])
    bound = proved_curved(mesh.surfaces[0], face, middles, np.full(len(triangles), chord))
    assert np.mean(bound <= chord) > 0.7
    on = points_on(nodes, WITHIN)
    guess = np.einsum("qk,mkd->mqd", WITHIN, uv)
    away = closest_point(mesh.surfaces[0], on.reshape(-1, 3), guess.reshape(-1, 2), 20)[1]
    assert (np.asarray(away).reshape(on.shape[:2]).max(axis=1) <= bound + 1e-12).all()
    found = sm.check(mesh, prove=True).proof
    assert found.proved_share == np.mean(bound <= chord * (1 + 1e-9))
    assert found.isotopic.answer is None
    assert found.homeomorphic.answer is None or "curved" in found.isotopic.because


def test_curved_triangles_of_other_surfaces_have_no_bounds():
    surface = sm.NumericSurface(lambda u, v: (u, v, 0.3 * u * v), u=(0, 1), v=(0, 1))
    mesh = sm.mesh(surface, sm.Sizing(chord=0.01, order=2))
    assert sm.check(mesh, prove=True).proof.proved == 0
