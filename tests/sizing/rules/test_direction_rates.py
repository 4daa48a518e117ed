"""Bounds of long edges where the direction of low curvature fans out or bends."""

import numpy as np
import pytest

from surfmesh.geometry.differential.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.geometry.differential.sides import find_sides
from surfmesh.geometry.formulas.parametric import ParametricSurface
from surfmesh.loading import load
from surfmesh.sizing.field.size_field import size_field
from surfmesh.sizing.field.size_law import SizeLaw
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.direction_rates import BENDING, FANNING, direction_rates, longest_along
from surfmesh.sizing.rules.direction_size import size_along
from surfmesh.sizing.rules.size_rules import SizeRules

TURN = (0.0, 2 * np.pi)
CONE = ParametricSurface("v*cos(u)", "v*sin(u)", "v", u=TURN, v=(0.5, 2.0))
TORUS = ParametricSurface(
    "(3 + 0.5*cos(v))*cos(u)", "(3 + 0.5*cos(v))*sin(u)", "0.5*sin(v)", u=TURN, v=TURN
)
TUBE = ParametricSurface("cos(u)", "sin(u)", "v", u=TURN, v=(0, 9))


def rates_and_curvatures(surface, uv, size=0.01):
    _, *derivatives = surface.evaluate(uv, 2)
    k = curvatures(forms_from_derivatives(*derivatives))
    rates = direction_rates(surface, uv, np.abs(k.k1) < np.abs(k.k2), np.full(len(uv), size))
    return rates, k


def test_rulings_of_a_cone_fan_out():
    """At radius v the cone of 45 degrees has K = 1 / (sqrt(2) v); along a ruling v grows by
    1 / sqrt(2) a unit, so K_t = 1 / (2 v^2)."""
    v = np.linspace(0.6, 1.9, 9)
    rates, _ = rates_and_curvatures(CONE, np.stack([np.full(9, 1.0), v], axis=1), 1e-4)
    np.testing.assert_allclose(rates[:, 0], 0.5 / v**2, rtol=1e-4)
    np.testing.assert_allclose(rates[:, 1], 0.0, atol=1e-6)


def test_circles_of_a_torus_bend():
    """k = cos v / (3 + cos v / 2) along the circles, its derivative round the tube by hand."""
    v = np.linspace(0.1, 6.0, 9)
    rates, _ = rates_and_curvatures(TORUS, np.stack([np.full(9, 1.0), v], axis=1), 1e-4)
    np.testing.assert_allclose(rates[:, 1], np.abs(6 * np.sin(v)) / (3 + 0.5 * np.cos(v)) ** 2,
                               rtol=1e-3, atol=1e-5)  # fmt: skip
    np.testing.assert_allclose(rates[:, 0], 0.0, atol=1e-6)


def test_nothing_turns_on_a_tube():
    rates, k = rates_and_curvatures(TUBE, np.random.default_rng(1).uniform(0, 6, (20, 2)))
    np.testing.assert_allclose(rates, 0.0, atol=1e-9)
    assert np.isinf(longest_along(rates, k.k1, k.k2, np.full(20, 0.1), 1e-3)).all()


def test_bounds_by_hand():
    rates = np.array([[2.0, 0.0], [0.0, 2.0], [2.0, 2.0]])
    k, size = np.full(3, 4.0), np.full(3, 0.1)
    bound = longest_along(rates, k, 0 * k, size, 0.005)  # K h^2 = 0.04 is more than 6 chord
    first, second = FANNING * 4.0 / 2.0, np.sqrt(BENDING * 4.0 * 0.1 / 2.0)
    np.testing.assert_allclose(bound, [first, second, min(first, second)])
    assert np.isinf(longest_along(rates, k, 0 * k, size, 0.06)).all()  # all within chord


@pytest.mark.parametrize("factor", [1e-6, 1e6])
def test_bounds_scale(factor):
    rates, k, size = np.array([[2.0, 3.0]]), np.array([4.0]), np.array([0.1])
    once = longest_along(rates, k, 0 * k, size, 0.005)
    scaled = longest_along(rates / factor**2, k / factor, 0 * k, size * factor, 0.005 * factor)
    np.testing.assert_allclose(scaled, factor * once)


def test_edges_are_told_as_faces_are():
    """A ruling of a cone as an edge of a CAD face: long edges on it spoilt the face beside it."""
    bounds = SizeRules.of(Sizing(chord=1e-3, anisotropy=100.0), 4.0)
    v = np.linspace(0.6, 1.9, 9)
    uv = np.stack([np.full(9, 1.0), v], axis=1)
    ruling = np.tile(np.array([np.cos(1.0), np.sin(1.0), 1.0]) / np.sqrt(2), (9, 1))
    size = size_along([CONE], [uv], ruling, bounds)
    assert (size <= 6 / 5.6 * FANNING * np.sqrt(2) * v).all() and (size > 0.3 * v).all()


def wanted_triangles(surface, chord, ratio):
    field = size_field(surface, Sizing(chord=chord, anisotropy=ratio), find_sides(surface))
    return 2 * field.expected_vertices()


@pytest.mark.parametrize(
    "name, chord", [("dini", 0.005), ("wavy_sphere", 0.004), ("two_peaks", 0.004), ("cone", 0.003)]
)
def test_a_larger_ratio_asks_for_no_more(name, chord):
    """dini took 1304 at 5 and 2868 at 100: widths that fit the tip were kept to the rim."""
    surface = load(name)
    counts = [wanted_triangles(surface, chord, ratio) for ratio in (5.0, 20.0, 100.0)]
    assert max(counts[1:]) < 1.03 * counts[0]


def test_what_long_edges_leave_of_the_chord_is_used():
    """Bumps on a cone: K and k of one sign, growth keeps the ratio far below what is allowed."""
    surface = ParametricSurface(
        "v*(1+0.08*cos(7*u)*sin(4*v))*cos(u)", "v*(1+0.08*cos(7*u)*sin(4*v))*sin(u)", "2*v",
        u=TURN, v=(0.3, 1.5),
    )  # fmt: skip
    assert wanted_triangles(surface, 0.004, 50.0) < 1.03 * wanted_triangles(surface, 0.004, 5.0)
    sizing = Sizing(chord=0.004, anisotropy=50.0)
    field = size_field(surface, sizing, find_sides(surface))
    xy = np.random.default_rng(1).uniform(0.1, 0.9, (2000, 2)) * field.chart.extent
    nodes = SizeLaw.of(surface, sizing, None)(xy)
    w = field.metric_roots_3d(xy)
    width = 1 / np.linalg.eigvalsh(w[:, [0, 1, 2, 1, 3, 4, 2, 4, 5]].reshape(-1, 3, 3))[:, 2]
    assert (width > 1.1 * nodes.size).mean() > 0.1
    assert (width < 1.25 * nodes.size).all()  # sqrt(0.75 * 8 / (0.7 * 6)) at most


def test_a_law_is_not_regained():
    surface = load("ellipsoid")
    sizing = Sizing(chord=1e-2, size=lambda p: np.full(len(p), 0.05), anisotropy=20.0)
    field = size_field(surface, sizing, find_sides(surface))
    xy = np.random.default_rng(1).uniform(0, 1, (500, 2)) * field.chart.extent
    w = field.metric_roots_3d(xy)
    values = np.linalg.eigvalsh(w[:, [0, 1, 2, 1, 3, 4, 2, 4, 5]].reshape(-1, 3, 3))
    assert (1 / values).max() <= 0.05 * (1 + 1e-9)
