"""Which loops of a face run the wrong way round."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surfmesh.cad.model import loops
from surfmesh.cad.model.cad_model import CadCoedge
from surfmesh.geometry.cad_surfaces.curves import Circle

COORDINATE = st.floats(-4.0, 4.0)
CIRCLE = st.tuples(COORDINATE, COORDINATE, st.floats(0.05, 4.0), st.booleans())


def loop(x: float, y: float, radius: float, clockwise: bool) -> loops.Loop:
    curve = Circle((x, y), (1.0, 0.0), (0.0, 1.0), radius=radius)
    return (CadCoedge(0, clockwise, curve, 0.0, math.tau, False),)


@pytest.mark.parametrize(
    ("circles", "wrong"),
    [
        ([(0, 0, 3, False)], []),
        ([(0, 0, 3, True)], [0]),
        ([(0, 0, 3, False), (1, 0, 1, True), (-1, 0, 0.5, True)], []),
        ([(0, 0, 3, False), (1, 0, 1, False), (-1, 0, 0.5, True)], [1]),
        ([(0, 0, 1, False), (0, 0, 3, True), (0, 0, 5, False)], []),
        ([(0, 0, 1, True), (0, 0, 3, True), (0, 0, 5, False)], [0]),
        ([(0, 0, 1, False), (3, 0, 1, True)], [1]),
        ([(0, 0, 1, False), (1, 0, 1, False)], []),  # they cross: that is not certain
    ],
)
def test_which_way_round_depends_on_nesting(circles, wrong):
    assert loops.misdirected([loop(*circle) for circle in circles], False) == wrong


@given(st.lists(CIRCLE, min_size=1, max_size=6))
def test_a_glance_finds_what_the_whole_search_finds(circles):
    found = [loop(*circle) for circle in circles]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(loops, "_seem_directed", lambda rings: False)
        whole = loops.misdirected(found, False)
    assert loops.misdirected(found, False) == whole


def test_a_loop_that_is_not_finite_is_left_as_it_is():
    with np.errstate(invalid="ignore"):
        assert loops.misdirected([loop(math.nan, 0.0, 1.0, False)], False) == []
