"""Proved bounds of offsets of surfaces and curves against samples of them."""

import itertools

import mpmath
import numpy as np
import pytest

from surfmesh._core import proof
from surfmesh.accuracy.face_triangles import FaceTriangles
from surfmesh.accuracy.proof import CORNER, WHOLE, proved_distances
from surfmesh.geometry.cad_surfaces.curves import Circle, Ellipse, Hyperbola, Parabola
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve, BSplineSurface
from surfmesh.geometry.cad_surfaces.offset import OffsetCurve, OffsetSurface
from surfmesh.geometry.cad_surfaces.swept import ExtrusionSurface, RevolutionSurface

SIDE = 12
WEIGHTS = np.array(
    [(i, j, SIDE - i - j) for i in range(SIDE + 1) for j in range(SIDE + 1 - i)]
) / float(SIDE)
BOX = ((0.0, 3.0), (0.0, 3.0))


def spline(degree=3, times=1, rational=False, seed=0, height=0.25):
    """Three spans each way, their inner knots so often; nearly a graph over the plane."""
    rng = np.random.default_rng(seed)
    knots = [0.0] * (degree + 1) + [1.0] * times + [2.0] * times + [3.0] * (degree + 1)
    count = len(knots) - degree - 1
    along = np.linspace(0.0, 4.0, count)
    x, y = np.meshgrid(along, along, indexing="ij")
    control = np.stack([x, y, height * rng.normal(size=x.shape)], axis=-1)
    turned = control @ np.linalg.qr(rng.normal(size=(3, 3)))[0]
    weights = rng.uniform(0.7, 1.4, x.shape) if rational else None
    return BSplineSurface(knots, knots, turned, weights, domain=BOX)


SPLINES = {
    "cubic": spline(),
    "rational": spline(rational=True),
    "with double knots": spline(times=2),
    "quadratic": spline(degree=2, height=0.1),
    "rational quadratic": spline(degree=2, rational=True, height=0.1),
    "quintic": spline(degree=5, seed=3),
}


def triangles(count, size, seed=1):
    rng = np.random.default_rng(seed)
    uv = rng.uniform(0.0, 3.0, (count, 1, 2)) + size * rng.normal(size=(count, 3, 2))
    return np.ascontiguousarray(np.clip(uv, 0.0, 3.0))


def twins(rows):
    """Half-edge k of triangle t is 3 t + k, from corner k on; -1: it has no twin."""
    number = {(t[k], t[(k + 1) % 3]): 3 * i + k for i, t in enumerate(rows) for k in range(3)}
    return np.array([number.get((b, a), -1) for a, b in number], np.int32)


def bounds_of(surface, uv, corners, depth):
    flat, rims = np.zeros_like(uv), np.zeros(len(uv), np.uint8)
    limits = np.full(len(uv), 1e-12)
    return np.asarray(proof.triangle_bounds(surface.core, corners, uv, flat, limits, rims, depth))


@pytest.mark.parametrize("name", SPLINES)
@pytest.mark.parametrize("distance", [0.2, -0.3])
@pytest.mark.parametrize("size", [0.2, 0.02, 0.001])
def test_points_keep_to_what_is_bounded(name, distance, size):
    found, whole = bounded_triangles(OffsetSurface(SPLINES[name], distance, domain=BOX), size)
    if size < 0.1:
        assert np.median(found[:, WHOLE] / whole) < 8.0


def bounded_triangles(surface, size):
    """Bounds of random triangles, none below samples; and how far the samples are from them."""
    uv = triangles(150, size)
    corners = surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)
    samples = np.einsum("qk,mkd->mqd", WEIGHTS, uv)
    points = surface.evaluate(samples.reshape(-1, 2), 0)[0].reshape(len(uv), -1, 3)
    away = points - np.einsum("qk,mkd->mqd", WEIGHTS, corners)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    whole = np.linalg.norm(away, axis=2).max(axis=1)
    height = np.abs(np.einsum("mqd,md->mq", away, normal)).max(axis=1)
    for depth in (0, 2):
        found = bounds_of(surface, uv, corners, depth)
        assert found[:, CORNER].max() < 1e-7
        assert (height <= found[:, 0] + found[:, CORNER]).all()
        assert (whole <= found[:, WHOLE] + found[:, CORNER]).all()
    return found, whole


