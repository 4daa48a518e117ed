"""Sides that coincide or shrink, found from the geometry alone."""

import numpy as np
import pytest

from surfmesh.geometry.differential.sides import find_sides
from surfmesh.geometry.files.formula_file import gallery, load_formula_file
from surfmesh.geometry.formulas.expression import parse
from surfmesh.geometry.formulas.parametric import ParametricSurface
from surfmesh.geometry.formulas.parser import symbol

OPEN = (-1, -1, -1, -1)
# collapsed sides, partners, sides joined backwards; everything not listed is open
GALLERY = {
    "sphere": ({0, 2}, (-1, 3, -1, 1), set()),
    "ellipsoid": ({0, 2}, (-1, 3, -1, 1), set()),
    "wavy_sphere": ({0, 2}, (-1, 3, -1, 1), set()),
    "cone": ({0}, (-1, 3, -1, 1), set()),
    "cylinder": (set(), (-1, 3, -1, 1), set()),
    "catenoid": (set(), (-1, 3, -1, 1), set()),
    "torus": (set(), (2, 3, 0, 1), set()),
    "trefoil": (set(), (2, 3, 0, 1), set()),
    "spring": (set(), (2, -1, 0, -1), set()),
    "seashell": (set(), (2, -1, 0, -1), set()),
    "mobius": (set(), (-1, 3, -1, 1), {1, 3}),
    "klein": (set(), (2, 3, 0, 1), {1, 3}),
}


@pytest.mark.parametrize("name", gallery())
def test_gallery(name):
    surface = load_formula_file(gallery()[name])
    sides = find_sides(surface)
    collapsed, partner, backwards = GALLERY.get(name, (set(), OPEN, set()))
    assert sides.broken_invariant() == ""
    assert {side for side in range(4) if sides.collapsed[side]} == collapsed
    assert sides.partner == partner
    assert {side for side in range(4) if sides.reversed[side]} == backwards
    assert sides.one_sided == surface.facts["one_sided"]
    if not surface.loops:
        assert sides.closed == surface.facts["closed"]


@pytest.mark.parametrize("scale", [1e-6, 1e6])
@pytest.mark.parametrize("name", ["sphere", "klein", "torus"])
def test_size_and_distance_from_the_origin_do_not_matter(name, scale):
    plain = load_formula_file(gallery()[name])
    formulas = [f"s*(100 + {formula})" for formula in plain.formulas]
    scaled = ParametricSurface(*formulas, *plain.domain, plain.parameters | {"s": scale})
    assert find_sides(scaled) == find_sides(plain)


@pytest.mark.parametrize("name", ["sphere", "klein", "cone", "spring"])
def test_the_order_of_parameters_does_not_matter(name):
    plain = load_formula_file(gallery()[name])
    expected, found = find_sides(plain), find_sides(_swapped(plain))
    turn = (3, 2, 1, 0)  # side 0 (v = v0) becomes side 3 (u = u0), side 1 becomes side 2
    for side in range(4):
        partner = expected.partner[side]
        assert found.partner[turn[side]] == (turn[partner] if partner >= 0 else -1)
        assert found.reversed[turn[side]] == expected.reversed[side]
        assert found.collapsed[turn[side]] == expected.collapsed[side]
    assert found.one_sided == expected.one_sided


def _swapped(surface):
    """The same surface with u and v in each other's place."""
    u, v = symbol("u"), symbol("v")
    formulas = [
        parse(formula, parameters=surface.parameters).subs({u: v, v: u}, simultaneous=True)
        for formula in surface.formulas
    ]
    return ParametricSurface(*formulas, surface.domain[1], surface.domain[0])


def test_adjacent_sides_folded_together():
    """A square folded along its diagonal so that sides 0 and 3, 1 and 2 meet: a closed bag."""
    bag = ParametricSurface("u + v", "u*v", "u*(1-u)*v*(1-v)*(u-v)", u=(0, 1), v=(0, 1))
    sides = find_sides(bag)
    assert sides.partner == (3, 2, 1, 0)
    assert sides.reversed == (False,) * 4
    assert sides.closed and not sides.one_sided  # a sphere


def test_adjacent_sides_joined_head_to_tail_make_a_moebius_strip():
    """r(t, 0) = r(1, t): the boundary word is a a b c, which turns over once."""
    strip = ParametricSurface(
        "cos(2*pi*(u + v))", "sin(2*pi*(u + v))", "v*(1 - u)", u=(0, 1), v=(0, 1)
    )
    sides = find_sides(strip)
    assert sides.partner == (1, 0, -1, -1)
    assert sides.reversed == (False,) * 4
    assert sides.one_sided and not sides.closed


def test_points_run_with_their_variable():
    surface = load_formula_file(gallery()["torus"])
    sides = find_sides(surface)
    (u0, u1), (v0, v1) = surface.domain
    starts = [[u0, v0], [u1, v0], [u0, v1], [u0, v0]]
    ends = [[u1, v0], [u1, v1], [u1, v1], [u0, v1]]
    for side in range(4):
        points = sides.points(side, np.array([0.0, 1.0]))
        assert points.tolist() == [starts[side], ends[side]]


@pytest.mark.parametrize("gap", [1e-6, 1e-3])
def test_a_gap_is_a_gap(gap):
    surface = ParametricSurface("cos(u)", "sin(u)", "v", u=(0, 2 * np.pi - gap), v=(0, 1))
    assert find_sides(surface).partner == OPEN
