"""Triangles that are straight in the plane, cut: the small ones make up all of (u, v)."""

import numpy as np

import surfmesh as sm
from surfmesh.geometry.differential.chart import Chart
from surfmesh.quality.measures.bent_sides import PARTS, are_bent, cut_in_plane

LONG = sm.ParametricSurface(
    "10*cos(v)*cos(u)", "cos(v)*sin(u)", "sin(v)", u=(0, "2*pi"), v=("-pi/2", "pi/2")
)


def area(uv: np.ndarray) -> np.ndarray:
    """Signed areas of triangles (k, 3, 2)."""
    a, b = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    return 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def fan(chart: Chart) -> np.ndarray:
    """Four triangles (4, 3, 2) of (u, v) from a point inside to the corners of the domain."""
    x, y = chart.extent
    corners = np.array([[0, 0], [x, 0], [x, y], [0, y]])
    inside = np.tile([0.3 * x, 0.4 * y], (4, 1))
    plane = np.stack([inside, corners, np.roll(corners, -1, axis=0)], axis=1)
    return chart.to_uv(plane.reshape(-1, 2)).reshape(-1, 3, 2)


def test_pieces_make_up_the_domain():
    chart = Chart.of(LONG)
    uv = fan(chart)
    no = np.zeros(4, bool)
    pieces = cut_in_plane(chart, uv, no, np.zeros((4, 3), bool))
    assert len(pieces.uv) == 4 * PARTS**2 and (np.bincount(pieces.owner) == PARTS**2).all()
    np.testing.assert_allclose(area(pieces.uv).sum(), 2.0 * np.pi * np.pi, rtol=1e-12)


def test_beside_straight_triangles_slivers_are_added():
    """One is cut, the others are not: what its broken sides leave out or cover twice is known."""
    chart = Chart.of(LONG)
    uv = fan(chart)
    alone = np.array([[True, False, True]])  # side 1 is a side of the domain
    pieces = cut_in_plane(chart, uv[:1], np.zeros(1, bool), alone)
    assert len(pieces.uv) == PARTS**2 + 2 * (PARTS - 1)
    slivers = area(pieces.uv[PARTS**2 :]).sum()
    np.testing.assert_allclose(area(pieces.uv[: PARTS**2]).sum() - slivers, area(uv[:1])[0])


def test_of_a_triangle_beside_a_pole_the_whole_box_counts():
    chart = Chart.of(LONG)
    pieces = cut_in_plane(chart, fan(chart)[:1], np.ones(1, bool), np.zeros((1, 3), bool))
    assert len(pieces.uv) == 2 * PARTS**2
    assert (pieces.uv.min(axis=(0, 1)) == chart.to_uv(np.zeros((1, 2)))[0]).all()


def test_sides_along_meridians_are_straight():
    chart = Chart.of(LONG)
    meridian = np.array([[[1.0, -1.0], [1.0, 1.0], [1.05, 0.0]]])
    assert not are_bent(LONG, chart, meridian)[0, 0]
    assert are_bent(LONG, chart, fan(chart)).any()
