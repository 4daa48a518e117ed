"""The nearest points of a set, beside a search through all of them."""

import numpy as np
import pytest

from surfmesh._core.space import PointTree


def nearest_one_by_one(points, place, count):
    distance = np.linalg.norm(points - place, axis=1)
    order = np.lexsort((np.arange(len(points)), distance))[:count]
    return distance[order], order


@pytest.mark.parametrize("size", [1, 7, 8, 9, 200])
@pytest.mark.parametrize("count", [1, 3])
def test_they_are_those_of_a_search_through_all(size, count):
    draw = np.random.default_rng(size)
    points, places = draw.integers(0, 6, (2, size, 3)).astype(float)  # many equally near
    distance, number = PointTree(points).nearest(places, count)
    assert distance.shape == number.shape == (size, min(count, size))
    for place, found, row in zip(places, distance, number):
        expected, order = nearest_one_by_one(points, place, count)
        assert np.allclose(found, expected, rtol=1e-15)
        assert row.tolist() == order.tolist()


@pytest.mark.parametrize(
    ("points", "said"), [(np.empty((0, 3)), "no points"), ([[0.0, np.nan, 0.0]], "not finite")]
)
def test_sets_without_nearest_points_are_refused(points, said):
    with pytest.raises(ValueError, match=said):
        PointTree(np.array(points))
