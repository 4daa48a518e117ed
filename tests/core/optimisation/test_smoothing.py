"""One Newton step of a vertex, on single stars in the plane."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive.metric import alpha, star_energy

from surfmesh._core import NIL
from surfmesh._core.optimisation import Stars, SurfaceFrames, newton_step
from surfmesh._core.triangulation import Triangulation


def flat_star(ring, sizes, centre=(0.0, 0.0), size=1.0):
    """A vertex 0 with its star, embedded in the plane z = 0."""
    n = len(ring)
    tri, adj = np.empty((n, 3), np.int32), np.empty((n, 3), np.int32)
    for k in range(n):
        tri[k] = 0, k + 1, (k + 1) % n + 1
        adj[k] = 3 * ((k - 1) % n) + 2, NIL, 3 * ((k + 1) % n)
    sizes = np.array([size, *sizes])
    xy = np.concatenate([[centre], ring])
    tensors = np.column_stack([sizes, np.zeros(n + 1), sizes])
    no = np.zeros(3 * n, np.uint8)
    t = Triangulation(xy, tensors, tri.ravel(), adj.ravel(), no[:n], no)
    s = SurfaceFrames(n + 1)
    s.size[:] = sizes
    s.point[:, :2] = xy
    s.normal[:] = 0.0, 0.0, 1.0
    s.tangent_map[:] = np.eye(2, 3).ravel() / sizes[:, None]
    return t, s, Stars(t)


def random_ring(seed, n, jitter):
    rng = np.random.default_rng(seed)
    angle = 2 * np.pi * (np.arange(n) + rng.uniform(-jitter, jitter, n)) / n
    r = 1 + rng.uniform(-jitter, jitter, n)
    return np.stack([r * np.cos(angle), r * np.sin(angle)], axis=1), rng.uniform(0.8, 1.25, n)


@settings(max_examples=60)
@given(st.integers(0, 2**31), st.integers(4, 9), st.sampled_from([0.3, 2.0, 4.0]))
def test_newton_steps_lower_the_energy(seed, n, stiffness):
    ring, sizes = random_ring(seed, n, 0.25)
    centre = np.random.default_rng(seed).uniform(-0.15, 0.15, 2)
    x, y, worst = newton_step(*flat_star(ring, sizes, centre), 0, stiffness)
    turned = [alpha(centre, ring[k], ring[(k + 1) % n]) for k in range(n)]
    assert worst == pytest.approx(min(*turned, 1.0))

    def energy(place):
        return star_energy(place, ring, 1.0, sizes, stiffness)

    eps = 1e-6
    gradient = np.array(
        [(energy(centre + eps * d) - energy(centre - eps * d)) / (2 * eps) for d in np.eye(2)]
    )
    step = np.array([x, y])
    assert np.linalg.norm(step) <= 0.3 + 1e-12
    assert gradient @ step <= 1e-7
    assert energy(centre + step) <= energy(centre) + 1e-9


def test_newton_stays_at_the_minimum_and_converges_to_it():
    ring, sizes = random_ring(3, 6, 0.2)
    place = np.array([0.1, -0.1])
    for _ in range(12):
        x, y, _ = newton_step(*flat_star(ring, sizes, place), 0, 2.0)
        place = place + (x, y)
    assert np.hypot(x, y) < 1e-4
    around = [star_energy(place + 0.01 * d, ring, 1.0, sizes, 2.0) for d in np.eye(2)]
    assert star_energy(place, ring, 1.0, sizes, 2.0) < min(around)
    hexagon = np.stack([np.cos(np.arange(6) * np.pi / 3), np.sin(np.arange(6) * np.pi / 3)], 1)
    x, y, worst = newton_step(*flat_star(hexagon, np.ones(6)), 0, 2.0)
    assert np.hypot(x, y) < 1e-12 and worst == pytest.approx(1.0)


def test_an_inverted_star_is_not_moved():
    ring, sizes = random_ring(1, 6, 0.1)
    assert newton_step(*flat_star(ring, sizes, (1.5, 0.0)), 0, 2.0) == (0.0, 0.0, -1.0)
