"""An axis that runs to elongated poles: there and back, by differences, and by directions."""

import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh._core.surfaces import Chart, ChartAxis
from surfmesh.geometry.differential.chart import Chart as OwnChart

TURN = 2.0 * np.pi


def axis(first: float, last: float) -> ChartAxis:
    """As long as its parameters are."""
    return ChartAxis(last - first, np.array([first, last]), np.ones(2))


def elongated(ratio: float, places: int = 1025) -> np.ndarray:
    """Distances from the pole of an ellipse with half axes ``ratio`` and 1, over the least."""
    u = np.linspace(0.0, TURN, places)
    return np.hypot(ratio * np.cos(u), np.sin(u))


def ellipsoid(a: float, b: float, c: float) -> sm.ParametricSurface:
    return sm.ParametricSurface(
        f"{a}*cos(v)*cos(u)", f"{b}*cos(v)*sin(u)", f"{c}*sin(v)",
        u=(0, "2*pi"), v=("-pi/2", "pi/2"),
    )  # fmt: skip


@settings(max_examples=40)
@given(
    st.sampled_from([0, 1]), st.sampled_from([0, 1, 2]), st.floats(0.2, 1.5), st.floats(1.0, 50.0),
    st.integers(0, 10_000),
)  # fmt: skip
def test_the_plane_and_back(scaled, poles, angle, ratio, seed):
    rng = np.random.default_rng(seed)
    k = elongated(ratio, 65), 1.0 + rng.uniform(0.0, 3.0, 9)
    chart = Chart(axis(0.0, TURN), axis(0.0, TURN), (scaled, poles, angle, k))
    xy = TURN * rng.uniform(0.0, 1.0, (50, 2))
    xy[:8] = TURN * np.array(np.meshgrid([0, 1], [0, 1])).T.reshape(-1, 2)[[0, 1, 2, 3] * 2]
    uv, rates = chart.to_uv_and_rates(xy)
    assert (rates > 0.0).all()
    assert (uv[:8] == xy[:8]).all()  # sides stay where they are
    np.testing.assert_allclose(chart.to_plane(uv), xy, rtol=0, atol=1e-9 * ratio)
    crossed, step = chart.crossed_rates(xy[8:]), 1e-6
    for k, h in enumerate(np.eye(2) * step):
        ahead, behind = (chart.to_uv_and_rates(xy[8:] + way * h)[0] for way in (1, -1))
        slope = (ahead - behind) / (2.0 * step)
        np.testing.assert_allclose(slope[:, k], rates[8:, k], rtol=1e-3, atol=1e-4)
        np.testing.assert_allclose(slope[:, 1 - k], crossed[:, 1 - k], rtol=1e-2, atol=1e-2)


@pytest.mark.parametrize("ratio", [4.0, 20.0])
def test_of_an_ellipsoid_they_are_directions_from_its_centre(ratio):
    k = elongated(ratio)
    chart = Chart(axis(0.0, TURN), axis(0.0, np.pi), (1, 2, 1.0, (k, k)))
    uv = np.random.default_rng(1).uniform(0.0, 1.0, (200, 2)) * [TURN, np.pi]
    u, v = uv.T
    far = np.hypot(ratio * np.cos(u), np.sin(u)) * np.sin(v)
    np.testing.assert_allclose(chart.to_plane(uv)[:, 1], np.arctan2(far, np.cos(v)), atol=1e-3)


@pytest.mark.parametrize(
    "arguments", [(2, 2, 1.0), (1, 3, 1.0), (1, -1, 1.0), (1, 2, 0.0), (1, 2, 1.7)]
)
def test_what_is_no_scaling_is_refused(arguments):
    with pytest.raises(ValueError):
        Chart(axis(0.0, 1.0), axis(0.0, 1.0), (*arguments, (np.ones(2), np.ones(2))))
    for wrong in (np.ones(1), np.zeros(3), np.full(2, np.nan)):
        with pytest.raises(ValueError):
            Chart(axis(0.0, 1.0), axis(0.0, 1.0), (1, 2, 1.0, (wrong, np.ones(2))))


def test_only_elongated_poles_count():
    assert OwnChart.of(ellipsoid(3, 2, 1)).core.scaling is None
    assert OwnChart.of(ellipsoid(1, 1, 20)).core.scaling is None
    assert OwnChart.of(sm.load("torus")).core.scaling is None
    scaled, poles, _, (first, last) = OwnChart.of(ellipsoid(10, 1, 1)).core.scaling
    assert (scaled, poles) == (1, 2)
    for k in (first, last):
        assert k.min() == 1.0 and k.max() == pytest.approx(10.0, rel=1e-3)
    cone = sm.ParametricSurface("v", "10*v*cos(u)", "v*sin(u)", u=(0, "2*pi"), v=(0, 1))
    assert OwnChart.of(cone).core.scaling[1] == 0
    turned = sm.ParametricSurface("u", "10*u*cos(v)", "u*sin(v)", u=(-1, 0), v=(0, "2*pi"))
    assert OwnChart.of(turned).core.scaling[:2] == (0, 1)


def test_a_scaled_chart_goes_to_other_processes():
    chart = OwnChart.of(ellipsoid(10, 1, 1))
    xy = np.random.default_rng(1).uniform(0.0, 1.0, (20, 2)) * chart.extent
    assert (pickle.loads(pickle.dumps(chart)).to_uv(xy) == chart.to_uv(xy)).all()
