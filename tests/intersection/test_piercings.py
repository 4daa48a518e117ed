"""Where an edge meets a surface: places in closed form, touches, edges that lie on it."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh.cad.model.cad_model import CadEdge
from surfmesh.geometry.cad_surfaces.curves import Line
from surfmesh.intersection.cells import FaceCells
from surfmesh.intersection.piercings import crossings
from surfmesh.intersection.sheets import as_model

BALL = sm.ParametricSurface(
    "cos(u)*cos(v)", "sin(u)*cos(v)", "sin(v)", u=(0, "2*pi"), v=("-pi/2", "pi/2"), name="ball"
)
SAME = 1e-8


@pytest.fixture(scope="module")
def cells():
    return FaceCells(as_model(BALL, "ball").faces[0])


def straight(start, end):
    start, end = np.array(start, float), np.array(end, float)
    length = float(np.linalg.norm(end - start))
    return CadEdge(
        curve=Line(start, (end - start) / length), t0=0.0, t1=length, start=0, end=1,
        tolerance=0.0, degenerate=False, name="", length=length,
    )  # fmt: skip


def test_a_line_goes_in_and_out(cells):
    found = crossings(straight((-2.0, 0.3, 0.1), (2.0, 0.3, 0.1)), cells, SAME)
    half = np.sqrt(1.0 - 0.3**2 - 0.1**2)
    assert found.fraction == pytest.approx([0.5 - half / 4.0, 0.5 + half / 4.0], abs=1e-12)
    assert not found.touches.any() and found.along is None
    assert np.linalg.norm(found.point, axis=1) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("off", [1e-3, 1e-6, 3e-9])
def test_two_places_near_each_other_are_told_apart(cells, off):
    found = crossings(straight((-2.0, 0.6, 0.8 - off), (2.0, 0.6, 0.8 - off)), cells, SAME)
    half = np.sqrt(1.0 - 0.6**2 - (0.8 - off) ** 2)
    assert found.fraction == pytest.approx([0.5 - half / 4.0, 0.5 + half / 4.0], abs=1e-7)


def test_a_line_that_passes_by_meets_nothing(cells):
    found = crossings(straight((-2.0, 0.6, 0.8 + 1e-6), (2.0, 0.6, 0.8 + 1e-6)), cells, SAME)
    assert not len(found.fraction) and found.along is None


def test_a_touch_is_one_place(cells):
    found = crossings(straight((-2.0, 0.6, 0.8), (2.0, 0.6, 0.8)), cells, SAME)
    assert found.fraction == pytest.approx([0.5], abs=1e-7)
    assert found.touches.all() and found.along is None


def test_a_line_on_a_plane_is_said_to_lie_there():
    flat = sm.ParametricSurface("u", "v", "0", u=(-3, 3), v=(-3, 3), name="flat")
    cells = FaceCells(as_model(flat, "flat").faces[0])
    assert crossings(straight((-2.0, 0.6, 0.0), (2.0, 0.1, 0.0)), cells, SAME).along is not None


def test_an_edge_in_a_plane_through_zero_is_said_to_lie_there():
    # all its coordinates across the plane are 0, and so was the room for rounding
    wall = sm.ParametricSurface("u", "0", "v", u=(-3, 3.03), v=(-3, 3), name="wall")
    tube = sm.ParametricSurface("cos(u)", "sin(u)", "v", u=(0, "2*pi"), v=(-2, 2), name="tube")
    cells = FaceCells(as_model(wall, "wall").faces[0])
    (seam,) = (edge for edge in as_model(tube, "tube").edges if edge.start != edge.end)
    assert crossings(seam, cells, SAME).along is not None


def test_an_edge_beside_a_surface_by_less_than_what_is_the_same_lies_there():
    flat = sm.ParametricSurface("u", "v", "0", u=(-3, 3), v=(-3, 3), name="flat")
    cells = FaceCells(as_model(flat, "flat").faces[0])
    beside = straight((-2.0, 0.6, 0.3 * SAME), (2.0, 0.1, -0.3 * SAME))
    assert crossings(beside, cells, SAME).along is not None
    assert crossings(straight((-2.0, 0.6, 1e-6), (2.0, 0.1, 1e-6)), cells, SAME).along is None
