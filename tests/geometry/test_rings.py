"""The area that a polygon runs round."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surfmesh.geometry.rings import next_ones, ring_area

RADII = st.lists(st.floats(0.1, 10.0), min_size=3, max_size=20)


@given(RADII, st.floats(-1e6, 1e6))
def test_area_of_a_star_is_that_of_its_triangles_wherever_it_lies(radii, far):
    turn = 2.0 * np.pi * np.arange(len(radii)) / len(radii)
    ring = np.stack([radii * np.cos(turn), radii * np.sin(turn)], axis=1)
    wanted = 0.5 * np.sin(turn[1]) * float(np.sum(radii * next_ones(np.array(radii))))
    assert ring_area(ring + far) == pytest.approx(wanted, rel=1e-6)
    assert ring_area(ring[::-1]) == pytest.approx(-wanted, rel=1e-12)
