"""Surfaces of CAD faces against each other, against differences, and at their poles."""

import dataclasses
import pickle

import numpy as np
import pytest

from surfmesh.errors import SurfaceError
from surfmesh.geometry.cad_surfaces.curves import Circle, Ellipse, Line
from surfmesh.geometry.cad_surfaces.elementary import Cone, Cylinder, Plane, Sphere, Torus
from surfmesh.geometry.cad_surfaces.elementary_offsets import elementary_offset
from surfmesh.geometry.cad_surfaces.face_surface import DERIVATIVES
from surfmesh.geometry.cad_surfaces.nurbs import BSplineCurve, BSplineSurface, bezier_knots
from surfmesh.geometry.cad_surfaces.offset import OffsetSurface
from surfmesh.geometry.cad_surfaces.swept import ExtrusionSurface, RevolutionSurface
from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.differential.fundamental_forms import area, curvatures, forms
from surfmesh.geometry.surface import Surface, steady_axes

TURN = 2.0 * np.pi
BOX = ((0.2, 1.3), (0.1, 0.9))
ROTATION = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]
X, Y, Z = ROTATION * np.sign(np.linalg.det(ROTATION))
O = np.array([3.0, -1.0, 2.0])
FRAME = {"origin": O, "x": X, "y": Y, "z": Z}


def spline(seed=1, rational=True, domain=BOX):
    rng = np.random.default_rng(seed)
    knots_u = np.array([0, 0, 0, 0, 0.6, 1.5, 1.5, 1.5, 1.5])
    knots_v = np.array([-0.5, 0, 0, 0.5, 1, 1, 1.2])
    u, v = np.meshgrid(np.arange(5.0), np.arange(4.0), indexing="ij")
    control = np.stack([u, v, rng.normal(size=u.shape)], axis=-1)
    weights = rng.uniform(0.7, 1.4, u.shape) if rational else None
    return BSplineSurface(knots_u, knots_v, control, weights, domain=domain)


def wavy_curve():
    control = [[1, 0, 0], [2, 1, 0.3], [3, -1, 1], [2, 0, 2], [4, 1, 3.0]]
    knots = [0, 0, 0, 0, 0.7, 2, 2, 2, 2]
    return BSplineCurve(knots, control, [1, 2, 1, 0.5, 1])


SURFACES = [
    Plane(**FRAME, domain=BOX),
    Cylinder(**FRAME, radius=2.0, domain=BOX),
    Cone(**FRAME, radius=2.0, angle=0.4, domain=BOX),
    Cone(**FRAME | {"y": -Y}, radius=2.0, angle=-0.4, domain=BOX),
    Sphere(**FRAME, radius=2.0, domain=BOX),
    Torus(**FRAME, radius=2.0, tube=0.5, domain=BOX),
    spline(),
    spline(rational=False),
    ExtrusionSurface(wavy_curve(), Z, domain=BOX),
    RevolutionSurface(wavy_curve(), O, Z, domain=BOX),
    OffsetSurface(spline(), 0.2, domain=BOX),
    OffsetSurface(RevolutionSurface(wavy_curve(), O, Z, domain=BOX), -0.3, domain=BOX),
]
NAMES = [f"{number} {surface.kind}" for number, surface in enumerate(SURFACES)]


def inside(domain, count=30, seed=0):
    lo, hi = np.array(domain).T
    return lo + (hi - lo) * np.random.default_rng(seed).uniform(0.05, 0.95, (count, 2))


def highest_order(surface):
    return 2 if surface.kind == "offset" else 3


@pytest.mark.parametrize("surface", SURFACES, ids=NAMES)
def test_derivatives_are_limits_of_differences(surface):
    step, uv = 1e-5, inside(BOX)
    uv = uv[np.abs(uv - [0.6, 0.5]).min(axis=1) > 2 * step]  # knots of the spline
    values = surface.evaluate(uv, highest_order(surface))
    where = {key: number for number, key in enumerate(DERIVATIVES)}
    for number, (k, l) in enumerate(DERIVATIVES[1 : len(values)], 1):
        axis, below = (0, (k - 1, l)) if k else (1, (k, l - 1))
        shift = step * np.eye(2)[axis]
        order = sum(below)
        ahead = surface.evaluate(uv + shift, order)[where[below]]
        behind = surface.evaluate(uv - shift, order)[where[below]]
        found = (ahead - behind) / (2 * step)
        size = 1 + np.abs(values[number]).max()
        assert np.abs(found - values[number]).max() < 1e-7 * size * 10**order


