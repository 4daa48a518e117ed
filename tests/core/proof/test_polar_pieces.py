"""Triangles at a pole and their pieces, moved along rays: bounds against many points."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh._core.proof import polar_moves
from surfmesh.geometry.core_surface import as_core_surface

S, T = (x.ravel() for x in np.meshgrid(np.linspace(0, 1, 33), np.linspace(0, 1, 9)[1:]))


def ellipsoid(a, b, c, swapped=False):
    u, v = ("v", "u") if swapped else ("u", "v")
    formulas = f"{a}*sin({v})*cos({u})", f"{b}*sin({v})*sin({u})", f"{c}*cos({v})"
    ranges = (0, 2 * np.pi), (0, np.pi)
    first, second = ranges[::-1] if swapped else ranges
    return sm.ParametricSurface(*formulas, u=first, v=second)


def moved(surface, corners, base, value, swapped=False):
    """h (s, t), and the points of the triangle (s, t) it moves; both (33, 8, 3)."""
    b = np.stack([(1 - S) ** 2, 2 * S * (1 - S), S**2]).T @ base
    around, off = (b[:, 1], b[:, 0]) if swapped else (b[:, 0], b[:, 1])
    w = value + T * (off - value)
    uv = np.stack([w, around] if swapped else [around, w], axis=1)
    pole, first, last = corners
    flat = pole + T[:, None] * ((1 - S)[:, None] * (first - pole) + S[:, None] * (last - pole))
    return surface.evaluate(uv, 0)[0] - flat, flat


@settings(max_examples=30, deadline=None)
@given(
    a=st.floats(0.5, 2.0), b=st.floats(0.5, 2.0), c=st.floats(0.5, 2.0),
    u=st.floats(0.1, 4.0), step=st.floats(0.2, 1.4), size=st.floats(0.002, 0.4),
    other=st.floats(0.7, 1.4), bend=st.floats(-0.2, 0.1),
    swapped=st.booleans(), south=st.booleans(),
)  # fmt: skip
def test_no_pair_of_points_moves_apart_faster(a, b, c, u, step, size, other, bend, swapped, south):
    surface = ellipsoid(a, b, c, swapped)
    value, sign = (np.pi, -1.0) if south else (0.0, 1.0)
    w = value + sign * size * np.array([1.0, 0.5 * (1.0 + other) + 2.0 * bend, other])
    around = np.array([u, u + 0.5 * step, u + step])
    base = np.stack([w, around] if swapped else [around, w], axis=1)
    ends = surface.evaluate(base[[0, 2]], 0)[0]
    pole = surface.evaluate(np.array([[value, u] if swapped else [u, value]]), 0)[0]
    corners = np.concatenate([pole, ends])
    found = polar_moves(as_core_surface(surface), corners[None], base[None], not swapped, value)
    slope, away = found[0]
    h, x = moved(surface, corners, base, value, swapped)
    assert np.linalg.norm(h, axis=1).max() <= away
    k = np.random.default_rng(3).integers(len(h), size=(2, 3000))
    change = np.linalg.norm(h[k[0]] - h[k[1]], axis=1)
    apart = np.linalg.norm(x[k[0]] - x[k[1]], axis=1)
    assert (change <= slope * apart + 1e-13).all()
    if size < 0.02 and step > 0.5:
        assert slope <= 2.0 * (change[apart > 0] / apart[apart > 0]).max() + 0.2


def test_rays_that_cross_are_not_bounded():
    surface = ellipsoid(1.0, 1.0, 1.0)
    core = as_core_surface(surface)
    base = np.array([(0.0, 0.1), (1.2, 0.1), (1.0, 0.1)])
    corners = surface.evaluate(np.array([(0.0, 0.0), (0.0, 0.1), (1.0, 0.1)]), 0)[0]
    assert np.isinf(polar_moves(core, corners[None], base[None], True, 0.0)).all()
    beyond = base * (0.4, 1.0) - ((0.0, 0.0), (0.0, 0.3), (0.0, 0.0))
    assert np.isinf(polar_moves(core, corners[None], beyond[None], True, 0.0)).all()
