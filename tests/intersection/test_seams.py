"""Seams of closed surfaces lie where no other surface runs into them."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh.intersection.seams import with_clear_seams

TURN = (0, "2*pi")
THIN = {"u": TURN, "v": (-3, 3), "name": "thin"}


def tube(**named):
    return sm.ParametricSurface("cos(u)", "sin(u)", "v", u=TURN, v=(-3, 3), name="tube", **named)


def test_a_seam_that_another_surface_crosses_is_moved():
    thin = sm.ParametricSurface("v", "0.5*cos(u)", "0.5*sin(u)", **THIN)
    moved, other = with_clear_seams([tube(), thin])
    (u0, u1), v = moved.domain
    assert u1 - u0 == pytest.approx(2.0 * np.pi) and v == tube().domain[1]
    assert abs(np.sin(u0)) > 0.6  # clear of |y| < 0.5
    assert other.domain == thin.domain  # along its length it crosses the tube wherever it lies


def test_seams_that_nothing_meets_stay():
    far = sm.ParametricSurface("v", "0.5*cos(u) + 3", "0.5*sin(u)", **THIN)
    sphere = sm.load("sphere")
    assert [s.domain for s in with_clear_seams([tube(), far])] == [tube().domain, far.domain]
    (same,) = with_clear_seams([sphere])
    assert same is sphere


def test_surfaces_that_do_not_go_on_alike_keep_their_domain():
    # closed, but with another derivative beyond the seam
    drop = sm.ParametricSurface(
        "u*(1 - u)*(1 + u)", "u*(1 - u)", "v", u=(0, 1), v=(-1, 1), name="drop"
    )
    plane = sm.ParametricSurface("u", "v", "0", u=(-1, 1), v=(-1, 1), name="plane")
    moved, _ = with_clear_seams([drop, plane])
    assert moved.domain == drop.domain


def test_the_wing_leaves_no_sliver_at_the_seam_of_the_fuselage():
    model = sm.load("wing_and_fuselage")
    mesh = sm.mesh(model, sm.Sizing(chord=2e-3 * model.diagonal, max_size=0.06 * model.diagonal))
    report = sm.check(mesh)
    assert report.clean and report.alpha_min > 0.4  # 0.24 with the seam along the wing's root
