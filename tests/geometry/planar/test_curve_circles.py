"""Where a curve leaves circles, against what is known of a straight line and of a loop."""

import numpy as np

from surfmesh.geometry.planar.curve_circles import leaving
from surfmesh.geometry.planar.curve_contacts import PlaneCurve


def test_a_line_leaves_circles_at_their_radii():
    line = PlaneCurve(lambda t: np.stack([t, 0.0 * t], axis=1), 1)
    radii = np.array([1e-7, 0.03, 0.5, 1.0, 2.0])
    found = leaving(line, 0.0, 1.0, np.zeros(2), radii, 1e-12)
    assert np.allclose(found[:4, 0], radii[:4], rtol=0.0, atol=1e-12)
    assert np.isnan(found[4]).all()
    back = leaving(line, 0.5, 0.0, np.array([0.5, 0.0]), np.array([0.25]), 1e-12)
    assert np.allclose(back, [[0.25, 0.0]])


def test_the_first_of_several_places_is_found():
    circle = PlaneCurve(lambda t: np.stack([np.sin(6.0 * t), 1.0 - np.cos(6.0 * t)], axis=1), 16)
    (found,) = leaving(circle, 0.0, 1.0, np.zeros(2), np.array([1.0]), 1e-10)
    assert np.allclose(found, [np.sin(np.pi / 3.0), 0.5], atol=1e-9)
