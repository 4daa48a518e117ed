"""Meshes of faces joined into one: what they share are the numbers of nodes."""

import numpy as np
import pytest

from surfmesh._core.faces import FaceBoundary, FaceJoiner
from surfmesh.meshing.processors import allowed_threads

SHARED = np.arange(15.0).reshape(5, 3)
SIZES = np.array([1.0, np.inf, 3.0, 4.0, 5.0])


def boundary(numbers):
    """A loop of one coedge."""
    n, ends = len(numbers), np.array([len(numbers)], np.int32)
    return FaceBoundary(
        np.zeros((n, 2)), np.array(numbers), np.zeros((n, 3)), np.ones(n), ends,
        np.zeros(1, np.uint8), np.zeros(1), np.array([1], np.int32),
    )  # fmt: skip


def face(slots, triangles, first=100.0):
    """Points, slots, sizes, triangles, uv, uv_triangles; an image to each point."""
    n = len(slots)
    triangles = np.array(triangles, np.int32).reshape(-1, 3)
    points = first + np.arange(3.0 * n).reshape(n, 3)
    return points, np.array(slots), 0.5 + np.arange(n), triangles, points[:, :2].copy(), triangles


def test_faces_share_nodes_by_number():
    joiner = FaceJoiner()
    one = face([0, 1, -1, 2, -1], [[0, 1, 2], [1, 3, 2]])  # the last point has no triangle
    other = face([1, 0, -1], [[0, 1, 2]], 200.0)
    joiner.add(*one, boundary([0, 1, 4]), 3, False)
    joiner.add(*other, boundary([0, 4]), 7, True)
    found = joiner.joined(SHARED, SIZES)
    assert found.rank.tolist() == [0, 1, -1, -1, 2]
    assert np.array_equal(found.points, [*SHARED[[0, 1, 4]], one[0][2], other[0][2]])
    assert found.sizes.tolist() == [0.5, 1.5, 0.5, 2.5, 2.5]
    assert found.triangles.tolist() == [[0, 1, 3], [1, 2, 3], [2, 4, 0]]
    assert found.face_ids.tolist() == [3, 3, 7] and found.face_ids.dtype == np.int32
    assert np.array_equal(found.uv, np.concatenate([one[4], other[4]]))
    assert found.uv_triangles.tolist() == [[0, 1, 2], [1, 3, 2], [5, 7, 6]]
    nothing = FaceJoiner().joined(SHARED, SIZES)
    assert nothing.triangles.shape == (0, 3) and nothing.rank.tolist() == [-1] * 5


def test_what_does_not_fit_is_refused():
    joiner, rim = FaceJoiner(), boundary([0, 1, 4])
    with pytest.raises(ValueError, match="slots"):
        joiner.add(*face([0, 1, 3], [[0, 1, 2]]), rim, 0, False)
    with pytest.raises(ValueError, match="slots"):
        joiner.add(*face([0, 1, -2], [[0, 1, 2]]), rim, 0, False)
    with pytest.raises(ValueError, match="triangles"):
        joiner.add(*face([0, 1, 2], [[0, 1, 3]]), rim, 0, False)
    with pytest.raises(TypeError):
        joiner.add(*face([0, 1, 2], [[0, 1, 2]]), None, 0, False)
    joiner.add(*face([0, 1, 2], [[0, 1, 2]]), boundary([0, 1, 5]), 0, False)
    with pytest.raises(ValueError, match="numbers"):
        joiner.joined(SHARED, SIZES)


def test_many_faces_are_the_same_with_any_number_of_threads():
    rng = np.random.default_rng(3)
    joiner, shared = FaceJoiner(), rng.random((4000, 3))
    for number in range(900):
        n = int(rng.integers(3, 400))
        slots = rng.integers(-1, 30, n)
        triangles = rng.integers(0, n, (n, 3))
        rim = boundary(rng.integers(0, 4000, 30))
        joiner.add(*face(slots, triangles), rim, number, number % 3 == 0)
    made = []
    for threads in (1, 2, 7):
        with allowed_threads(threads):
            found = joiner.joined(shared, np.full(4000, np.inf))
        arrays = ("rank", "points", "sizes", "triangles", "face_ids", "uv", "uv_triangles")
        made.append([getattr(found, name).tobytes() for name in arrays])
    assert made[0] == made[1] == made[2]
