"""Formulas whose speed has no bound at a rim or a pole: clean, within the chord, of the right area.

Areas: spheres and cylinders; paraboloid z = r^2 up to 1: pi / 6 (5^1.5 - 1).
"""

import math

import numpy as np
import pytest

import surfmesh as sm

TURN = (0, "2*pi")
DOME = ("v*cos(u)", "v*sin(u)", "sqrt(1-v**2)")
SURFACES = {
    "dome over its disc": (DOME, TURN, (0, 1), 2 * math.pi),
    "dome, u and v swapped": (("u*sin(v)", "u*cos(v)", "sqrt(1-u**2)"), (0, 1), TURN, 2 * math.pi),
    "paraboloid by height": (
        ("sqrt(v)*cos(u)", "sqrt(v)*sin(u)", "v"), TURN, (0, 1), math.pi / 6 * (5**1.5 - 1)
    ),
    "sphere by height": (
        ("sqrt(1-v**2)*cos(u)", "sqrt(1-v**2)*sin(u)", "v"), TURN, (-1, 1), 4 * math.pi
    ),
    "sphere by its cosine": (
        ("sin(acos(v))*cos(u)", "sin(acos(v))*sin(u)", "v"), TURN, (-1, 1), 4 * math.pi
    ),
    "half cylinder over its base": (
        ("u", "v", "sqrt(1e6-u**2)"), (-1e3, 1e3), (0, 2e3), 2e6 * math.pi
    ),
    "fourth roots at a pole": (("v**0.25*cos(u)", "v**0.25*sin(u)", "0"), TURN, (0, 1), math.pi),
    "cone by its area": (
        ("sqrt(v)*cos(u)", "sqrt(v)*sin(u)", "sqrt(v)"), TURN, (0, 1), math.pi * 2**0.5
    ),
}  # fmt: skip
EULER = {"sphere by height": 2, "sphere by its cosine": 2}


@pytest.mark.parametrize("name", SURFACES)
@pytest.mark.parametrize("sizing", ["chord", "size", "anisotropy"])
def test_clean_within_the_chord_and_of_the_right_area(name, sizing):
    formulas, u, v, area = SURFACES[name]
    surface = sm.ParametricSurface(*formulas, u=u, v=v, name=name)
    scale = math.sqrt(area)
    sizings = {
        "chord": sm.Sizing(chord=2e-3 * scale, max_size=0.1 * scale),
        "size": 0.06 * scale,
        "anisotropy": sm.Sizing(chord=2e-3 * scale, max_size=0.1 * scale, anisotropy=5),
    }
    mesh = sm.mesh(surface, sizings[sizing])
    report = sm.check(mesh)
    assert report.clean, report.problems
    assert report.area == pytest.approx(area, rel=0.02)
    assert report.euler == EULER.get(name, 1)
    assert report.triangles < 2500
    if sizing != "size":
        assert report.deviation_max <= 2e-3 * scale
    if name == "dome over its disc":  # parameters are the user's own
        low, high = np.array(surface.domain).T
        assert ((mesh.uv_points >= low) & (mesh.uv_points <= high)).all()
        images = surface.evaluate(mesh.uv_points[mesh.uv_triangles.ravel()])[0]
        assert np.allclose(mesh.points[mesh.triangles.ravel()], images, atol=1e-12)


def test_a_pole_that_rounding_has_opened_is_a_pole():
    """sqrt(sin(v)) at v = pi is 1e-8, not 0."""
    bead = sm.ParametricSurface("sqrt(sin(v))*cos(u)", "sqrt(sin(v))*sin(u)", "v", TURN, (0, "pi"))
    report = sm.check(sm.mesh(bead, 0.25))
    assert report.clean and report.closed and report.euler == 2


NUMERIC = {
    "sphere by height": (
        lambda u, v: (np.sqrt(1 - v * v) * np.cos(u), np.sqrt(1 - v * v) * np.sin(u), v),
        (-1, 1), 4 * math.pi,
    ),
    "dome over its disc": (
        lambda u, v: (v * np.cos(u), v * np.sin(u), np.sqrt(1 - v * v)), (0, 1), 2 * math.pi
    ),
    "paraboloid by height": (
        lambda u, v: (np.sqrt(v) * np.cos(u), np.sqrt(v) * np.sin(u), v), (0, 1), 5.330414
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", NUMERIC)
def test_functions_are_differenced_in_the_bent_parameter(name):
    f, span, area = NUMERIC[name]
    asked = []

    def told(u, v):
        asked.append((v.min(), v.max()))
        return f(u, v)

    surface = sm.NumericSurface(told, u=TURN, v=span)
    assert surface.difference_error < 1e-6
    report = sm.check(sm.mesh(surface, sm.Sizing(chord=5e-3)))
    assert report.clean and report.deviation_max <= 5e-3
    assert report.area == pytest.approx(area, rel=0.02)
    assert span[0] <= np.min(asked) and np.max(asked) <= span[1]


def test_a_pole_where_the_surface_stands_still():
    """Both derivatives are 0 at v = 0 and v = pi, where two cones end."""
    x, y = "1.391*sin(v)**2*cos(u)", "1.391*sin(v)**2*sin(u)"
    surface = sm.ParametricSurface(x, y, "0.566*cos(v)", u=(0, "2*pi"), v=(0, "pi"))
    mesh = sm.mesh(surface, chord=0.079, growth=1.3)
    assert np.isfinite(mesh.points).all()
    assert mesh.report.clean and mesh.report.euler == 2
