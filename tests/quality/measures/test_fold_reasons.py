"""What has turned a triangle: nodes off the surface, or nodes on it with images elsewhere."""

import numpy as np
import pytest
from handmade_meshes import changed

import surfmesh as sm


@pytest.fixture(scope="module")
def square():
    return sm.mesh(sm.ParametricSurface("u", "v", "0*u", u=(0, 1), v=(0, 1)), 0.2)


def rim_node(mesh):
    """A vertex on the side v = 0 well within it."""
    low = np.flatnonzero(mesh.points[:, 1] == 0.0)
    return int(low[np.abs(mesh.points[low, 0] - 0.5).argmin()])


def moved(mesh, node, *by):
    points = mesh.points.copy()
    points[node] += by
    return changed(mesh, points=points, uv_points=mesh.uv_points, uv_triangles=mesh.uv_triangles)


def test_nodes_on_the_surface_whose_images_lie_elsewhere(square):
    report = moved(square, rim_node(square), 0.0, 0.4, 0.0).report
    assert report.inverted > 0
    said = next(text for text in report.problems if "inverted" in text)
    assert "nodes that lie on the surface to 0" in said and "(u, v) up to 0.4 from there" in said
    assert "off the surface" not in said
    assert report.folded_at[0].moved == pytest.approx(0.4) and report.folded_at[0].off == 0.0
    assert "(u, v) of a corner 0.4 away" in report.to_text()


def test_nodes_off_the_surface(square):
    report = moved(square, rim_node(square), 0.0, 0.0, 0.6).report
    assert report.folded > 0
    said = next(text for text in report.problems if "folded" in text)
    assert "beside edges that lie up to 0.6 off the surface" in said and "(u, v)" not in said
    assert report.folded_at[0].off == pytest.approx(0.6) and report.folded_at[0].moved == 0.0