@pytest.mark.parametrize("surface", SURFACES, ids=NAMES)
def test_every_order_gives_the_same(surface):
    assert isinstance(surface, Surface)
    uv = inside(BOX)
    highest = surface.evaluate(uv, highest_order(surface))
    for order in range(highest_order(surface)):
        found = surface.evaluate(uv, order)
        assert len(found) == (order + 1) * (order + 2) // 2
        for a, b in zip(found, highest):
            assert a.shape == (len(uv), 3)
            assert a.flags.c_contiguous
            assert a == pytest.approx(b, abs=1e-12)
    for few in (uv[:0], uv[:1]):
        assert [a.shape for a in surface.evaluate(few, 2)] == [(len(few), 3)] * 6
    assert surface.derivative_bounds(uv, uv) is None


@pytest.mark.parametrize("surface", SURFACES, ids=NAMES)
def test_surfaces_travel_and_do_not_change(surface):
    copy = pickle.loads(pickle.dumps(surface))
    uv = inside(BOX)
    assert np.array_equal(copy.evaluate(uv, 2), surface.evaluate(uv, 2))
    assert (copy.kind, copy.periods, copy.domain) == (surface.kind, surface.periods, BOX)
    with pytest.raises(dataclasses.FrozenInstanceError):
        surface.domain = BOX
    for field in dataclasses.fields(surface):
        value = getattr(copy, field.name)
        assert not (isinstance(value, np.ndarray) and value.flags.writeable)
    other = surface.with_domain(((0, 1), (0.5, 2)))
    assert other.domain == ((0.0, 1.0), (0.5, 2.0))
    assert np.array_equal(other.evaluate(uv, 2), surface.evaluate(uv, 2))
    assert surface.kind in repr(surface).lower()


@pytest.mark.parametrize("surface", SURFACES, ids=NAMES)
def test_periods(surface):
    uv = inside(BOX)
    for axis, period in enumerate(surface.periods):
        if period:
            there = surface.evaluate(uv - 3 * period * np.eye(2)[axis], 2)
            assert np.array(there) == pytest.approx(np.array(surface.evaluate(uv, 2)), abs=1e-11)


def test_curvatures_of_elementary_surfaces():
    uv = inside(BOX)
    expected = {"plane": (0, 0), "cylinder": (0, -1 / 2), "sphere": (-1 / 2, -1 / 2)}
    for surface in SURFACES:
        if surface.kind in expected:
            k = curvatures(forms(surface, uv))
            assert k.k1 == pytest.approx(expected[surface.kind][0], abs=1e-12)
            assert k.k2 == pytest.approx(expected[surface.kind][1], abs=1e-12)
    torus = Torus(**FRAME, radius=2.0, tube=0.5, domain=((0, TURN), (0, TURN)))
    # do Carmo, 3-3, example 5: K = cos v / (r (R + r cos v))
    k = curvatures(forms(torus, uv)).gaussian
    cos = np.cos(uv[:, 1])
    assert k == pytest.approx(cos / (0.5 * (2 + 0.5 * cos)))
    assert area(torus) == pytest.approx(4 * np.pi**2 * 2.0 * 0.5)


def test_a_left_handed_frame_turns_the_normal():
    left = FRAME | {"y": -Y}
    uv = inside(BOX)
    outwards = Sphere(**FRAME, radius=2.0, domain=BOX)
    inwards = Sphere(**left, radius=2.0, domain=BOX)
    for sphere, side in ((outwards, 1.0), (inwards, -1.0)):
        (r,) = sphere.evaluate(uv)
        assert forms(sphere, uv).normal == pytest.approx(side * (r - O) / 2.0)


def same(a, b, uv=None, order=3, swap=False):
    uv = inside(BOX) if uv is None else uv
    found = a.evaluate(uv, order)
    expected = b.evaluate(uv[:, ::-1] if swap else uv, order)
    if swap:
        number = {key: k for k, key in enumerate(DERIVATIVES)}
        expected = [expected[number[l, k]] for k, l in DERIVATIVES[: len(found)]]
    for x, y in zip(found, expected):
        assert x == pytest.approx(y, abs=1e-11)


