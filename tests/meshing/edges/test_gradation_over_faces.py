"""Sizes of edges that grow straight across faces, and what becomes of them in a mesh."""

import numpy as np
import pytest

from surfmesh._core.edges import graded_along_edges, graded_over_faces
from surfmesh.meshing.processors import allowed_threads

SLOPE = 0.2
LEAST_STEP = 1e-12


def network(*edges):
    """Straight edges ((start, end), samples), each with vertices of its own."""
    lines = [np.linspace(*np.array(ends, float), count) for ends, count in edges]
    first = np.cumsum([0, *map(len, lines)])
    ends = np.arange(2 * len(edges)).reshape(-1, 2)
    return np.concatenate(lines), first, ends


def graded(points, first, ends, sizes, faces):
    rows = np.cumsum([0, *map(len, faces)])
    edges = np.concatenate([np.empty(0, np.int64), *map(np.asarray, faces)]).astype(np.int64)
    return graded_over_faces(
        points, sizes, first, ends, 2 * len(ends), rows, edges, SLOPE, LEAST_STEP
    )


def by_all_pairs(points, first, sizes, faces):
    """Slow twin: segments of edges as fine rows of points, faces until nothing changes."""
    found = sizes.copy()
    for _ in range(len(faces) + 1):
        for edges in faces:
            places, values = [], []
            for edge in edges:
                own = slice(first[edge], first[edge + 1])
                t = np.linspace(0, 1, 40 * (own.stop - own.start))
                old = np.linspace(0, 1, own.stop - own.start)
                line = [np.interp(t, old, axis) for axis in points[own].T]
                places.append(np.stack(line, axis=1))
                values.append(np.interp(t, old, found[own]))
            place, value = np.concatenate(places), np.concatenate(values)
            for edge in edges:
                for k in range(first[edge], first[edge + 1]):
                    way = np.linalg.norm(place - points[k], axis=1)
                    found[k] = min(found[k], (value + SLOPE * way).min())
    return found


def test_sizes_pass_from_face_to_face():
    """Three parallel edges, two faces between them: the third hears of the first."""
    points, first, ends = network(
        (((0, 0, 0), (4, 0, 0)), 33), (((0, 1, 0), (4, 1, 0)), 33), (((0, 1, 2), (4, 1, 2)), 129)
    )
    sizes = np.full(len(points), 2.0)
    sizes[10] = 0.1
    faces = [[0, 1], [1, 2]]
    along = graded_along_edges(points, sizes, first, ends, 6, SLOPE, LEAST_STEP)
    assert (along[first[1] :] == 2.0).all()  # no vertex joins them
    found = graded(points, first, ends, along, faces)
    nearest = first[1] + 10, first[2] + 40
    assert found[nearest[0]] == pytest.approx(0.1 + SLOPE * 1, rel=0.03)
    assert found[nearest[1]] == pytest.approx(0.1 + SLOPE * 3, rel=0.03)
    expected = by_all_pairs(points, first, along, faces)
    assert np.abs(found / expected - 1.0).max() < 0.03  # a few samples for each size


def test_random_edges_as_all_pairs_have_them():
    rng = np.random.default_rng(7)
    for _ in range(6):
        lines = [(rng.random((2, 3)), int(count)) for count in rng.integers(2, 40, 5)]
        points, first, ends = network(*lines)
        sizes = rng.random(len(points)) ** 3 + 0.02
        sizes = graded_along_edges(points, sizes, first, ends, 10, SLOPE, LEAST_STEP)
        faces = [[0, 1, 2], [2, 3], [3, 4]]
        found = graded(points, first, ends, sizes, faces)
        expected = by_all_pairs(points, first, sizes, faces)
        assert np.abs(found / expected - 1.0).max() < 0.03


def test_what_has_no_faces_is_graded_along_edges():
    points, first, ends = network((((0, 0, 0), (1, 0, 0)), 5), (((0, 0.1, 0), (1, 0.1, 0)), 5))
    sizes = np.array([0.01, 1, 1, 1, 1, 1, 1, 1, 1, 1.0])
    along = graded_along_edges(points, sizes, first, ends, 4, SLOPE, LEAST_STEP)
    assert np.array_equal(graded(points, first, ends, sizes, []), along)
    assert np.array_equal(graded(points, first, ends, sizes, [[0], [1]]), along)


def test_wrong_faces_are_refused():
    points, first, ends = network((((0, 0, 0), (1, 0, 0)), 5))
    with pytest.raises(ValueError, match="edges_of_face"):
        graded(points, first, ends, np.ones(5), [[1]])
    with pytest.raises(ValueError, match="first_of_face"):
        graded_over_faces(
            points, np.ones(5), first, ends, 2, np.empty(0, np.int64), np.empty(0, np.int64),
            SLOPE, LEAST_STEP,
        )  # fmt: skip


def test_threads_cross_the_same_faces_where_most_lower_nothing():
    rng = np.random.default_rng(12)
    corners = rng.random((900, 3)) * (90.0, 90.0, 1.0)
    points, first, ends = network(*(((c, c + rng.random(3)), 9) for c in corners))
    sizes = np.repeat(np.where(rng.random(900) < 0.03, 0.1, 3.0), 9)
    order = np.lexsort(np.floor(corners[:, :2] / 10.0).T)
    faces = [order[k : k + 12] for k in range(0, 900, 10)]  # two edges in common with the next
    made = []
    for threads in (1, 2, 7):
        with allowed_threads(threads):
            made.append(graded(points, first, ends, sizes, faces))
    changed = np.array([(made[0] < sizes)[9 * own[0] : 9 * own[0] + 9].any() for own in faces])
    assert 0.1 < changed.mean() < 0.9
    assert made[0].tobytes() == made[1].tobytes() == made[2].tobytes()


def test_sizes_are_the_same_with_any_number_of_threads():
    rng = np.random.default_rng(11)
    corners = rng.random((700, 3)) * (40.0, 40.0, 1.0)
    points, first, ends = network(*(((c, c + rng.random(3)), 80) for c in corners))
    sizes = np.repeat(rng.uniform(0.05, 3.0, 700), 80)
    faces = np.array_split(rng.permutation(700), 9)
    made = []
    for threads in (1, 2, 7):
        with allowed_threads(threads):
            made.append(graded(points, first, ends, sizes, faces))
    assert (made[0] < sizes).mean() > 0.5
    assert all(np.array_equal(other, made[0]) for other in made[1:])
