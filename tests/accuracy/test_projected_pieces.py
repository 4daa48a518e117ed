"""Spheres, cylinders and cones by their nearest points: nothing is farther than proved, poles and
apexes are places as all others, and what may not tile is left to the bounds over (u, v)."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh.accuracy import projected_pieces
from surfmesh.geometry.cad_surfaces.elementary import Cone, Cylinder, Sphere, Torus

SIDE = 12
WEIGHTS = np.array(
    [(i, j, SIDE - i - j) for i in range(SIDE + 1) for j in range(SIDE + 1 - i)]
) / float(SIDE)
FRAME = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
ORIGIN = np.array([3.0, -1.0, 0.5])
ANGLE = 0.6
APEX = -2.0 / np.sin(ANGLE)

SURFACES = {
    "sphere": Sphere(ORIGIN, *FRAME, 2.0, domain=((0.0, 6.3), (-1.6, 1.6))),
    "cylinder": Cylinder(ORIGIN, *FRAME, 1.5, domain=((0.0, 6.3), (-2.0, 2.0))),
    "cone": Cone(ORIGIN, *FRAME, 2.0, ANGLE, domain=((0.0, 6.3), (APEX, APEX + 5.0))),
    "cone below": Cone(ORIGIN, *FRAME, 2.0, ANGLE, domain=((0.0, 6.3), (APEX - 5.0, APEX))),
    "narrowing": Cone(ORIGIN, *FRAME, 2.0, -ANGLE, domain=((0.0, 6.3), (-5.0, -APEX))),
}


def projected(surface, corners, uv):
    """As near as can be."""
    return projected_pieces.projected(surface, corners, uv, np.zeros(len(corners)))


def distances(surface, points):
    """From the whole sphere, cylinder, or one half of the cone."""
    x, y, z = ((points - surface.origin) @ np.stack([surface.x, surface.y, surface.z]).T).T
    if isinstance(surface, Sphere):
        return np.abs(np.sqrt(x * x + y * y + z * z) - surface.radius)
    across = np.hypot(x, y)
    if isinstance(surface, Cylinder):
        return np.abs(across - surface.radius)
    z = np.abs(z + surface.radius / np.tan(surface.angle))
    return np.abs(across * np.cos(surface.angle) - z * abs(np.sin(surface.angle)))


def triangles_on(surface, seed, size, count=20):
    draw = np.random.default_rng(seed)
    low, high = np.array(surface.domain).T
    wide = size * (high - low)
    start = low + draw.uniform(0.0, 1.0, (count, 1, 2)) * (high - low - wide)
    uv = start + wide * draw.uniform(0.0, 1.0, (count, 3, 2))
    a, b = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    back = a[:, 0] * b[:, 1] < a[:, 1] * b[:, 0]
    uv[back] = uv[back][:, ::-1]
    return uv, surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)


@pytest.mark.parametrize("name", SURFACES)
@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), size=st.floats(0.005, 0.3))
def test_no_point_of_a_triangle_is_farther_than_proved(name, seed, size):
    surface = SURFACES[name]
    uv, corners = triangles_on(surface, seed, size)
    for one in range(len(uv)):
        found = projected(surface, corners[one : one + 1], uv[one : one + 1])
        if found is None:
            continue
        away = distances(surface, WEIGHTS @ corners[one]).max()
        assert away <= found.away[0]
        assert size > 0.1 or found.away[0] <= 1.05 * away + 1e-11


@pytest.mark.parametrize("name", SURFACES)
def test_how_fast_points_move_is_bounded(name):
    surface = SURFACES[name]
    uv, corners = triangles_on(surface, 4, 0.05)
    found = [projected(surface, corners[k : k + 1], uv[k : k + 1]) for k in range(len(uv))]
    draw = np.random.default_rng(1)
    assert sum(one is not None for one in found) > 10
    for one, triangle in zip(found, corners):
        if one is None:
            continue
        x = draw.dirichlet((1.0, 1.0, 1.0), 50) @ triangle
        moved = nearest(surface, x) - x
        changes = np.linalg.norm(moved[1:] - moved[:-1], axis=1)
        steps = np.linalg.norm(x[1:] - x[:-1], axis=1)
        assert (changes <= one.slope[0] * steps * (1 + 1e-9) + 1e-12).all()


def nearest(surface, points):
    frame = np.stack([surface.x, surface.y, surface.z])
    local = (points - surface.origin) @ frame.T
    outwards = local.copy()
    if not isinstance(surface, Sphere):
        outwards[:, 2] = 0.0
    distance = np.linalg.norm(outwards, axis=1, keepdims=True)
    outwards /= distance
    if not isinstance(surface, Cone):
        return points + (surface.radius - distance) * outwards @ frame
    z = local[:, 2:] + surface.radius / np.tan(surface.angle)
    sine, cosine = np.sin(surface.angle) * np.sign(z) * np.sign(surface.angle), np.cos(ANGLE)
    sine = np.abs(sine) * np.sign(z)
    normal = outwards * cosine - np.array([0.0, 0.0, 1.0]) * sine
    return points + (np.abs(z * sine) - distance * cosine) * normal @ frame


def fan(surface, pole, v, count=7):
    """Triangles round a pole or an apex at v = pole, with their other corners at v."""
    u = np.linspace(0.0, 2 * np.pi, count + 1)
    uv = np.array([[(a, pole), (a, v), (b, v)] for a, b in pairwise(u)])
    return uv, surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)


@pytest.mark.parametrize(
    ("name", "pole", "v"),
    [("sphere", np.pi / 2, 1.3), ("cone", APEX, APEX + 1), ("cone below", APEX, APEX - 1)],
)
def test_poles_and_apexes_are_proved(name, pole, v):
    surface = SURFACES[name]
    uv, corners = fan(surface, pole, v)
    found = projected(surface, corners, uv)
    away = distances(surface, (WEIGHTS @ corners).reshape(-1, 3)).max()
    assert found is not None and away <= found.away.max() <= 1.01 * away


def test_triangles_that_fold_over_each_other_are_left_to_others():
    surface = SURFACES["sphere"]
    uv, corners = fan(surface, np.pi / 2, 1.3)
    assert projected(surface, corners, uv) is not None
    uv[2], corners[2] = uv[2, ::-1].copy(), corners[2, ::-1].copy()
    assert projected(surface, corners, uv) is None


def test_corners_off_their_places_are_left_to_others():
    surface = SURFACES["cylinder"]
    uv, corners = triangles_on(surface, 3, 0.05, 5)
    assert projected(surface, corners, uv + [1.0, 0.0]) is None


def test_triangles_that_reach_round_the_axis_are_left_to_others():
    surface = SURFACES["cylinder"]
    uv = np.array([[(0.0, 0.0), (3.2, 0.0), (1.0, 1.0)]])
    corners = surface.evaluate(uv[0], 0)[0][None]
    assert projected(surface, corners, uv) is None


def test_other_surfaces_have_none():
    torus = Torus(ORIGIN, *FRAME, 2.0, 0.5, domain=((0.0, 6.3), (0.0, 6.3)))
    uv, corners = triangles_on(torus, 3, 0.05, 5)
    assert projected(torus, corners, uv) is None
    assert projected(sm.load("sphere"), corners, uv) is None