@pytest.mark.parametrize("name", ["cubic", "rational", "quintic"])
def test_small_triangles_are_bounded_closely(name):
    surface = OffsetSurface(SPLINES[name], 0.2, domain=BOX)
    uv = triangles(60, 0.01)
    corners = surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)
    middle = surface.evaluate(uv.mean(axis=1), 0)[0]
    found = bounds_of(surface, uv, corners, 0)
    away = np.linalg.norm(middle - corners.mean(axis=1), axis=1)
    assert np.median(found[:, WHOLE] / away) < 2.0


def test_nothing_is_known_where_the_basis_may_have_no_normal():
    knots = [0.0] * 4 + [3.0] * 4
    x, y = np.meshgrid(np.arange(4.0), np.arange(4.0), indexing="ij")
    control = np.stack([x * y, y, 0.1 * x * x], axis=-1)  # one point for y = 0
    surface = OffsetSurface(BSplineSurface(knots, knots, control, domain=BOX), 0.2, domain=BOX)
    uv = np.array([[[1.0, 0.0], [2.0, 0.5], [1.0, 0.5]], [[1.0, 1.0], [1.5, 1.0], [1.0, 1.5]]])
    corners = surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)
    found = bounds_of(surface, uv, corners, 2)
    assert np.isfinite(found[:, WHOLE]).tolist() == [False, True]


def test_a_crease_of_the_basis_has_no_bound():
    creased = BSplineSurface(
        [0.0, 0.0, 1.5, 3.0, 3.0], [0.0, 0.0, 3.0, 3.0],
        [[[0, 0, 0], [0, 2, 0]], [[1, 0, 1], [1, 2, 1]], [[2, 0, 0], [2, 2, 0]]], domain=BOX,
    )  # fmt: skip
    surface = OffsetSurface(creased, 0.2, domain=BOX)
    uv = np.array([[[1.0, 1.0], [2.0, 1.0], [1.0, 2.0]], [[0.2, 1.0], [1.2, 1.0], [0.2, 2.0]]])
    corners = surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 3, 3)
    found = bounds_of(surface, uv, corners, 2)
    assert np.isfinite(found[:, WHOLE]).tolist() == [False, True]


def turned(seed=0):
    """An origin and three unit vectors at right angles, in general position."""
    rng = np.random.default_rng(seed)
    return rng.normal(size=3), *np.linalg.qr(rng.normal(size=(3, 3)))[0]


def spline_curve(frame, degree=3, times=1, rational=False, seed=0):
    """Three spans over [0, 3] in the plane of a frame, three away from its third axis at least."""
    origin, x, y, _ = frame
    rng = np.random.default_rng(seed)
    knots = [0.0] * (degree + 1) + [1.0] * times + [2.0] * times + [3.0] * (degree + 1)
    count = len(knots) - degree - 1
    away = 3.5 + rng.uniform(-0.3, 0.3, count)
    control = origin + away[:, None] * x + np.linspace(0.0, 4.0, count)[:, None] * y
    weights = rng.uniform(0.7, 1.4, count) if rational else None
    return BSplineCurve(np.array(knots), control, weights)


FRAME = turned()
CURVES = {
    "spline": spline_curve(FRAME),
    "rational spline": spline_curve(FRAME, rational=True),
    "spline of double knots": spline_curve(FRAME, times=2),
    "quadratic spline": spline_curve(FRAME, degree=2),
    "ellipse": Ellipse(*FRAME[:3], 2.0, 1.2),
    "hyperbola": Hyperbola(*FRAME[:3], 1.0, 1.5),
    "parabola": Parabola(*FRAME[:3], 0.7),
}


@pytest.mark.parametrize("name", CURVES)
@pytest.mark.parametrize("size", [0.2, 0.01])
def test_offsets_of_extrusions_keep_to_what_is_bounded(name, size):
    tube = ExtrusionSurface(CURVES[name], FRAME[3], domain=BOX)
    for distance in (0.2, -0.3):
        found, whole = bounded_triangles(OffsetSurface(tube, distance, domain=BOX), size)
        assert np.median(found[:, WHOLE] / whole) < (3.0 if size < 0.1 else 100.0)


