"""By what faces are alike: segments, lengths and sizes of their loops, and their areas."""

import numpy as np
import pytest

from surfmesh._core.faces import alike_faces, fewest_triangles
from surfmesh.meshing.faces.face_data import CoedgeNodes, boundary_of


def piece(points, sizes):
    points = np.array(points, float)
    return CoedgeNodes(points[:, :2].copy(), np.arange(len(points)), points, np.array(sizes, float))


FIRST = piece([[0, 0, 0], [3, 0, 0], [3, 4, 0]], [1, 2, np.inf])
SECOND = piece([[3, 4, 0], [0, 0, 0]], [1, 1])
OTHER = piece([[9, 9, 9], [9, 9, 7]], [0.5, 0.25])
MOVED = piece([[1, 9, 9], [1, 9, 7 - 1e-9]], [0.5, 0.25 + 1e-12])
FINER = piece([[9, 9, 9], [9, 9, 7]], [0.5, 0.2499])


def alike(loops, areas=None, sorts=None):
    boundaries = [boundary_of(own) for own in loops]
    areas = np.ones(len(loops)) if areas is None else np.array(areas, float)
    sorts = np.zeros(len(loops), int) if sorts is None else np.array(sorts)
    return alike_faces(boundaries, areas, sorts)


def test_what_the_loops_say():
    loops = [[[FIRST, SECOND], [OTHER]], [[OTHER]], [[piece([[0] * 3, [1] * 3], [np.inf] * 2)]]]
    fewest, size, first, of = alike(loops)
    assert fewest.tolist() == [4.0, -1.0, -1.0]  # segments + 2 loops - 4
    assert size == pytest.approx([5.75 / 6.0, 0.375, np.inf])
    assert first.tolist() == of.tolist() == [0, 1, 2]
    assert np.array_equal(fewest_triangles([boundary_of(own) for own in loops]), fewest)


def test_alike_are_those_that_agree_to_six_digits_in_whatever_order_their_loops_are():
    loops = [[[OTHER], [FIRST]], [[FINER], [FIRST]], [[FIRST], [MOVED]], [[OTHER]]]
    *_, first, of = alike(loops)
    assert of.tolist() == [0, 1, 0, 2] and first.tolist() == [0, 1, 3]


def test_areas_and_sorts_tell_faces_apart():
    same = [[[OTHER]]] * 4
    assert alike(same)[3].tolist() == [0, 0, 0, 0]
    assert alike(same, areas=[1.0, 1.0 + 1e-9, 1.001, 0.0])[3].tolist() == [0, 0, 1, 2]
    assert alike(same, sorts=[5, 6, 5, 7])[3].tolist() == [0, 1, 0, 2]


def test_nothing_and_what_does_not_fit():
    assert [len(part) for part in alike([])] == [0, 0, 0, 0]
    with pytest.raises(ValueError, match="areas"):
        alike([[[OTHER]]], areas=[1.0, 2.0])
    with pytest.raises(TypeError):
        alike_faces([None], np.ones(1), np.zeros(1, int))
