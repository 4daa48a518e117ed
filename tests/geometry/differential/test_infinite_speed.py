"""Axes bent where the speed has no bound: exponents, inverses, finite derivatives."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.differential.infinite_speed import BentAxis
from surfmesh.geometry.formulas.parametric import ParametricSurface

TURN = (0, "2*pi")

POWERS = [
    (("v*cos(u)", "v*sin(u)", "sqrt(1 - v**2)"), TURN, (0, 1), (1, 2)),
    (("sqrt(v)*cos(u)", "sqrt(v)*sin(u)", "v"), TURN, (0, 1), (2, 1)),
    (("sqrt(1e6 - v**2)*cos(u)", "sqrt(1e6 - v**2)*sin(u)", "v"), TURN, (-1000, 1000), (2, 2)),
    (("u", "v", "cbrt(v)"), (0, 1), (0, 1), (3, 1)),
    (("u", "v", "(v - 2)**0.25 + v"), (0, 1), (2, 5), (4, 1)),
    (("u", "v", "v**(2/3)"), (0, 1), (0, 1), (1.5, 1)),
    (("cos(u)", "sin(u)", "acos(v)"), TURN, (-1, 1), (2, 2)),
    (("u", "v", "sqrt(1 - exp(-v))"), (0, 1), (0, 1), (2, 1)),
]


@pytest.mark.parametrize("formulas, u, v, powers", POWERS, ids=str)
def test_exponents_are_found(formulas, u, v, powers):
    surface = ParametricSurface(*formulas, u=u, v=v)
    assert surface.bent_axes[0] is None
    assert surface.bent_axes[1].powers.tolist() == [list(powers)]


def test_ordinary_surfaces_stay_as_they_are():
    for formulas in (("u", "v", "u*v"), ("u**2*cos(v)", "u**2*sin(v)", "u"), ("u", "v", "v**1.5")):
        surface = ParametricSurface(*formulas, u=(0, 1), v=(0, 1))
        assert surface.bent_axes == (None, None)


@given(
    st.floats(1.0, 6.0), st.floats(1.0, 6.0), st.floats(-1e3, 1e3), st.floats(1e-3, 1e3),
    st.lists(st.floats(0.0, 1.0), min_size=1, max_size=9),
)  # fmt: skip
def test_bent_parameters_and_back(q0, q1, first, length, fractions):
    axis = BentAxis(np.array([first, first + length]), np.array([[q0, q1]]))
    s = first + length * np.array(fractions)
    u = axis.parameter(s)
    assert ((u >= first) & (u <= first + length)).all()
    assert np.allclose(axis.parameter(axis.bent(u)), u, rtol=0, atol=1e-12 * (abs(first) + length))
    inner = np.clip(s, first + 0.1 * length, first + 0.9 * length)
    step = 1e-5 * length
    rate, second = axis.rates(inner)
    sides = [axis.parameter(inner + way * step) for way in (-1, 0, 1)]
    assert np.allclose((sides[2] - sides[0]) / (2 * step), rate, rtol=1e-3, atol=1e-5)
    bending = (axis.rates(inner + step)[0] - axis.rates(inner - step)[0]) / (2 * step)
    assert np.allclose(bending * length, second * length, rtol=1e-3, atol=1e-3)


@pytest.mark.parametrize("radius", [1e-3, 1.0, 1e3])
def test_speeds_in_the_scaled_plane_are_finite_and_even(radius):
    """A dome over its disc: in the scaled plane its meridians run at the speed one."""
    dome = ParametricSurface(
        "v*cos(u)", "v*sin(u)", "sqrt(R**2 - v**2)", TURN, (0, radius), parameters={"R": radius}
    )
    chart = Chart.of(dome)
    assert chart.extent[1] == pytest.approx(0.5 * np.pi * radius, rel=1e-3)
    y = chart.extent[1] * np.r_[np.linspace(0, 1, 50), 1 - 1e-9]
    xy = np.stack([np.full_like(y, 0.3 * radius), y], axis=1)
    uv, rates = chart.to_uv_and_rates(xy)
    r, _, r_v = dome.evaluate(uv, 1)
    assert np.allclose(np.linalg.norm(r_v, axis=1) * rates[:, 1], 1.0, atol=5e-3)
    assert r[-2, 2] == 0.0 and uv[-2, 1] == radius  # values are exact on the rim
    assert np.allclose(chart.to_plane(uv)[:-1], xy[:-1], atol=1e-7 * radius)


def test_derivatives_beside_the_rim_are_those_at_most_a_little_inside():
    dome = ParametricSurface("u", "v", "sqrt(1 - u**2)", (-1, 1), (0, 1))
    uv = np.array([[1.0, 0.5], [-1.0, 0.5], [1.0 - 1e-13, 0.5], [0.6, 0.5]])
    r, r_u, _, r_uu, *_ = dome.evaluate(uv, 2)
    assert np.isfinite(r_u).all() and np.isfinite(r_uu).all()
    assert r[0].tolist() == [1, 0.5, 0] and r_u[3] == pytest.approx([1, 0, -0.75])
    curvature = np.linalg.norm(np.cross(r_u, r_uu), axis=1) / np.linalg.norm(r_u, axis=1) ** 3
    assert curvature == pytest.approx([1, 1, 1, 1], rel=1e-4)
