"""The core's work on two surfaces that meet: Newton, bounds of pieces, tracing, strips."""

import numpy as np
import pytest

from surfmesh._core import intersection, surfaces

X, Y, Z, O = (*np.eye(3), np.zeros(3))
BALL = surfaces.sphere(((0.0, 6.28), (-1.57, 1.57)), O, X, Y, Z, 1.0)
FLOOR = surfaces.plane(((-2.0, 2.0), (-2.0, 2.0)), 0.6 * Z, X, Y)  # cuts a circle of radius 0.8


class Failing:
    domain = ((0.0, 1.0), (0.0, 1.0))
    loops = ()
    name = "failing"

    def evaluate(self, uv, order=0):
        raise RuntimeError("no surface today")

    def derivative_bounds(self, lo, hi):
        return None


def test_places_on_both_are_on_the_circle_and_in_their_planes():
    angle = np.linspace(0.1, 6.0, 20)
    uv_b = np.column_stack([np.cos(angle), np.sin(angle)])
    uv_a = np.column_stack([angle + 0.05, np.full(20, 0.5)])
    normal = np.column_stack([-np.sin(angle), np.cos(angle), np.zeros(20)])
    for planes in ((None, None), (normal, np.zeros((20, 3)))):
        a, b, point, gap = intersection.pull_onto_both(BALL, FLOOR, uv_a, uv_b, *planes)
        assert gap.max() < 1e-14
        assert np.hypot(point[:, 0], point[:, 1]) == pytest.approx(np.full(20, 0.8), abs=1e-13)
        assert np.abs(BALL.evaluate(a)[0] - FLOOR.evaluate(b)[0]).max() < 1e-14
    assert np.abs(np.einsum("ij,ij->i", normal, point)).max() < 1e-13


def test_a_line_pierces_a_sphere():
    line = surfaces.line(np.array([0.0, 0.0, 0.5]), X)
    t, _, point, gap = intersection.pull_onto_curve(
        line, 0.0, 2.0, BALL, np.array([0.4]), np.array([[0.1, 0.4]])
    )
    assert gap[0] < 1e-15 and t[0] == pytest.approx(np.sqrt(0.75) / 2.0, abs=1e-15)
    assert point[0] == pytest.approx([np.sqrt(0.75), 0.0, 0.5])


def test_a_circle_is_traced_back_to_its_start_and_holds_its_points():
    wall = surfaces.plane(((-2.0, 2.0), (-2.0, 2.0)), 0.8 * X, Y, Z)
    wide = surfaces.sphere(((-3.0, 3.0), (-1.57, 1.57)), O, X, Y, Z, 1.0)
    uv_a, uv_b = np.tile([np.arctan2(0.6, 0.8), 0.0], (2, 1)), np.tile([0.6, 0.0], (2, 1))
    start = np.tile([0.8, 0.6, 0.0], (2, 1))
    found, end, points, a, b = intersection.trace_branch(
        wide, wall, uv_a, uv_b, start, np.array([Z, -Z]), np.zeros(2, np.uint8), 0.1, 1e-11, True
    )
    assert found and end == 1 and len(points) > 20
    assert np.hypot(points[:, 1], points[:, 2]) == pytest.approx(0.6, abs=1e-12)
    assert (points[0] == points[-1]).all()
    angle = np.array([0.7, 2.0])
    on = np.column_stack([[0.8, 0.8], 0.6 * np.cos(angle), 0.6 * np.sin(angle)])
    off = on + [1e-3, 0.0, 0.0]
    held = intersection.lie_on_branch(wide, wall, points, a, b, np.concatenate([on, off]), 1e-7)
    assert held.tolist() == [1, 1, 0, 0]


def test_strips_of_a_sphere_have_their_closed_forms():
    places, weights = np.polynomial.legendre.leggauss(8)
    rule = 0.5 * (places + 1.0), 0.5 * weights
    ends = np.array([[1.0, 0.3], [-0.5, -1.0]])
    area = intersection.strip_integrals(BALL, 0.2, ends, np.empty(0), *rule, 1e-12, 5)
    assert area == pytest.approx(np.cos(ends[:, 1]) * (ends[:, 0] - 0.2), abs=1e-14)
    cone = intersection.strip_integrals(
        BALL, 0.2, ends, np.array([0.5, 0.7]), *rule, 1e-12, 5, np.zeros(3)
    )
    assert cone == pytest.approx(area / 3.0, abs=1e-14)


def test_pieces_of_a_curve_lie_in_their_boxes():
    rng = np.random.default_rng(2)
    knots = np.array([0, 0, 0, 0, 0.4, 1, 1, 1, 1.0])
    control, weights = rng.normal(size=(5, 3)), rng.uniform(0.5, 2.0, 5)
    curve = surfaces.spline_curve(knots, control, weights, None, 0.0)
    lo = np.linspace(0.0, 0.9, 10)
    low, high, _, _, axis, angle = intersection.bound_pieces(curve, 0.0, 1.0, lo, lo + 0.1)
    for t in np.linspace(0.0, 0.1, 9):
        point, way = curve.evaluate(lo + t, 1)
        assert (point >= low).all() and (point <= high).all()
        cosine = np.einsum("ij,ij->i", way, axis) / np.linalg.norm(way, axis=1)
        assert (np.arccos(np.minimum(cosine, 1.0)) <= angle + 1e-7)[angle < 1.5].all()


def test_what_a_callers_surface_raises_comes_through():
    failing = surfaces.CallbackSurface(Failing())
    uv = np.full((3, 2), 0.5)
    with pytest.raises(RuntimeError, match="no surface today"):
        intersection.pull_onto_both(failing, FLOOR, uv, uv)
    with pytest.raises(RuntimeError, match="no surface today"):
        intersection.bound_cells(failing, uv, uv + 0.1)


@pytest.mark.parametrize(
    "call",
    [
        lambda: intersection.pull_onto_both(BALL, FLOOR, np.zeros((3, 2)), np.zeros((2, 2))),
        lambda: intersection.pull_onto_both(
            BALL, FLOOR, np.zeros((3, 2)), np.zeros((3, 2)), np.zeros((3, 3))
        ),
        lambda: intersection.bound_cells(BALL, np.zeros((3, 2)), np.zeros((2, 2))),
        lambda: intersection.cross_surely(
            (np.zeros((2, 3)), np.zeros(2)), np.array([2]), (np.zeros((2, 3)), np.zeros(2)),
            np.array([0]),
        ),
        lambda: intersection.strip_integrals(
            BALL, 0.0, np.zeros((1, 2)), np.empty(0), np.empty(0), np.empty(0), 1e-9, 3
        ),
        lambda: intersection.trace_branch(
            BALL, FLOOR, np.zeros((2, 2)), np.zeros((2, 2)), np.zeros((2, 3)), np.zeros((2, 3)),
            np.zeros(2, np.uint8), np.nan, 1e-11, False,
        ),
    ],
)  # fmt: skip
def test_arrays_that_do_not_fit_are_refused(call):
    with pytest.raises(ValueError):
        call()
