"""Surfaces from Python functions: against the same surfaces by formulas, and refusals."""

import math
import pickle

import numpy as np
import pytest

import surfmesh as sm
from surfmesh.errors import SurfaceError
from surfmesh.geometry.files.formula_file import gallery
from surfmesh.geometry.functions.differences import Differences
from surfmesh.geometry.surface import Surface

TAU = 2 * np.pi


def torus(u, v):
    return (3 + np.cos(v)) * np.cos(u), (3 + np.cos(v)) * np.sin(u), np.sin(v)


def sphere(u, v):
    return np.stack([np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)], axis=1)


def two_peaks(u, v):
    return np.stack([u, v, (u + 3 * v) ** 2 * np.exp(1 - u**2 - v**2)])


def points_of(surface, n=300):
    lo, hi = np.array(surface.domain).T
    inner = lo + (hi - lo) * np.random.default_rng(3).random((n, 2))
    corners = np.array([[lo[0], lo[1]], [hi[0], hi[1]], [lo[0], hi[1]], [hi[0], 0.5 * hi[1]]])
    return np.concatenate([inner, corners])


TWINS = {
    "torus": (torus, (0, TAU), (0, TAU), ("(3+cos(v))*cos(u)", "(3+cos(v))*sin(u)", "sin(v)")),
    "sphere": (sphere, (0, TAU), (0, np.pi), ("cos(u)*sin(v)", "sin(u)*sin(v)", "cos(v)")),
    "two_peaks": (two_peaks, (-2, 2), (-2, 2), ("u", "v", "(u+3*v)**2*exp(1-u**2-v**2)")),
}


@pytest.mark.parametrize("name", TWINS)
@pytest.mark.parametrize(
    "order, first, second", [(2, 1e-5, 1e-4), (4, 1e-8, 1e-5), (6, 1e-9, 1e-6)]
)
def test_differences_agree_with_formulas(name, order, first, second):
    f, u, v, formulas = TWINS[name]
    given, exact = (
        sm.NumericSurface(f, u, v, differences=order), sm.ParametricSurface(*formulas, u=u, v=v),
    )  # fmt: skip
    assert isinstance(given, Surface)
    uv = points_of(exact)
    found, wanted = given.evaluate(uv, 2), exact.evaluate(uv, 2)
    assert np.array_equal(found[0], given.evaluate(uv)[0])
    for k, (a, b) in enumerate(zip(found, wanted)):
        scale = max(np.abs(b).max(), 1.0)
        assert np.abs(a - b).max() <= (1e-14, first, first, second, second, second)[k] * scale
    for a, b in zip(given.evaluate(uv, 1), found):
        np.testing.assert_allclose(a, b, atol=1e-9)


@pytest.mark.parametrize("order", [2, 4, 6])
def test_the_order_is_as_stated(order):
    """Halving the step divides the error by 2^order: first derivatives everywhere, second ones
    where the nodes lie about the point, one order less at the sides."""

    def wave(uv):
        return np.sin(3 * uv[:, :1] + 0.2) * np.cos(2 * uv[:, 1:])

    domain = ((0.0, 1.0), (0.0, 1.0))

    def errors(step, uv):
        r = Differences(domain, order, (step, step)).both(wave, uv)
        (u, v) = uv.T
        s, c, s2, c2 = np.sin(3 * u + 0.2), np.cos(3 * u + 0.2), np.sin(2 * v), np.cos(2 * v)
        exact = (3 * c * c2, -2 * s * s2, -9 * s * c2, -6 * c * s2, -4 * s * c2)
        return [np.abs(a[:, 0] - b).max() for a, b in zip(r, exact)]

    inside = np.array([[0.41, 0.53], [0.55, 0.47]])
    sides = np.array([[0.0, 0.53], [1.0, 0.2], [0.3, 1.0]])
    h = {2: 0.02, 4: 0.05, 6: 0.06}[order]
    for a, b in zip(errors(h, inside), errors(h / 2, inside)):
        assert np.log2(a / b) == pytest.approx(order, abs=0.25)
    for k, (a, b) in enumerate(zip(errors(h, sides), errors(h / 2, sides))):
        least = order if k < 2 else order - 1
        assert np.log2(a / b) > least - 0.35


def test_nothing_is_asked_for_outside_the_domain():
    def dome(u, v):
        with np.errstate(all="raise"):
            return u, v, np.sqrt(u) * np.sqrt(1 - v)

    surface = sm.NumericSurface(dome, u=(0, 1), v=(0, 1))
    assert np.isfinite(np.hstack(surface.evaluate(points_of(surface), 2))).all()


def torus_rates(u, v):
    s, c, sv, cv = np.sin(u), np.cos(u), np.sin(v), np.cos(v)
    return (-(3 + cv) * s, (3 + cv) * c, 0), (-sv * c, -sv * s, cv)


