"""Narrow faces: a strip of a thread is meshed with few cells, few triangles and no folds."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh._core.fields import root_grid
from surfmesh.sizing.rules.size_limits import SizeLimits, along_lines


@pytest.mark.parametrize(
    ("width", "height", "cells"), [(1.0, 1.0, 64), (153.5, 0.62, 128), (0.125, 170.0, 128)]
)
def test_root_cells_are_not_long(width, height, cells):
    nx, ny = root_grid((width, height), cells)
    assert max(width / nx * ny / height, height / ny * nx / width) < 7.0
    assert root_grid((height, width), cells) == (ny, nx)


def test_no_row_of_root_cells_is_too_long():
    assert max(root_grid((1e9, 1.0), 2304)) == 2048


@pytest.mark.parametrize("ratio", [5.0, 20.0])
def test_no_triangle_of_a_helical_strip_stands_on_its_edge(ratio):
    """The crest of a thread of radius 3, pitch 1, width 1/8: its two edges need 52 segments a
    turn of all within this chord, and nothing is needed between them."""
    strip = sm.ParametricSurface(
        "3*cos(u)", "3*sin(u)", "u/(2*pi) + v", u=(0.0, 40.0), v=(0.0, 0.125)
    )
    chord = 0.0189
    report = sm.check(sm.mesh(strip, sm.Sizing(chord=chord, anisotropy=ratio)))
    assert report.folded == 0
    assert report.deviation_max < chord
    least = 2.0 * 40.0 * 3.0 / np.sqrt(8.0 * 3.0 * chord)
    assert report.triangles < 1.5 * least


def test_limits_in_several_directions_are_those_in_each():
    rng = np.random.default_rng(5)
    points, sizes = rng.random((40, 3)), rng.uniform(0.1, 1.0, 40)
    lines = rng.normal(size=(40, 3))
    lines /= np.linalg.norm(lines, axis=1)[:, None]
    limits = SizeLimits(points, sizes, 0.2, metric_root_3d=along_lines(lines, sizes))
    at = rng.random((7, 3))
    ways = rng.normal(size=(2, 7, 3))
    ways /= np.linalg.norm(ways, axis=2)[..., None]
    found = limits.along(at, ways)
    # naively, over the eight nearest
    for p, way, size in zip(at, ways[0], found[0]):
        d = np.linalg.norm(points - p, axis=1)
        near = np.argsort(d)[:8]
        along = np.abs(lines[near] @ way) / sizes[near]
        assert size == pytest.approx((1.0 / along + 0.2 * d[near]).min())


def test_the_tightest_size_is_the_smallest_in_any_direction():
    rng = np.random.default_rng(6)
    lines = rng.normal(size=(40, 3))
    lines /= np.linalg.norm(lines, axis=1)[:, None]
    points, sizes = rng.random((40, 3)), rng.uniform(0.1, 1.0, 40)
    limits = SizeLimits(points, sizes, 0.2, metric_root_3d=along_lines(lines, sizes))
    at, normals = rng.random((5, 3)), np.tile([0.0, 0.0, 1.0], (5, 1))
    tight, direction = limits.tightest(at, normals)
    np.testing.assert_allclose(np.linalg.norm(direction, axis=1), 1.0)
    np.testing.assert_allclose(direction[:, 2], 0.0, atol=1e-12)
    turns = np.radians(np.arange(0.0, 180.0, 0.5))
    ways = np.stack([np.cos(turns), np.sin(turns), 0.0 * turns], axis=1)
    around = limits.along(at, np.repeat(ways[:, None], 5, axis=1))
    # a size along a line is seen by its part in the tangent plane, squared: never more than it
    assert (tight >= around.min(axis=0) - 1e-3).all()
    assert (limits.along(at, direction[None])[0] <= tight + 1e-9).all()
