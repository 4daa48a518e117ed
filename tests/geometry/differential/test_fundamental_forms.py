"""Curvatures against analysis; safe where a surface has no tangent plane."""

import numpy as np
import pytest

from surfmesh.geometry.differential.fundamental_forms import area, curvatures, forms
from surfmesh.geometry.files.formula_file import gallery, load_formula_file
from surfmesh.geometry.formulas.parametric import ParametricSurface


def surface(name):
    return load_formula_file(gallery()[name])


def inside(surface, count=400, seed=0):
    lo, hi = np.array(surface.domain).T
    return lo + (hi - lo) * np.random.default_rng(seed).uniform(0.02, 0.98, (count, 2))


def first(forms, a, b):
    """a . I . b for directions (n, 2) in (u, v)."""
    return (
        forms.E * a[:, 0] * b[:, 0]
        + forms.F * (a[:, 0] * b[:, 1] + a[:, 1] * b[:, 0])
        + forms.G * a[:, 1] * b[:, 1]
    )


def second(forms, a, b):
    """a . II . b for directions (n, 2) in (u, v)."""
    return first(forms._replace(E=forms.L, F=forms.M, G=forms.N), a, b)


@pytest.mark.parametrize("name", gallery())
def test_principal_directions_are_what_they_are_called(name):
    s = surface(name)
    f = forms(s, inside(s))
    c = curvatures(f)
    size = np.abs(c.k1) + np.abs(c.k2) + 1e-12
    assert (c.k1 >= c.k2).all()
    assert first(f, c.d1, c.d1) == pytest.approx(1, abs=1e-9)
    assert first(f, c.d2, c.d2) == pytest.approx(1, abs=1e-9)
    assert np.abs(first(f, c.d1, c.d2)).max() < 1e-9
    assert np.abs(second(f, c.d1, c.d2) / size).max() < 1e-9
    assert np.abs((second(f, c.d1, c.d1) - c.k1) / size).max() < 1e-9
    assert np.abs((second(f, c.d2, c.d2) - c.k2) / size).max() < 1e-9
    assert (c.d1[:, 0] * c.d2[:, 1] > c.d1[:, 1] * c.d2[:, 0]).all()


@pytest.mark.parametrize("radius", [1e-6, 1.0, 1e6])
def test_sphere(radius):
    s = ParametricSurface(
        "R*cos(v)*cos(u)",
        "R*cos(v)*sin(u)",
        "R*sin(v)",
        u=(0, "2*pi"),
        v=("-pi/2", "pi/2"),
        parameters={"R": radius},
    )
    uv = inside(s)
    f = forms(s, uv)
    c = curvatures(f)
    assert c.k1 * radius == pytest.approx(-1, rel=1e-12)
    assert c.k2 * radius == pytest.approx(-1, rel=1e-12)
    assert f.normal == pytest.approx(s.evaluate(uv)[0] / radius, abs=1e-12)


def test_torus_principal_curvatures():
    s = surface("torus")
    uv = inside(s)
    c = curvatures(forms(s, uv))
    along_tube, around_axis = -1.0, -np.cos(uv[:, 1]) / (3 + np.cos(uv[:, 1]))
    assert c.k2 == pytest.approx(np.full(len(uv), along_tube))
    assert c.k1 == pytest.approx(around_axis)
    assert np.abs(c.d2[:, 0]).max() < 1e-12  # k2 belongs to the circle of the tube, along v


@pytest.mark.parametrize("name", ["catenoid", "helicoid", "enneper"])
def test_minimal_surfaces(name):
    s = surface(name)
    c = curvatures(forms(s, inside(s)))
    assert np.abs(c.mean).max() < 1e-13 * np.abs(c.k1).max()


def test_ellipsoid_ends_of_the_axes():
    """At the end of axis a the principal curvatures are a/b^2 and a/c^2 (do Carmo, 3-3)."""
    a, b, c = 3.0, 2.0, 1.0
    k = curvatures(forms(surface("ellipsoid"), [[0, 0], [np.pi / 2, 0]]))
    assert k.k1 == pytest.approx([-a / b**2, -b / a**2])
    assert k.k2 == pytest.approx([-a / c**2, -b / c**2])


def test_monkey_saddle_middle_is_flat_and_its_rim_is_not():
    s = surface("monkey_saddle")
    c = curvatures(forms(s, [[0, 0], [0.5, 0]]))
    assert (c.k1[0], c.k2[0]) == (0, 0)
    # on v = 0: z_uu = 6u, z_vv = -6u, slope 3u^2
    slope = 1 + (3 * 0.25) ** 2
    assert c.k1[1] == pytest.approx(3 / slope**1.5)
    assert c.k2[1] == pytest.approx(-3 / slope**0.5)


def test_small_curvature_beside_a_large_stretch_keeps_its_digits():
    """A cylinder of radius 1 with u in millionths of a radian."""
    s = ParametricSurface("cos(1e-6*u)", "sin(1e-6*u)", "v", u=(0, 1e6), v=(0, 1))
    c = curvatures(forms(s, inside(s)))
    assert c.k2 == pytest.approx(-1, rel=1e-12)
    assert np.abs(c.k1).max() < 1e-12


# Whitney's umbrella: r_v = 0 at the pinch point, within the domain
UMBRELLA = ParametricSurface("u*v", "u", "v**2", u=(-1, 1), v=(-1, 1))


@pytest.mark.parametrize(
    "name, place",
    [
        ("sphere", (1.0, np.pi / 2)),
        ("sphere", (1.0, -np.pi / 2)),
        ("ellipsoid", (0.3, np.pi / 2)),
        ("cone", (2.0, 0.0)),
        ("umbrella", (0.0, 0.0)),
    ],
)
def test_degenerate_places_are_named_and_finite(name, place):
    s = UMBRELLA if name == "umbrella" else surface(name)
    f = forms(s, [place, (0.4, 0.2)])
    c = curvatures(f)
    assert f.degenerate.tolist() == [True, False]
    assert (c.k1[0], c.k2[0], c.gaussian[0], c.mean[0]) == (0, 0, 0, 0)
    assert all(np.isfinite(value).all() for value in (*c, *f))
    assert np.linalg.norm(f.normal, axis=1) == pytest.approx(1)


def test_normal_at_a_pole():
    f = forms(surface("sphere"), [[0.7, np.pi / 2], [0.7, -np.pi / 2]])
    assert f.normal == pytest.approx(np.array([[0, 0, 1], [0, 0, -1]]), abs=1e-5)


def test_umbilics_have_a_fixed_orthonormal_pair():
    s = surface("sphere")
    f = forms(s, inside(s))
    c = curvatures(f)
    assert first(f, c.d1, c.d2) == pytest.approx(0, abs=1e-12)
    flat = curvatures(forms(surface("plane"), [[1, 1]]))
    assert flat.d1.tolist() == [[1, 0]] and flat.d2.tolist() == [[0, 1]]


def test_area_converges_at_the_order_of_the_rule():
    s = surface("ellipsoid")
    errors = [abs(area(s, cells, points=2) - s.facts["area"]) for cells in (8, 16, 32)]
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (rates > 3.7).all()  # two points a cell: order 4


def test_area_inside_loops():
    plate = {"u": (0, 4), "v": (0, 3)}
    triangle = [(0.5, 0.5), (3.5, 0.5), (0.5, 2.5)]
    hole = [(1, 1), (1, 1.25), (1.5, 1)]  # clockwise: direction does not matter
    s = ParametricSurface("2*u", "v", "0", **plate, loops=[triangle, hole])
    assert area(s, 2) == pytest.approx(2 * (3.0 - 0.0625))
