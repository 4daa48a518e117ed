"""How far segments between samples lie off their edges."""

import numpy as np
import pytest

from surfmesh._core.space import edge_sags


def test_a_circle_lies_off_its_segments_by_their_sagitta():
    angle = np.linspace(0.0, 2 * np.pi, 129)
    circle = 3.0 * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    line = np.linspace([0.0, 0.0, 0.0], [1.0, 2.0, 3.0], 33)
    points = np.concatenate([circle, line, line[:1]])
    found = edge_sags(points, np.array([0, 129, 162, 162, 163]))
    assert found == pytest.approx([3.0 * (1 - np.cos(np.pi / 128)), 0.0, 0.0, 0.0], rel=1e-3)


def test_no_offsets_are_refused():
    with pytest.raises(ValueError, match="first"):
        edge_sags(np.zeros((3, 3)), np.array([0, 4]))
