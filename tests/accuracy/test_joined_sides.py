"""Nearest points that lie across a joined side of (u, v) are found there."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh.accuracy.deviation import nearest_deviations

TURN = ("0", "2*pi")


def sheared_sphere(turn=2.0):
    """A sphere whose meridians turn as they go from pole to pole: u changes fast beside these."""
    return sm.ParametricSurface(
        f"sin(v)*cos(u + {turn}*v)", f"sin(v)*sin(u + {turn}*v)", "cos(v)", TURN, ("0", "pi")
    )


@settings(max_examples=12, deadline=None)
@given(turn=st.floats(-3.0, 3.0), chord=st.floats(0.02, 0.1))
def test_deviations_beside_the_poles_of_a_sheared_sphere(turn, chord):
    """Reports said up to 1.7 times the chord at poles where the mesh was within it: searches for
    the nearest point stopped at the seam."""
    mesh = sm.mesh(sheared_sphere(turn), chord=chord)
    report = mesh.report
    assert report.clean, report.problems
    weights = np.array([(i, j, 12 - i - j) for i in range(13) for j in range(13 - i)]) / 12.0
    places = np.einsum("kc,tcx->tkx", weights, mesh.points[mesh.triangles])
    largest = np.abs(np.linalg.norm(places, axis=2) - 1.0).max()
    assert report.deviation_max == pytest.approx(largest, rel=0.05)


def test_a_search_goes_on_across_the_joint_of_a_moebius_strip():
    """Its sides are one with v turned over."""
    strip = sm.load("mobius")
    (u0, u1), (v0, v1) = strip.domain
    width = u1 - u0
    true = np.array([[u0 + 0.05 * width, 0.7 * v0 + 0.3 * v1], [u1 - 0.05 * width, 0.8 * v1]])
    # the same places, guessed from the other end
    guess = np.array([[u1 - 0.02 * width, 0.3 * v0 + 0.7 * v1], [u0 + 0.02 * width, 0.8 * v0]])
    corners = np.repeat(guess[:, None], 3, axis=1)
    (points,) = strip.evaluate(true, 0)
    uv, distance = nearest_deviations(strip, points, guess, corners, np.arange(2), 1e-6, 12)
    assert distance == pytest.approx(0.0, abs=1e-9)
    assert uv == pytest.approx(true, abs=1e-6)
