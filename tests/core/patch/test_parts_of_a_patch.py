"""A large patch is worked on in parts: the same mesh for any number of threads."""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest
from naive.background import constant_background
from naive.triangulation import check_domain

import surfmesh as sm
from surfmesh._core import allow_threads
from surfmesh._core import patch as core
from surfmesh._core.patch import PatchEnd
from surfmesh._core.surfaces import plane
from surfmesh.geometry.differential.chart import Chart

SQUARE = ((0.0, 1.0), (0.0, 1.0))
SIZE, SIDE = 0.006, 167  # 65 thousand triangles: two parts
FINE, FINE_SIDE = 0.0034, 294  # 200 thousand: three, of which two are one thread's of two


class Stop(Exception):
    """Raised by a test."""


@contextmanager
def threads(count: int) -> Iterator[None]:
    before = allow_threads(count)
    try:
        yield
    finally:
        allow_threads(before)


def mesh(size=SIZE, side=SIDE, **hooks):
    x, y = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
    settings = core.PatchSettings(
        plane(SQUARE, np.zeros(3), x, y), Chart.uniform(SQUARE, (1.0, 1.0)).core,
        constant_background(size, 1.0, 1.0), box=(0, 0, 1, 1),
        expected=int(1.2 / size**2), **hooks,
    )  # fmt: skip
    t, zero = np.arange(side) / side, np.zeros(side)
    sides = [(t, zero), (zero + 1, t), (1 - t, zero + 1), (zero, 1 - t)]
    uv = np.concatenate([np.stack(side, axis=1) for side in sides])
    ring = np.stack([np.arange(len(uv)), np.roll(np.arange(len(uv)), -1)], axis=1).astype(np.int32)
    inner, nodes = np.empty((0, 2), np.int32), np.arange(len(uv))
    return core.mesh_loops(settings, uv, uv, ring, inner, nodes)


def test_any_number_of_threads_makes_the_same_mesh():
    made = []
    for count in (1, 2, 5):
        with threads(count):
            made.append(mesh(FINE, FINE_SIDE))
    for other in made[1:]:
        assert np.array_equal(made[0].mapped.points, other.mapped.points)
        assert np.array_equal(made[0].mapped.triangles, other.mapped.triangles)
    assert made[0].end == PatchEnd.DONE and len(made[0].mapped.triangles) > 190_000


def test_a_patch_in_parts_is_a_domain_whose_neighbours_are_near_in_memory():
    made = mesh()
    assert check_domain(made.domain.t, euler=1) is None
    triangles = made.mapped.triangles
    assert len(triangles) > 60_000
    apart = triangles.max(axis=1) - triangles.min(axis=1)
    assert np.median(apart) < 0.01 * triangles.max()


def test_a_surface_with_a_chord_is_the_same_for_any_number_of_threads():
    surface = sm.load("two_peaks")
    one, three = (sm.mesh(surface, sm.Sizing(chord=1.1e-3), jobs=jobs) for jobs in (1, 3))
    assert len(one.triangles) > 50_000
    assert np.array_equal(one.points, three.points)
    assert np.array_equal(one.triangles, three.triangles)


def test_what_a_hook_raises_stops_the_threads_too():
    passes: list[None] = []

    def before_pass():
        passes.append(None)
        if len(passes) == 3:
            raise Stop

    with threads(3), pytest.raises(Stop):
        mesh(before_pass=before_pass)
    assert len(passes) == 3
