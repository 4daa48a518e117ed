"""The least number of triangles that a chord needs, against closed forms and a dense search."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh._core.sizing import least_densities, least_segments

BOWL, SADDLE = 2 / (3 * np.sqrt(3)), 1 / (2 * np.sqrt(5))


def report_of(name: str, chord: float, **options: object) -> sm.Report:
    return sm.check(sm.mesh(sm.load(name), sm.Sizing(chord=chord, **options)))


def midpoints(low: float, high: float, count: int = 400) -> tuple[np.ndarray, float]:
    step = (high - low) / count
    return low + step * (np.arange(count) + 0.5), step


def test_of_a_sphere() -> None:
    report = report_of("sphere", 2e-3)
    exact = BOWL * 4 * np.pi / 2e-3
    assert report.least_triangles == pytest.approx(exact, rel=0.01)
    assert report.efficiency == report.least_triangles / report.triangles
    # on a sphere the least are equilateral
    assert report.equilateral_triangles == pytest.approx(report.least_triangles, rel=1e-3)
    assert "times the least that triangles of any shape need" in str(report)


def test_of_a_torus() -> None:
    small, large = 0.3, 1.0
    x, y, z = "(1 + 0.3*cos(v))*cos(u)", "(1 + 0.3*cos(v))*sin(u)", "0.3*sin(v)"
    surface = sm.ParametricSurface(x, y, z, (0, 2 * np.pi), (0, 2 * np.pi))
    v, step = midpoints(0.0, 2 * np.pi, 4000)
    sign = np.where(np.cos(v) > 0, BOWL, SADDLE)
    root = np.sqrt(np.abs(np.cos(v)) * small * (large + small * np.cos(v)))
    report = sm.check(sm.mesh(surface, sm.Sizing(chord=2e-3)))
    exact = 2 * np.pi * float((sign * root).sum()) * step / 2e-3
    assert report.least_triangles == pytest.approx(exact, rel=0.01)
    assert report.least_triangles < report.equilateral_triangles < report.triangles


def test_of_a_saddle() -> None:
    # z = x y: sqrt |K| dA = dx dy / sqrt(1 + x^2 + y^2)
    surface = sm.ParametricSurface("u", "v", "u*v", (-1, 1), (-1, 1))
    x, step = midpoints(-1.0, 1.0)
    exact = SADDLE * float((1 / np.sqrt(1 + x[:, None] ** 2 + x**2)).sum()) * step**2 / 1e-3
    report = sm.check(sm.mesh(surface, sm.Sizing(chord=1e-3)))
    assert report.least_triangles == pytest.approx(exact, rel=0.01)
    balanced = sm.check(sm.mesh(surface, sm.Sizing(chord=1e-3, vertices="balanced")))
    factor = np.sqrt(3) / 8 / SADDLE
    assert balanced.least_triangles == pytest.approx(exact * factor, rel=0.01)
    assert balanced.equilateral_triangles is None


def test_rims_decide_on_a_cylinder() -> None:
    surface = sm.ParametricSurface("2*cos(u)", "2*sin(u)", "v", (0, 2 * np.pi), (0, 3))
    report = sm.check(sm.mesh(surface, sm.Sizing(chord=1e-3)))
    segments = 2 * np.pi * 2 * np.sqrt(0.5 / (8 * 1e-3))
    assert report.least_triangles == pytest.approx(2 * segments, rel=2e-3)
    area = 2 * np.pi * 2 * 3
    assert report.equilateral_triangles == pytest.approx(0.2641 * 0.5 * area / 1e-3, rel=5e-3)
    stretched = sm.check(sm.mesh(surface, sm.Sizing(chord=1e-3, anisotropy=100)))
    assert stretched.least_triangles == pytest.approx(2 * segments, rel=5e-3)
    assert stretched.equilateral_triangles is None and stretched.efficiency > 0.7


def test_nothing_is_said_without_a_chord_or_of_quadratic_triangles() -> None:
    assert report_of("sphere", 0.05, order=2).least_triangles is None
    plain = sm.check(sm.mesh(sm.load("sphere"), sm.Sizing(size=0.3)))
    assert plain.least_triangles is None and plain.efficiency is None
    assert plain.equilateral_triangles is None


@pytest.mark.parametrize("ratio", [-1.0, -0.62, -0.3, 0.0, 0.33, 0.81, 1.0])
def test_equilateral_triangles_against_a_dense_search(ratio: float) -> None:
    """The mean over directions of the largest distance to z = (x^2 + ratio y^2) / 2."""
    at = np.linspace(0.0, 1.0, 41)
    weights = np.array([(a, b, 1 - a - b) for a in at for b in at if a + b <= 1 + 1e-12])
    largest = []
    for turn in midpoints(0.0, np.pi / 3, 120)[0]:
        angle = turn + np.array([0.0, 2.0, 4.0]) * np.pi / 3
        corners = np.column_stack([np.cos(angle), np.sin(angle)]) / np.sqrt(3)  # sides of 1
        form = np.array([0.5, 0.5 * ratio])
        linear = weights @ (corners**2 @ form)
        largest.append(np.abs(linear - (weights @ corners) ** 2 @ form).max())
    found = least_densities(np.array([1.0]), np.array([ratio]), 1e-6, False)[1] * 1e-6
    assert float(found[0]) == pytest.approx(4 / np.sqrt(3) * np.mean(largest), rel=5e-3)


def test_segments_of_lines() -> None:
    angle = np.linspace(0.0, 2 * np.pi, 40, endpoint=False)
    circle = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    exact = 2 * np.pi / np.sqrt(8e-3)
    assert least_segments(circle, True, 1e-3, False) == pytest.approx(exact)
    assert least_segments(circle, True, 1e-3, True) == pytest.approx(exact / np.sqrt(2))
    assert least_segments(circle[:21], False, 1e-3, False) == pytest.approx(exact / 2)
    straight = np.column_stack([angle, angle, angle])
    assert least_segments(straight, False, 1e-3, False) == 1.0
    assert least_segments(circle, True, 10.0, False) == 3.0
    assert least_segments(np.zeros((5, 3)), False, 1e-3, False) == 1.0


def test_no_more_triangles_than_within_two_chords() -> None:
    least, equilateral = least_densities(np.array([1e9, 0.0]), np.array([1e9, 0.0]), 0.1, False)
    assert least[0] == equilateral[0] == pytest.approx(1 / (np.sqrt(3) * 0.01))
    assert least[1] == equilateral[1] == 0.0
