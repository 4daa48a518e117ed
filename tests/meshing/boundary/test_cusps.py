"""Horns, needles and drops: a pole thinner than any cone is one vertex at the end of a fan.

Areas: of revolution, 2 pi times the integral of rho ds.
"""

import re

import numpy as np
import pytest
from scipy.integrate import quad

import surfmesh as sm
from surfmesh.geometry.differential.sides import find_sides
from surfmesh.meshing.boundary.cusps import find_cusps

TURN = (0, "2*pi")
PROFILES = {  # radius, height, domain, area's derivative, Euler number
    "horn": ("t**2", "t", (0, 1), lambda t: t**2 * np.hypot(2 * t, 1), 1),
    "thin horn": ("t**3", "t", (0, 1), lambda t: t**3 * np.hypot(3 * t**2, 1), 1),
    "needle": (
        "exp(-1/(t + 1e-9))", "t", (0, 1),
        lambda t: np.exp(-1 / t) * np.hypot(np.exp(-1 / t) / t**2, 1), 1,
    ),
    "spindle": (
        "300*(1 - t**2)**2", "1000*t", (-1, 1),
        lambda t: 300 * (1 - t**2) ** 2 * np.hypot(1200 * t * (1 - t**2), 1000), 2,
    ),
    "drop": (
        "sin(t)*sin(t/2)**2", "cos(t)", (0, "pi"),
        lambda t: (
            np.sin(t) * np.sin(t / 2) ** 2
            * np.hypot(np.cos(t) * np.sin(t / 2) ** 2 + 0.5 * np.sin(t) ** 2, np.sin(t))
        ), 2,
    ),
}  # fmt: skip


def surface_of(name, along="u"):
    radius, height, domain, _, _ = PROFILES[name]
    around = "v" if along == "u" else "u"
    radius, height = (re.sub(r"\bt\b", along, text) for text in (radius, height))
    x, y = f"({radius})*cos({around})", f"({radius})*sin({around})"
    return sm.ParametricSurface(x, y, height, **{along: domain, around: TURN}, name=name)


@pytest.mark.parametrize("name", PROFILES)
def test_clean_to_the_tip(name):
    along = "v" if name == "thin horn" else "u"
    surface = surface_of(name, along)
    *_, (first, last), rate, euler = PROFILES[name]
    area = 2 * np.pi * quad(rate, first, 3.141592653589793 if last == "pi" else last)[0]
    scale = 1000.0 if name == "spindle" else 1.0
    for sizing in (sm.Sizing(chord=5e-3 * scale), 0.08 * scale):
        mesh = sm.mesh(surface, sizing)
        report = sm.check(mesh)
        assert report.clean, report.problems
        assert report.euler == euler and mesh.surfaces == (surface,)
        assert report.area == pytest.approx(area, rel=0.04)
        low, high = np.array(surface.domain).T
        assert mesh.uv_points.min(axis=0) == pytest.approx(low)
        assert mesh.uv_points.max(axis=0) == pytest.approx(high)
        if isinstance(sizing, sm.Sizing):
            assert report.deviation_max <= sizing.chord and report.triangles < 6000


def test_a_numeric_horn():
    def horn(u, v):
        return u**2 * np.cos(v), u**2 * np.sin(v), u

    surface = sm.NumericSurface(horn, u=(0, 1), v=TURN)
    report = sm.check(sm.mesh(surface, sm.Sizing(chord=5e-3, anisotropy=4)))
    assert report.clean and report.deviation_max <= 5e-3


def test_ordinary_poles_are_no_cusps():
    for name in ("sphere", "cone", "ellipsoid"):
        surface = sm.load(name)
        assert find_cusps(surface, find_sides(surface), sm.Sizing(chord=0.01)) == ()


def test_second_order_and_estimate_reach_the_tip():
    surface, sizing = surface_of("horn"), sm.Sizing(chord=0.02)
    mesh = sm.mesh(surface, sizing, order=2)
    assert mesh.mid_points is not None
    assert sm.estimate(surface, sizing).triangles == pytest.approx(len(mesh.triangles), rel=0.1)