def torus_all(u, v):
    s, c, sv, cv = np.sin(u), np.cos(u), np.sin(v), np.cos(v)
    second = (-(3 + cv) * c, -(3 + cv) * s, 0), (sv * s, -sv * c, 0), (-cv * c, -cv * s, -sv)
    return *torus_rates(u, v), *second


@pytest.mark.parametrize("given, tolerance", [(torus_rates, 1e-8), (torus_all, 1e-14)])
def test_derivatives_by_the_caller(given, tolerance):
    surface = sm.NumericSurface(torus, (0, TAU), (0, TAU), derivatives=given)
    exact = sm.ParametricSurface(*TWINS["torus"][3], u=(0, TAU), v=(0, TAU))
    uv = points_of(surface)
    for a, b in zip(surface.evaluate(uv, 2), exact.evaluate(uv, 2)):
        np.testing.assert_allclose(a, b, atol=tolerance * 10)


def test_derivatives_that_are_not_finite_come_from_differences():
    def rates(u, v):
        with np.errstate(all="ignore"):
            return (1 + 0 * u, 0, 0 / u), (0, 1 + 0 * v, 0)

    surface = sm.NumericSurface(lambda u, v: (u, v, 0 * u), (0, 1), (0, 1), derivatives=rates)
    _, r_u, _ = surface.evaluate(np.array([[0.0, 0.5], [0.5, 0.5]]), 1)
    np.testing.assert_allclose(r_u, [[1, 0, 0], [1, 0, 0]], atol=1e-9)


@pytest.mark.parametrize("n", [0, 1, 2, 3, 4])
@pytest.mark.parametrize("f", [torus, sphere, two_peaks])
def test_few_points_in_any_layout(f, n):
    surface = sm.NumericSurface(f, (0, 1), (0, 2))
    uv = np.random.default_rng(0).random((n, 2))
    many = surface.evaluate(np.concatenate([uv, uv, uv, uv + 0.1, [[0, 0]]]), 2)
    for a, b in zip(surface.evaluate(uv, 2), many):
        assert a.shape == (n, 3)
        np.testing.assert_allclose(a, b[:n], atol=1e-12)


REFUSED = [
    ({"f": "u"}, "ParametricSurface"),
    ({"derivatives": 3}, "derivatives is a function"),
    ({"differences": 3}, "order 2, 4 or 6"),
    ({"step": 0.5}, "fraction of the domain"),
    ({"u": (1, 1)}, "domain of u is empty"),
    ({"f": lambda u, v: (u, v)}, r"f must give \(x, y, z\).*it gave tuple"),
    ({"f": lambda u, v: np.zeros((len(u), 2))}, r"it gave \(\d+, 2\)"),
    ({"f": lambda u, v: None}, "NoneType"),
    ({"f": lambda u, v: (u, v, np.where(u > 0.5, np.nan, 0))}, r"not finite at .*0\.5"),
    ({"f": lambda u, v: (u, u, u)}, "no area"),
    ({"f": lambda u, v: (1, 2, 3)}, "single point"),
    ({"derivatives": lambda u, v: (u, v, u)}, "derivatives must give"),
    ({"derivatives": lambda u, v: ((u, v, u),)}, "derivatives gives"),
]


@pytest.mark.parametrize("what, reason", REFUSED)
def test_refused_with_the_reason(what, reason):
    options = {"f": lambda u, v: (u, v, u * v), "u": (0, 1), "v": (0, 1)} | what
    with pytest.raises(SurfaceError, match=reason):
        sm.NumericSurface(**options)


def test_what_the_function_raises_comes_through():
    def broken(u, v):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        sm.NumericSurface(broken, (0, 1), (0, 1))


def test_steps_suit_a_surface_that_changes_fast():
    def ripple(u, v):
        return u, v, np.sin(40 * u) / 40

    surface = sm.NumericSurface(ripple, (0, 10), (0, 10), differences=6)
    uv = points_of(surface)
    np.testing.assert_allclose(
        surface.evaluate(uv, 2)[3][:, 2], -40 * np.sin(40 * uv[:, 0]), atol=40 * 3e-4
    )
    assert surface.difference_error < 1e-3


@pytest.mark.parametrize("name", TWINS)
def test_meshes_are_as_good_as_those_of_formulas(name):
    f, u, v, formulas = TWINS[name]
    sizing = sm.Sizing(chord=0.03)
    given = sm.NumericSurface(f, u, v, name=name)
    reports = [
        sm.check(sm.mesh(surface, sizing))
        for surface in (given, sm.ParametricSurface(*formulas, u=u, v=v))
    ]
    for report in reports:
        assert report.clean, report.problems
        assert report.deviation_max <= 0.03
    assert reports[0].euler == reports[1].euler
    assert reports[0].triangles == pytest.approx(reports[1].triangles, rel=0.03)
    assert reports[0].alpha_mean > 0.95


