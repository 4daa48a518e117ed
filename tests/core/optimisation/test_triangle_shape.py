"""alpha of triangles that stand up from the surface."""

import math

import numpy as np
import pytest

import surfmesh as sm
from surfmesh._core.optimisation import SurfaceFrames, find_folded, triangle_shape
from surfmesh._core.triangulation import Triangulation


def shape_at(tilt: float, stretched: bool = True) -> float:
    """alpha of an equilateral triangle turned by ``tilt`` degrees against the normal z."""
    s = SurfaceFrames(3, stretched)
    angles = 2.0 * np.pi / 3.0 * np.arange(3)
    x, y = np.cos(angles), np.sin(angles)
    c, w = math.cos(math.radians(tilt)), math.sin(math.radians(tilt))
    s.point[:] = np.stack([x, c * y, w * y], axis=1)
    s.normal[:] = (0.0, 0.0, 1.0)
    s.metric_root_3d[:] = [1.0, 0.0, 0.0, 1.0, 0.0, 1.0]  # none where sizes are isotropic
    return triangle_shape(s, 0, 1, 2)


@pytest.mark.parametrize("tilt", [0.0, 30.0, 60.0, 89.0, 120.0, 180.0])
def test_of_a_stretched_triangle_the_area_counts_that_faces_as_the_surface_does(tilt):
    assert shape_at(tilt) == pytest.approx(math.cos(math.radians(tilt)))


def test_of_others_all_of_it():
    assert shape_at(60.0, False) == pytest.approx(1.0) == -shape_at(120.0, False)


def test_a_narrow_strip_round_a_cylinder_needs_its_two_edges_only():
    """Swaps once took triangles over long arcs, which stand up, for the better ones."""
    ring = sm.ParametricSurface("cos(u)", "sin(u)", "v+0.05*u", u=(0, 25), v=(0, 0.02))
    mesh = sm.mesh(ring, sm.Sizing(chord=0.005, anisotropy=20.0))
    report = sm.check(mesh)
    assert report.folded == 0 and report.deviation_max < 0.005
    assert len(mesh.triangles) < 700  # there were 1026


def test_at_a_pole_the_other_corners_decide():
    """A corner without a normal: turned by 80 degrees the triangle is looked at, and let pass."""
    s = SurfaceFrames(3)
    tilt = math.radians(80.0)
    s.point[:] = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, math.cos(tilt), math.sin(tilt))]
    s.normal[:] = [(0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, 1.0)]
    xy = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])
    corners, none = np.array([0, 1, 2], np.int32), np.full(3, -1, np.int32)
    no = np.zeros(3, np.uint8)
    t = Triangulation(xy, np.tile([1.0, 0.0, 1.0], (3, 1)), corners, none, no[:1], no)
    assert find_folded(t, s, 0.35, 0.85).tolist() == [1]
    assert find_folded(t, s, 0.35, 0.0).tolist() == [0]
