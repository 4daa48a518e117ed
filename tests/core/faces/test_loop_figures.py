"""What the loops of a boundary are known again by."""

import numpy as np
import pytest

from surfmesh._core.faces import loop_figures
from surfmesh.meshing.faces.face_data import CoedgeNodes, boundary_of


def piece(points, sizes):
    points = np.array(points, float)
    return CoedgeNodes(points[:, :2].copy(), np.arange(len(points)), points, np.array(sizes, float))


def test_segments_lengths_and_sizes_of_each_loop():
    first = piece([[0, 0, 0], [3, 0, 0], [3, 4, 0]], [1, 2, np.inf])
    second = piece([[3, 4, 0], [0, 0, 0]], [1, 1])
    other = piece([[9, 9, 9], [9, 9, 7]], [0.5, 0.25])
    boundaries = [boundary_of([[first, second], [other]]), boundary_of([[other]])]
    figures, start = loop_figures(boundaries)
    assert start.tolist() == [0, 2, 3]
    assert figures == pytest.approx(np.array([[3, 12, 5, 4], [1, 2, 0.75, 2], [1, 2, 0.75, 2]]))
    assert len(loop_figures([])[0]) == 0
