"""Closest points against offsets whose distance is known, and against brute force."""

import numpy as np
import pytest

from surfmesh.geometry.differential.fundamental_forms import curvatures, forms
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.geometry.files.formula_file import gallery, load_formula_file

SMOOTH = sorted(gallery().keys() - {"bad_speed", "dini"})


def offset(surface, count=500, seed=0):
    """Points at a known distance along the normal, well within the focal surface, and feet."""
    lo, hi = np.array(surface.domain).T
    uv = lo + (hi - lo) * np.random.default_rng(seed).uniform(0.03, 0.97, (count, 2))
    f = forms(surface, uv)
    c = curvatures(f)
    largest = np.maximum(np.abs(c.k1), np.abs(c.k2)) + 1e-9
    distance = np.minimum(0.02 / largest, 0.01 * np.ptp(surface.evaluate(uv)[0]))
    return uv, surface.evaluate(uv)[0] + distance[:, None] * f.normal, distance


@pytest.mark.parametrize("name", SMOOTH)
def test_offset_points_are_found_again(name):
    surface = load_formula_file(gallery()[name])
    uv, points, distance = offset(surface)
    lo, hi = np.array(surface.domain).T
    guess = uv + 1e-4 * (hi - lo) * np.random.default_rng(1).uniform(-1, 1, uv.shape)
    feet, found, foot = closest_point(surface, points, guess)
    assert found == pytest.approx(distance, rel=1e-3)
    assert foot == pytest.approx(surface.evaluate(feet)[0], abs=1e-12 * np.abs(foot).max())
    assert np.linalg.norm(points - foot, axis=1) == pytest.approx(found)


def test_error_falls_with_the_steps():
    surface = load_formula_file(gallery()["ellipsoid"])
    uv, points, distance = offset(surface)
    guess = uv + np.random.default_rng(1).uniform(-0.05, 0.05, uv.shape)
    worst = [
        np.abs(closest_point(surface, points, guess, steps)[1] / distance - 1).max()
        for steps in (1, 2, 3)
    ]
    assert worst[1] < 0.1 * worst[0] and worst[2] < 1e-6


def test_a_search_ends_where_its_steps_lead_nowhere():
    """At walls, which a nearest point may lie beyond, and where no shortened step is nearer."""
    surface = load_formula_file(gallery()["wavy"])
    (u0, u1), (v0, v1) = surface.domain
    blocks = []

    class Counted:
        name, domain, loops = "counted", surface.domain, ()

        def evaluate(self, uv, order=0):
            blocks.append(len(uv))
            return surface.evaluate(uv, order)

        def derivative_bounds(self, lo, hi):
            return None

    corner = surface.evaluate(np.array([[u1, v1]]))[0]
    beyond = corner + 0.3 * (corner - surface.evaluate(np.array([[u0, v0]]))[0])
    uv, _, _ = closest_point(Counted(), beyond, [[u1, v1]], steps=500)
    assert (uv > [u1, v1]).all()  # beyond the domain as far as it may be
    assert len(blocks) < 50


def test_brute_force_finds_nothing_nearer():
    surface = load_formula_file(gallery()["wavy"])
    uv, points, _ = offset(surface, count=50)
    _, found, _ = closest_point(surface, points, uv + 1e-3, steps=4)
    fraction = np.linspace(-0.05, 0.05, 41)
    near = np.stack(np.meshgrid(fraction, fraction), axis=-1).reshape(-1, 2)
    for place, point, distance in zip(uv, points, found):
        cloud = surface.evaluate(place + near)[0]
        assert distance <= np.linalg.norm(cloud - point, axis=1).min() * (1 + 1e-6)


@pytest.mark.parametrize("name", gallery())
def test_never_farther_than_the_guess(name):
    surface = load_formula_file(gallery()[name])
    lo, hi = np.array(surface.domain).T
    rng = np.random.default_rng(4)
    fraction = np.round(rng.uniform(0, 1, (300, 2)) * 4) / 4  # many on poles, sides and corners
    guess = lo + fraction * (hi - lo)
    start = surface.evaluate(guess)[0]
    points = start + rng.normal(0, 0.2 * np.ptp(start), start.shape)
    uv, distance, foot = closest_point(surface, points, guess, steps=5)
    assert np.isfinite(uv).all() and np.isfinite(foot).all()
    assert (distance <= np.linalg.norm(points - start, axis=1) * (1 + 1e-12)).all()
    margin = 0.0101 * (hi - lo)
    assert (uv >= lo - margin).all() and (uv <= hi + margin).all()


def test_points_on_the_surface_and_no_points():
    surface = load_formula_file(gallery()["torus"])
    uv = np.array([[1.0, 2.0], [3.0, 0.5]])
    found, distance, _ = closest_point(surface, surface.evaluate(uv)[0], uv)
    assert found.tolist() == uv.tolist() and distance.tolist() == [0, 0]
    empty = closest_point(surface, np.empty((0, 3)), np.empty((0, 2)))
    assert [len(part) for part in empty] == [0, 0, 0]
