"""How far an equilateral triangle lies from a quadric, by the direction of an edge."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surfmesh._core.packing import deviation_along

BETWEEN = 1.045
"""Between the middles of the edges and the centre a triangle may lie that much farther off."""

bends = st.floats(-3.0, 3.0)


@given(xx=bends, xy=bends, yy=bends, angle=st.floats(0.0, 2.0 * np.pi))
def test_it_is_the_largest_error_of_linear_interpolation(xx, xy, yy, angle):
    found = deviation_along([xx, xy, yy], [np.cos(angle), np.sin(angle)])
    error = _interpolation_error(xx, xy, yy, angle)
    assert found <= np.abs(error).max() + 1e-9
    assert np.abs(error).max() <= BETWEEN * found + 1e-9


@given(xx=bends, xy=bends, yy=bends, angle=st.floats(0.0, 2.0 * np.pi))
def test_the_width_is_that_of_the_band_on_both_sides(xx, xy, yy, angle):
    found = deviation_along([xx, xy, yy], [np.cos(angle), np.sin(angle)], is_width=True)
    error = _interpolation_error(xx, xy, yy, angle)
    assert found <= np.ptp(error) + 1e-9
    assert np.ptp(error) <= BETWEEN * found + 1e-9


def test_a_cylinder_allows_more_with_an_edge_along_its_axis():
    along, across = (deviation_along([1.0, 0.0, 0.0], way) for way in ([0.0, 1.0], [1.0, 0.0]))
    assert (along, across) == (pytest.approx(0.75), pytest.approx(1.0))


def _interpolation_error(xx: float, xy: float, yy: float, angle: float) -> np.ndarray:
    """Of 4 (xx x^2 + 2 xy x y + yy y^2) over a unit triangle, at a fine grid of its points."""
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.5, np.sqrt(0.75)]])
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    i, j = np.meshgrid(np.arange(61), np.arange(61))
    inside = i + j <= 60
    weights = np.stack([60 - i - j, i, j], axis=-1)[inside] / 60.0
    corners = corners @ turn
    points = weights @ corners

    def height(p: np.ndarray) -> np.ndarray:
        return 4.0 * (xx * p[:, 0] ** 2 + 2.0 * xy * p[:, 0] * p[:, 1] + yy * p[:, 1] ** 2)

    return weights @ height(corners) - height(points)