@pytest.mark.parametrize("hand", [1.0, -1.0])
@pytest.mark.parametrize("distance", [0.3, -0.3])
def test_offsets_of_elementary_surfaces(hand, distance):
    frame = FRAME | {"y": hand * Y}
    for basis in (
        Plane(**frame, domain=BOX),
        Cylinder(**frame, radius=2.0, domain=BOX),
        Cone(**frame, radius=2.0, angle=0.4, domain=BOX),
        Cone(**frame, radius=2.0, angle=-0.4, domain=BOX),
        Sphere(**frame, radius=2.0, domain=BOX),
        Torus(**frame, radius=2.0, tube=0.5, domain=BOX),
    ):
        found = elementary_offset(basis, distance)
        assert type(found) is type(basis)
        same(found, OffsetSurface(basis, distance, domain=BOX), order=2)


def test_offsets_that_are_turned_inside_out_stay_offsets():
    cone = Cone(**FRAME, radius=0.5, angle=0.4, domain=((0.0, 1.0), (-2.0, 1.0)))
    assert elementary_offset(cone, 0.1) is None  # through the apex
    assert elementary_offset(Cone(**FRAME, radius=0.2, angle=0.4, domain=BOX), -0.4) is None
    assert elementary_offset(Sphere(**FRAME, radius=0.5, domain=BOX), -0.6) is None
    assert elementary_offset(Torus(**FRAME, radius=0.5, tube=0.6, domain=BOX), 0.1) is None
    assert elementary_offset(spline(), 0.1) is None


def test_swept_surfaces_that_are_elementary():
    circle = Circle(O, X, Y, 2.0)
    same(ExtrusionSurface(circle, Z, domain=BOX), Cylinder(**FRAME, radius=2.0, domain=BOX))
    a = 0.4
    generator = Line(O + 2.0 * X, np.sin(a) * X + np.cos(a) * Z)
    cone = Cone(**FRAME, radius=2.0, angle=a, domain=BOX)
    same(RevolutionSurface(generator, O, Z, domain=BOX), cone)
    tube = Circle(O + 2.0 * X, X, Z, 0.5)
    torus = Torus(**FRAME, radius=2.0, tube=0.5, domain=BOX)
    turned = RevolutionSurface(tube, O - 7.0 * Z, Z, domain=BOX)
    same(turned, torus)
    assert turned.periods == torus.periods
    ellipse = ExtrusionSurface(Ellipse(O, X, Y, 2.0, 2.0), Z, domain=BOX)
    same(ellipse, Cylinder(**FRAME, radius=2.0, domain=BOX))


def test_offsets_that_are_elementary():
    for radius, distance in ((2.0, 0.5), (2.0, -0.5)):
        offset = OffsetSurface(Sphere(**FRAME, radius=radius, domain=BOX), distance, domain=BOX)
        same(offset, Sphere(**FRAME, radius=radius + distance, domain=BOX), order=2)
    torus = Torus(**FRAME, radius=2.0, tube=0.5, domain=BOX)
    offset = OffsetSurface(torus, 0.2, domain=((-9.0, 9.0), (-9.0, 9.0)))
    wide = inside(((-9.0, 9.0), (-9.0, 9.0)))
    same(offset, Torus(**FRAME, radius=2.0, tube=0.7, domain=BOX), wide, order=2)
    assert offset.periods == (TURN, TURN)
    plane = OffsetSurface(Plane(**FRAME, domain=BOX), 2.0, domain=BOX)
    same(plane, Plane(**FRAME | {"origin": O + 2.0 * Z}, domain=BOX), order=2)


@pytest.mark.parametrize("pole", [-1.0, 1.0])
def test_an_offset_is_exact_at_a_pole(pole):
    box = ((0.0, TURN), (-np.pi / 2, np.pi / 2))
    offset = OffsetSurface(Sphere(**FRAME, radius=2.0, domain=box), 0.5, domain=box)
    uv = np.array([[u, pole * (np.pi / 2 - gap)] for u in (0, 1, TURN) for gap in (0, 1e-14, 1e-3)])
    r, *derivatives = offset.evaluate(uv, 2)
    expected, *others = Sphere(**FRAME, radius=2.5, domain=box).evaluate(uv, 2)
    assert r == pytest.approx(expected, abs=1e-12)
    for found, other in zip(derivatives, others):
        # those a ten-thousandth of the domain further inside
        assert found == pytest.approx(other, abs=2 * 2.5 * 1e-4 * TURN)


def test_an_offset_where_neither_tangent_is_left():
    # all derivatives vanish at the corner of (s^2, t^2) but the second ones
    control = np.zeros((3, 3, 3))
    control[2, :, 0] = 1.0
    control[:, 2, 1] = 1.0
    knots = bezier_knots(2)
    box = ((0.0, 1.0), (0.0, 1.0))
    flat = BSplineSurface(knots, knots, control, kind="bezier", domain=box)
    r, *derivatives = OffsetSurface(flat, 0.3, domain=box).evaluate([[0, 0], [0.5, 0], [0, 0.5]], 2)
    assert r == pytest.approx(np.array([[0, 0, 0.3], [0.25, 0, 0.3], [0, 0.25, 0.3]]))
    assert np.isfinite(derivatives).all()