@pytest.mark.parametrize("name", CURVES)
@pytest.mark.parametrize("size", [0.2, 0.01])
def test_offsets_of_revolutions_keep_to_what_is_bounded(name, size):
    origin, x, y, _ = FRAME
    turning = RevolutionSurface(CURVES[name], origin - 4.0 * x, y, domain=BOX)
    for distance in (0.2, -0.3):
        found, whole = bounded_triangles(OffsetSurface(turning, distance, domain=BOX), size)
        assert np.median(found[:, WHOLE] / whole) < (8.0 if size < 0.1 else 100.0)


@pytest.mark.parametrize("name", CURVES)
@pytest.mark.parametrize("distance", [0.2, -0.3])
def test_offset_curves_keep_to_what_is_bounded(name, distance):
    curve = OffsetCurve(CURVES[name], distance, FRAME[3])
    for length in (0.3, 0.01):
        start = np.random.default_rng(2).uniform(0.0, 3.0 - length, 60)
        t = np.stack([start, start + length], axis=1)
        points = curve.evaluate(np.linspace(t[:, 0], t[:, 1], 200, axis=1).ravel(), 0)[0]
        points = points.reshape(len(t), -1, 3)
        ends = np.ascontiguousarray(points[:, (0, -1)])
        side = (ends[:, 1] - ends[:, 0]) / np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)[:, None]
        far = np.linalg.norm(np.cross(points - ends[:, :1], side[:, None]), axis=2).max(axis=1)
        bound = proof.curve_bounds(curve.core, t, ends)
        assert (far <= bound).all()
        assert np.median(bound / far) < (2.0 if length < 0.1 else 8.0)


def test_an_extruded_offset_curve_is_bounded():
    curve = OffsetCurve(CURVES["spline"], 0.2, FRAME[3])
    found, whole = bounded_triangles(ExtrusionSurface(curve, FRAME[3], domain=BOX), 0.02)
    assert np.median(found[:, WHOLE] / whole) < 3.0


def test_a_plane_offset_curve_is_that_of_space():
    around = Circle(np.zeros(2), np.array([1.0, 0.0]), np.array([0.0, 1.0]), 2.0)
    plane = OffsetCurve(around, 0.25).evaluate(np.linspace(0.0, 3.0, 7), 2)
    space = OffsetCurve(Circle(np.zeros(3), *np.eye(3)[:2], 2.0), 0.25, np.eye(3)[2])
    for flat, high in zip(plane, space.evaluate(np.linspace(0.0, 3.0, 7), 2), strict=True):
        assert np.array_equal(flat, high[:, :2])


def test_nothing_is_known_where_an_offset_curve_may_have_no_tangent():
    point = BSplineCurve(np.array([0.0] * 4 + [3.0] * 4), np.array([[0.0, 0, 0]] * 4))
    curve = OffsetCurve(point, 0.2, np.eye(3)[2])
    found = proof.curve_bounds(curve.core, np.array([[0.0, 1.0]]), np.zeros((1, 2, 3)))
    assert not np.isfinite(found).any()


def test_an_offset_of_an_offset_says_that_nothing_is_known():
    surface = OffsetSurface(OffsetSurface(SPLINES["cubic"], 0.1, domain=BOX), 0.2, domain=BOX)
    uv = triangles(1, 0.1)
    corners = np.zeros((1, 3, 3))
    flat, rims = np.zeros_like(uv), np.zeros(1, np.uint8)
    assert proof.triangle_bounds(surface.core, corners, uv, flat, np.ones(1), rims, 2) is None


def test_a_mild_offset_is_proved():
    """A grid of triangles whose corners are off by what edges of CAD models are."""
    surface = OffsetSurface(spline(height=0.15), 0.2, domain=BOX)
    ticks = np.linspace(0.0, 3.0, 25)
    u, v = np.meshgrid(ticks, ticks, indexing="ij")
    places = np.column_stack([u.ravel(), v.ravel()])
    first = (np.arange(24)[:, None] * 25 + np.arange(24)).ravel()
    rows = np.concatenate([
        np.column_stack([first, first + 25, first + 26]),
        np.column_stack([first, first + 26, first + 1]),
    ]).astype(np.int32)  # fmt: skip
    points = surface.evaluate(places, 0)[0]
    rng = np.random.default_rng(0)
    points = points + 3e-7 * rng.uniform(-1.0, 1.0, points.shape)
    face = FaceTriangles(
        np.ascontiguousarray(points[rows]), np.ascontiguousarray(places[rows]), rows, twins(rows)
    )
    limit = np.linalg.norm(np.ptp(points, axis=0)) / 1000.0
    found = proved_distances(surface, face, np.full(len(rows), limit))
    assert found is not None
    assert (found.bound <= limit).all()


