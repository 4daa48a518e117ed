"""Deviation of a triangle on a quadric, by dense search."""

import numpy as np
import pytest
from naive.searched_deviation import searched_deviation

from surfmesh.sizing.rules.curvature_size import (
    ALIKE_RESERVE,
    DEVIATION_RESERVE,
    angle_size,
    chord_size,
    deviation_factor,
    principal_angle_sizes,
)


@pytest.mark.parametrize("ratio", [1.0, 0.7, 0.5, 0.3, 0.0, -0.3, -0.5, -1.0])
@pytest.mark.parametrize("k", [1.0, -3.0])
def test_factor_is_the_worst_direction_to_four_percent(ratio, k):
    found = float(deviation_factor(np.array([k]), np.array([ratio * k]))[0])
    assert found == float(deviation_factor(np.array([ratio * k]), np.array([k]))[0])
    expected = searched_deviation(k, ratio * k)
    assert expected / 1.043 <= found <= 1.001 * expected


def test_on_a_sphere_it_is_a_sixth():
    """h^2 k / 6 to second order, against the exact distance of the triangle's centre."""
    (factor,) = deviation_factor(np.array([0.5]), np.array([0.5]))
    assert factor == pytest.approx(0.5 / 6)
    h, radius = 0.02, 2.0
    exact = radius - np.sqrt(radius**2 - h**2 / 3)
    assert factor * h**2 == pytest.approx(exact, rel=1e-4)


def test_chord_size_keeps_a_reserve_for_larger_triangles():
    k1, k2 = np.random.default_rng(1).normal(size=(2, 50))
    h = chord_size(k1, k2, 1e-4)
    alike = np.minimum(abs(k1), abs(k2)) / np.maximum(abs(k1), abs(k2))
    saddle = 0.70
    both = np.where(k1 * k2 < 0, saddle, ALIKE_RESERVE)
    reserve = DEVIATION_RESERVE + (both - DEVIATION_RESERVE) * alike
    np.testing.assert_allclose(deviation_factor(k1, k2) * h**2, reserve * 1e-4)
    assert 0.5 < DEVIATION_RESERVE < ALIKE_RESERVE < 1.0


def test_limits():
    assert np.isinf(chord_size(np.zeros(1), np.zeros(1), 0.1)[0])
    assert chord_size(np.array([1e9]), np.zeros(1), 0.1)[0] == 0.2  # never below 2 chord
    assert np.isinf(angle_size(np.zeros(1), np.zeros(1), 10.0)[0])
    assert np.isinf(principal_angle_sizes(np.zeros(1), np.zeros(1), 10.0, 5.0)).all()
    shorter, longer = principal_angle_sizes(np.ones(1), np.zeros(1), 10.0, 5.0)
    assert np.isfinite(shorter[0]) and np.isinf(longer[0])


def test_angle_size_on_a_sphere():
    """Normals of two equilateral triangles that share an edge, exactly, stay below the angle."""
    angle = 10.0
    (h,) = angle_size(np.array([1.0]), np.array([1.0]), angle)
    height = np.sqrt(1 - h**2 / 3)  # of a triangle's plane over the centre of the unit sphere
    half = np.arctan2(h / (2 * np.sqrt(3)), height)  # from its centre to the middle of an edge
    assert 0.7 * angle < np.degrees(2 * half) < angle
