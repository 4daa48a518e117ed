"""Limits near points: the nearest few decide, in every direction or by tensors."""

import numpy as np
import pytest

from surfmesh._core.sizing import SizeLimits

RNG = np.random.default_rng(3)
POINTS, SIZES = RNG.normal(size=(300, 3)), RNG.uniform(0.1, 1.0, 300)
PLACES = RNG.normal(size=(200, 3))
NEAREST = 8


def nearest(places):
    """Distances and numbers (n, k) of the nearest points, the slow way."""
    away = np.linalg.norm(places[:, None] - POINTS, axis=2)
    rows = np.argsort(away, axis=1, kind="stable")[:, :NEAREST]
    return np.take_along_axis(away, rows, 1), rows


def tensors():
    a = RNG.normal(size=(len(POINTS), 3, 3))
    return np.einsum("nij,nkj->nik", a, a)


def packed(w):
    return np.ascontiguousarray(w[:, [0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2]])


def test_the_nearest_points_decide():
    away, rows = nearest(PLACES)
    found = SizeLimits(POINTS, SIZES, 0.2).at(PLACES)
    np.testing.assert_allclose(found, (SIZES[rows] + 0.2 * away).min(axis=1), rtol=1e-14)


def test_fewer_points_than_may_decide():
    found = SizeLimits(POINTS[:2], SIZES[:2], 0.5).at(PLACES)
    away = np.linalg.norm(PLACES[:, None] - POINTS[:2], axis=2)
    np.testing.assert_allclose(found, (SIZES[:2] + 0.5 * away).min(axis=1), rtol=1e-14)


def test_points_in_one_place_take_the_room_of_others():
    twice = np.concatenate([POINTS, POINTS])
    w = packed(tensors())
    normals = np.tile([0.0, 0.0, 1.0], (len(POINTS), 1))
    one = SizeLimits(POINTS, SIZES, 0.0, w).tightest(POINTS, normals)
    two = SizeLimits(twice, np.tile(SIZES, 2), 0.0, np.tile(w, (2, 1))).tightest(POINTS, normals)
    assert (one[0] <= two[0]).all()  # of eight points only half are different ones


def test_tensors_hold_along_directions():
    w = tensors()
    away, rows = nearest(PLACES)
    directions = RNG.normal(size=(1, len(PLACES), 3))
    directions /= np.linalg.norm(directions, axis=2)[..., None]
    limits = SizeLimits(POINTS, SIZES, 0.3, packed(w))
    length = np.linalg.norm(np.einsum("nkij,nj->nki", w[rows], directions[0]), axis=2)
    wanted = (1.0 / length + 0.3 * away).min(axis=1)
    np.testing.assert_allclose(limits.along(PLACES, directions)[0], wanted, rtol=1e-12)


def test_in_the_tightest_direction_the_form_is_largest():
    w = tensors()[:1]
    limits = SizeLimits(POINTS[:1], SIZES[:1], 0.3, packed(w))
    normals = RNG.normal(size=PLACES.shape)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    sizes, directions = limits.tightest(PLACES, normals)
    np.testing.assert_allclose(np.einsum("ij,ij->i", directions, normals), 0.0, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1.0, rtol=1e-12)
    grown = 0.3 * np.linalg.norm(PLACES - POINTS[0], axis=1)
    largest = np.einsum("ni,ij,nj->n", directions, w[0], directions)
    np.testing.assert_allclose(sizes, 1.0 / largest + grown, rtol=1e-9)
    across = np.cross(normals, directions)
    assert (np.einsum("ni,ij,nj->n", across, w[0], across) <= largest * (1.0 + 1e-9)).all()


@pytest.mark.parametrize(
    "arguments",
    [
        (np.empty((0, 3)), np.empty(0), 0.2),
        (POINTS, SIZES[1:], 0.2),
        (POINTS, SIZES, 0.2, np.zeros((2, 6))),
    ],
)
def test_arrays_that_do_not_fit_are_refused(arguments):
    with pytest.raises(ValueError, match=r"points|sizes|metric_root_3d"):
        SizeLimits(*arguments)
