"""The same mesh at every scale that is computed with, and one line for those that are not."""

import warnings

import numpy as np
import pytest

import surfmesh as sm
from surfmesh.errors import SurfmeshError

POWERS = (-95, 30, 95)  # 3e-29, 1e9, 4e28
BEYOND = (1e-310, 1e-160, 1e-150, 1e-32, 1e32, 1e150, 1e160, 1e300)


def plate(k):
    loops = [[(0, 0), (8, 0), (8, 5), (0, 5)], [(1, 1), (2, 1), (2, 2), (1, 2)], [(4, 0), (4, 3)]]
    outer, hole, line = (k * np.array(loop, float) for loop in loops)
    return sm.PlanarDomain(outer, holes=[hole], constraints=[line])


def saddle(k):
    formulas = f"{k!r}*u", f"{k!r}*v", f"{k!r}*(u**2 - v**2)"
    return sm.ParametricSurface(*formulas, u=(-1, 1), v=(-1, 1))


def wave(k):
    return sm.NumericSurface(lambda u, v: (k * u, k * v, k * np.sin(u * v)), u=(-2, 2), v=(-2, 2))


@pytest.mark.parametrize("make", [plate, saddle, wave])
def test_a_power_of_two_changes_nothing(make):
    def wanted(k):
        return 2.5 * k if make is plate else sm.Sizing(chord=0.2 * k, angle=30)

    first = sm.mesh(make(1.0), wanted(1.0))
    for power in POWERS:
        k = 2.0**power
        made = sm.mesh(make(k), wanted(k))
        assert np.array_equal(made.triangles, first.triangles)
        assert np.array_equal(made.points, k * first.points)
        assert sm.check(made).clean


@pytest.mark.parametrize("k", BEYOND)
@pytest.mark.parametrize("make", [plate, saddle, wave])
def test_refused_in_one_line(make, k):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(SurfmeshError, match=r"^[^\n]*(too (small|far away) to|beyond 1e.30)"):
            make(k)


def bowl(width):
    def r(u, v):
        return u / width, v, (u / width) ** 2 + v * v

    return sm.NumericSurface(r, u=(-width / 2, width / 2), v=(-1, 1))


def bowl_by_formulas(width):
    formulas = f"u/{width!r}", "v", f"(u/{width!r})**2 + v**2"
    return sm.ParametricSurface(*formulas, u=(-width / 2, width / 2), v=(-1, 1))


@pytest.mark.parametrize(
    "make, width",
    [(bowl, 1e-310), (bowl, 1e-90), (bowl, 1e290), (bowl_by_formulas, 1e-90),
     (bowl_by_formulas, 1e90)],
)  # fmt: skip
def test_parameters_whose_derivatives_are_no_numbers(make, width):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(SurfmeshError, match=r"^[^\n]*domain of u[^\n]*(scale u|its unit)"):
            make(width)
