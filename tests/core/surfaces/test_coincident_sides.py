"""Sides of surfaces as the core finds them, beside the twin in Python."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh._core.surfaces import SAME_SIDE, CallbackSurface, coincident_sides
from surfmesh.geometry.differential.sides import find_sides
from surfmesh.geometry.files.formula_file import gallery, load_formula_file
from tests.naive import coincident_sides as naive


@pytest.mark.parametrize("name", gallery())
def test_sides_are_those_of_the_twin(name):
    surface = load_formula_file(gallery()[name])
    assert find_sides(surface) == naive.find_sides(surface)
    assert naive.SAME == SAME_SIDE


class Broken:
    domain = ((0.0, 1.0), (0.0, 1.0))

    def evaluate(self, uv, order=0):
        raise ZeroDivisionError("no such place")


def test_what_the_callers_surface_raises_comes_out():
    with pytest.raises(ZeroDivisionError, match="no such place"):
        coincident_sides(CallbackSurface(Broken()), [0.0] * 4)


def test_rounding_says_how_near_sides_are_one():
    gap = 1e-6
    tube = sm.ParametricSurface("cos(u)", "sin(u)", "v", u=(0.0, 2.0 * np.pi - gap), v=(0.0, 1.0))
    assert find_sides(tube).partner == (-1, -1, -1, -1)
    found = coincident_sides(tube.core, [0.0, 1e-5, 0.0, 1e-5])
    assert found[1] == [-1, 3, -1, 1]


class Holed:
    """A tube that is no number at a few places of one of the sides that would be joined."""

    domain = ((0.0, 2.0 * np.pi), (0.0, 1.0))

    def evaluate(self, uv, order=0):
        u, v = np.asarray(uv).T
        r = np.stack([np.cos(u), np.sin(u), np.where((u == 0.0) & (v < 0.3), np.nan, v)], axis=1)
        return (r,)


def test_no_number_is_near_nothing():
    collapsed, partner, _ = coincident_sides(CallbackSurface(Holed()), [0.0] * 4)
    assert partner == [-1, -1, -1, -1] and not any(collapsed)
