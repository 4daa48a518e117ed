"""Facets of quadratic triangles lie on them, close, and share their points to the last bit."""

import numpy as np

import surfmesh as sm
from surfmesh.result.connectivity import connect
from surfmesh.result.facets import PARTS, facets


def test_facets_of_a_closed_mesh_are_closed_and_lie_on_it():
    mesh = sm.mesh(sm.load("sphere"), 0.6, order=2)
    flat = facets(mesh)
    assert len(flat.triangles) == PARTS**2 * len(mesh.triangles)
    assert (connect(flat.triangles).uses == 2).all()
    assert len(np.unique(flat.points, axis=0)) == len(flat.points)
    assert abs(np.linalg.norm(flat.points, axis=1) - 1.0).max() < 0.01
    a, b, c = flat.points[flat.triangles].transpose(1, 0, 2)
    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0
    assert mesh.report.volume > volume > 0.97 * mesh.report.volume


def test_linear_values_stay_so_at_facets():
    mesh = sm.mesh(sm.load("torus"), 1.0, order=2).replaced(mid_points=None)
    middles = mesh.points[mesh.edges].mean(axis=1)
    mesh = mesh.replaced(mid_points=middles)  # straight: positions are linear too
    flat = facets(mesh)
    np.testing.assert_allclose(flat.interpolated(mesh, mesh.points[:, 2]), flat.points[:, 2],
                               atol=1e-12)  # fmt: skip
