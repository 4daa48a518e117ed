"""Triangles that each bring their own corners are not joined, however whole they look."""

import numpy as np

import surfmesh as sm

CORNERS = np.array([(0.0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)])
FACES = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])


def test_a_tetrahedron_of_loose_triangles_is_named():
    soup = sm.SurfaceMesh(
        points=CORNERS[FACES].reshape(-1, 3), triangles=np.arange(12).reshape(4, 3)
    )
    report = sm.check(soup)
    assert not report.closed
    assert report.warnings[0].startswith("12 free edges lie on each other and share no vertices")


def test_a_joined_one_and_an_open_one_have_nothing_to_say():
    assert not sm.check(sm.SurfaceMesh(points=CORNERS, triangles=FACES)).warnings
    assert not sm.check(sm.SurfaceMesh(points=CORNERS, triangles=FACES[:3])).warnings


def test_sides_that_a_surface_keeps_apart_are_not_named():
    seam = sm.ParametricSurface("cos(u)*(1+v)", "sin(u)*(1+v)", "0", u=(0, "2*pi"), v=(0, 1))
    mesh = sm.mesh(seam, size=0.4)
    assert not any("share no vertices" in word for word in sm.check(mesh).warnings)