def test_spline_surfaces_that_are_elementary():
    # a quarter of a cylinder: angles against the rational parameter
    half = np.sqrt(0.5)
    corner = np.array([[1, 0, 0], [1, 1, 0], [0, 1, 0.0]]) @ ROTATION
    control = np.stack([corner, corner + 3.0 * ROTATION[2]], axis=1)
    weights = np.repeat([[1.0], [half], [1.0]], 2, axis=1)
    box = ((0.0, 1.0), (0.0, 1.0))
    quarter = BSplineSurface(bezier_knots(2), bezier_knots(1), control, weights, domain=box)
    k = curvatures(forms(quarter, inside(box)))
    assert np.abs(np.stack([k.k1, k.k2])).max(axis=0) == pytest.approx(1.0, abs=1e-12)
    assert k.gaussian == pytest.approx(0.0, abs=1e-12)
    assert area(quarter) == pytest.approx(1.5 * np.pi)


def test_at_a_crease_derivatives_are_those_of_the_face():
    knots, flat = np.array([0, 0, 1, 2, 2.0]), bezier_knots(1)
    control = np.array([[[0, v, 1], [1, v, 0], [2, v, 1]] for v in (0.0, 1.0)]).swapaxes(0, 1)
    for box, slope in (((0, 1), -1.0), ((1, 2), 1.0)):
        roof = BSplineSurface(knots, flat, control, domain=(box, (0, 1)))
        for surface in (roof, OffsetSurface(roof, 0.0, domain=roof.domain)):
            assert surface.evaluate([[1.0, 0.5]], 1)[1][0, 2] == slope
    section = BSplineCurve(knots, control[:, 0] + [1.0, 0.0, 0.0])
    for v, slope in (((0, 1), -1.0), ((1, 2), 1.0)):
        turned = RevolutionSurface(section, (0, 0, 0), (0, 0, 1), domain=((0, 1), v))
        assert turned.evaluate([[0.5, 1.0]], 1)[2][0, 2] == slope
        swept = ExtrusionSurface(section, (0, 1, 0), domain=(v, (0, 1)))
        assert swept.evaluate([[1.0, 0.5]], 1)[1][0, 2] == slope


def test_what_makes_no_surface_is_refused():
    with pytest.raises(SurfaceError, match="lid: the parameter box u 1 to 1"):
        Plane(**FRAME, domain=((1, 1), (0, 1)), name="lid")
    with pytest.raises(SurfaceError, match="not finite"):
        Plane(**FRAME, domain=((0, np.nan), (0, 1)))
    good = spline()
    knots = good.knots_u, good.knots_v
    with pytest.raises(SurfaceError, match="u: 5 knots and 5 control points"):
        dataclasses.replace(good, knots_u=np.arange(5.0))
    with pytest.raises(SurfaceError, match="no interval"):
        dataclasses.replace(good, knots_u=[0, 0, 0, 1, 1, 1, 2, 2, 2])
    with pytest.raises(SurfaceError, match="must not decrease"):
        BSplineSurface(knots[0][::-1], knots[1], good.control, domain=BOX)
    with pytest.raises(SurfaceError, match="one weight for each"):
        BSplineSurface(*knots, good.control, np.ones((4, 5)), domain=BOX)
    with pytest.raises(SurfaceError, match="positive"):
        BSplineSurface(*knots, good.control, -good.weights, domain=BOX)
    with pytest.raises(SurfaceError, match="to order 2 only"):
        SURFACES[-1].evaluate(inside(BOX), 3)


class Unsteady:
    """A surface that does not say where its speeds are the same."""

    name, loops = "unsteady", ()

    def __init__(self, surface):
        self.domain, self.evaluate = surface.domain, surface.evaluate  # all that a chart asks
        self.pieces = surface.pieces  # but for how finely it asks


@pytest.mark.parametrize("surface", SURFACES, ids=NAMES)
def test_speeds_said_to_be_steady_are_those_of_all_samples(surface):
    said, sampled = Chart.of(surface), Chart.of(Unsteady(surface))
    assert said.extent == pytest.approx(sampled.extent, rel=1e-13)
    for axis, steady in zip((said.core.u, said.core.v), steady_axes(surface)):
        assert not steady or len(axis.knots) == 2
