"""Poles on a short axis, of ellipsoids and of what is pulled out sideways: meshed and clean."""

import pytest

import surfmesh as sm

TURN = (0, "2*pi")


def ellipsoid(a: float, b: float, c: float) -> sm.ParametricSurface:
    return sm.ParametricSurface(
        f"{a}*cos(v)*cos(u)", f"{b}*cos(v)*sin(u)", f"{c}*sin(v)", u=TURN, v=("-pi/2", "pi/2")
    )


@pytest.mark.parametrize(
    "surface, chord",
    [
        (ellipsoid(10, 1, 1), 0.02),
        (ellipsoid(20, 1, 1), 0.04),
        (ellipsoid(1, 10, 1), 0.02),
        (ellipsoid(5, 1, 1), 0.01),
        (sm.ParametricSurface("20*v*cos(u)", "v*sin(u)", "v**2", u=TURN, v=(0, 1)), 0.04),
        (sm.ParametricSurface("10*v*cos(u)", "v*sin(u)", "v", u=TURN, v=(0, 1)), 0.02),
    ],
)
def test_they_are_meshed_and_proved_homeomorphic(surface, chord):
    """Triangles were turned over in (u, v), features could not be excluded, and 20:1:1 was refused
    ("the sides cannot be joined with sizes this coarse")."""
    report = sm.check(sm.mesh(surface, sm.Sizing(chord=chord)), prove=True)
    assert report.clean, report.problems
    assert report.proof.homeomorphic.answer is True
    assert report.unseen == 0 and report.alpha_mean > 0.92 and report.alpha_min > 0.5


def test_at_a_fine_chord_nothing_hides_and_feet_are_found():
    """8 of 24,312 triangles could hide something, and of 20:1:1 feet were taken for three times as
    far as they are."""
    mesh = sm.mesh(ellipsoid(15, 1, 1), sm.Sizing(chord=0.006))
    report = sm.check(mesh)
    assert report.clean and report.unseen == 0
    assert report.deviation_max <= 0.006


def test_stretched_triangles_about_elongated_poles():
    report = sm.check(sm.mesh(ellipsoid(10, 1, 1), sm.Sizing(chord=0.02, anisotropy=8)))
    assert report.clean, report.problems
