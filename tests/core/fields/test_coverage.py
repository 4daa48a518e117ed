"""The metric area of backgrounds against a dense sum."""

import numpy as np
import pytest
from naive.background import constant_background, looked_up, random_tree


def test_constant():
    h = np.array([[0.2, 0.05], [0.05, 0.1]])
    field = constant_background(h, 3.0, 2.0)
    assert field.metric_area(3.0, 2.0) == pytest.approx(6.0 / np.linalg.det(h))


@pytest.mark.parametrize("x1, y1", [(1.0, 1.0), (0.7, 1.0), (0.31, 0.12)])
def test_trees_cut_by_the_rectangle(x1, y1):
    tree = random_tree(1, 2, 1, 6)
    n = 160
    x, y = np.meshgrid((np.arange(n) + 0.5) / n * x1, (np.arange(n) + 0.5) / n * y1)
    a = np.array([looked_up(tree, *point) for point in zip(x.ravel(), y.ravel())])
    dense = (a[:, 0] * a[:, 2] - a[:, 1] ** 2).mean() * x1 * y1
    assert tree.metric_area(x1, y1) == pytest.approx(dense, rel=0.01)


def test_beyond_the_background_nothing_is_added():
    field = constant_background(0.5, 1.0, 1.0)
    assert field.metric_area(9.0, 9.0) == field.metric_area(1.0, 1.0) == pytest.approx(4.0)