@pytest.mark.parametrize("degrees", [(1, 3), (3, 1), (2, 5), (6, 9)])
@pytest.mark.parametrize("rational", [False, True])
def test_how_far_corners_are_off_is_known_to_rounding(degrees, rational):
    rng = np.random.default_rng(sum(degrees))
    knots = [[0.0] * (p + 1) + [1.0, 2.0] + [3.0] * (p + 1) for p in degrees]
    x, y = np.meshgrid(*(np.linspace(0.0, 4.0, p + 3) for p in degrees), indexing="ij")
    control = np.stack([x, y, 0.2 * rng.normal(size=x.shape)], axis=-1)
    weights = rng.uniform(0.7, 1.4, x.shape) if rational else None
    basis = BSplineSurface(*knots, control, weights, domain=BOX)
    uv = np.ascontiguousarray(rng.uniform(0.0, 3.0, (20, 3, 2)))
    exact = exact_offsets(basis, 0.3, uv.reshape(-1, 2)).reshape(20, 3, 3)
    moved = rng.normal(size=exact.shape)
    moved *= 1e-6 / np.linalg.norm(moved, axis=2)[:, :, None]
    found = bounds_of(OffsetSurface(basis, 0.3, domain=BOX), uv, exact + moved, 0)[:, CORNER]
    assert (found >= 1e-6 - 1e-15).all()
    assert (found <= 1e-6 + 1e-9).all()


def exact_offsets(basis, distance, uv):
    """Points at a distance from a spline, by its basis functions in 40 digits."""
    with mpmath.workdps(40):
        return np.array([_exact_offset(basis, distance, u, v) for u, v in uv.tolist()])


def _exact_offset(basis, distance, u, v):
    (p, q), weights = basis.degrees, basis.weights
    along_u, along_v = (
        [_functions(knots, degree, mpmath.mpf(t), order) for order in (0, 1)]
        for knots, degree, t in ((basis.knots_u, p, u), (basis.knots_v, q, v))
    )

    def total(k, order_u, order_v):
        return mpmath.fsum(
            a * b * (1.0 if weights is None else float(weights[i, j]))
            * (1.0 if k == 3 else float(basis.control[i, j, k]))
            for i, a in enumerate(along_u[order_u])
            for j, b in enumerate(along_v[order_v])
        )  # fmt: skip

    w = total(3, 0, 0)
    r = [total(k, 0, 0) / w for k in range(3)]
    r_u = [(total(k, 1, 0) - total(3, 1, 0) * r[k]) / w for k in range(3)]
    r_v = [(total(k, 0, 1) - total(3, 0, 1) * r[k]) / w for k in range(3)]
    normal = [r_u[k - 2] * r_v[k - 1] - r_u[k - 1] * r_v[k - 2] for k in range(3)]
    size = mpmath.sqrt(mpmath.fsum(x * x for x in normal))
    return [float(r[k] + distance * normal[k] / size) for k in range(3)]


def _functions(knots, degree, t, order):
    """All basis functions at t, or their first derivatives (Cox and de Boor)."""
    knots = [mpmath.mpf(float(x)) for x in knots]
    values = [mpmath.mpf(a <= t < b) for a, b in itertools.pairwise(knots)]
    for p in range(1, degree + 1 - order):
        values = [
            sum(part * value / size for part, size, value in (
                (t - knots[i], knots[i + p] - knots[i], values[i]),
                (knots[i + p + 1] - t, knots[i + p + 1] - knots[i + 1], values[i + 1]),
            ) if size)
            for i in range(len(values) - 1)
        ]  # fmt: skip
    if order == 0:
        return values
    return [
        degree * sum(sign * value / size for sign, size, value in (
            (1, knots[i + degree] - knots[i], values[i]),
            (-1, knots[i + degree + 1] - knots[i + 1], values[i + 1]),
        ) if size)
        for i in range(len(values) - 1)
    ]  # fmt: skip