class Wrapped:
    """The points of another surface as a function of u and v."""

    def __init__(self, surface):
        self.surface = surface

    def __call__(self, u, v):
        return self.surface.evaluate(np.column_stack([u, v]))[0]


@pytest.mark.parametrize("name", gallery())
def test_the_gallery_by_differences(name):
    exact = sm.load(name)
    given = sm.NumericSurface(Wrapped(exact), *exact.domain, loops=exact.loops, differences=6)
    assert given.difference_error < 1e-6
    (u0, u1), (v0, v1) = exact.domain
    parts = np.array([u1 - u0, v1 - v0, (u1 - u0) ** 2, (u1 - u0) * (v1 - v0), (v1 - v0) ** 2])
    uv = points_of(exact, 200)
    found, wanted = given.evaluate(uv, 2), exact.evaluate(uv, 2)
    rates = [part * np.abs(value).max() for part, value in zip(parts, wanted[1:])]
    scale = max(np.ptp(wanted[0], axis=0).max(), *rates)
    for part, a, b in zip(parts, found[1:], wanted[1:]):
        assert part * np.abs(a - b).max() < 2e-6 * scale


@pytest.mark.parametrize("name", ["cone", "ellipsoid", "mobius", "pierced_saddle", "plane"])
def test_poles_seams_twists_and_loops_are_found(name):
    exact = sm.load(name)
    given = sm.NumericSurface(Wrapped(exact), *exact.domain, loops=exact.loops, name=name)
    sizing = sm.Sizing(chord=0.005, max_size=0.5)
    found, wanted = (sm.check(sm.mesh(surface, sizing)) for surface in (given, exact))
    assert found.clean, found.problems
    assert (found.euler, found.closed, found.oriented) == (
        wanted.euler, wanted.closed, wanted.oriented
    )  # fmt: skip
    assert found.triangles == pytest.approx(wanted.triangles, rel=0.03)
    assert found.area == pytest.approx(wanted.area, rel=1e-3)


def test_it_travels_and_does_not_change():
    surface = sm.NumericSurface(torus, (0, TAU), (0, "2*pi"), name="ring")
    twin = pickle.loads(pickle.dumps(surface))
    uv = points_of(surface)
    for a, b in zip(surface.evaluate(uv, 2), twin.evaluate(uv, 2)):
        assert np.array_equal(a, b)
    assert repr(surface) == "NumericSurface('ring', torus, u=(0, 6.28319), v=(0, 6.28319))"
    with pytest.raises(AttributeError, match="make a new one"):
        surface.name = "other"


@pytest.mark.parametrize(
    "u, v, height",
    [((0, 10), (0, 10), lambda u, v: np.sin(u) * np.cos(v)), ((-1e-3, 2e-3), (5, 7), np.multiply)],
)
@pytest.mark.parametrize(
    "options", [{"chord": 0.02}, {"size": 0.8}, {"chord": 0.05, "anisotropy": 4}]
)
def test_a_function_is_never_asked_outside_of_its_domain(u, v, height, options):
    asked = []

    def told(a, b):
        asked.append((a.min() - u[0], u[1] - a.max(), b.min() - v[0], v[1] - b.max()))
        return a * (10 / (u[1] - u[0])), b, height(a, b)

    assert sm.check(sm.mesh(sm.NumericSurface(told, u=u, v=v), sm.Sizing(**options))).clean
    assert np.min(asked) >= 0.0


def test_beyond_the_end_of_a_closed_surface_lies_its_other_end():
    def tube(u, v):
        return np.cos(u), np.sin(u), v

    surface = sm.NumericSurface(tube, u=(0, 2 * np.pi), v=(0, 1))
    assert surface.closed == (True, False)
    beyond = np.array([[-0.1, 0.2], [6.4, 1.0], [7.0, 1.25]])  # straight on where it is open
    expected = np.transpose(tube(*beyond.T))
    assert surface.evaluate(beyond)[0] == pytest.approx(expected, abs=1e-6)


def test_functions_of_single_numbers_and_of_complex_ones_are_refused_with_a_cure():
    def one(u, v):
        return u, v, math.sin(u)

    def branch(u, v):
        return np.array([u, v, 1.0 if u > 0.5 else 0.0])

    for function in (one, branch):
        with pytest.raises(sm.errors.SurfaceError, match=r"np\.vectorize"):
            sm.NumericSurface(function, u=(0, 1), v=(0, 1))
    wrapped = sm.NumericSurface(np.vectorize(one), u=(0, 1), v=(0, 1))
    assert wrapped.evaluate([[0.5, 0.25]])[0][0] == pytest.approx([0.5, 0.25, math.sin(0.5)])
    with pytest.raises(sm.errors.SurfaceError, match="complex") as refusal:
        sm.NumericSurface(lambda u, v: (u, v, np.sqrt(u - 2 + 0j)), u=(0, 1), v=(0, 1))
    assert "\n" not in str(refusal.value)
