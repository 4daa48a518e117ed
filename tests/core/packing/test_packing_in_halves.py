"""A large box is packed in two halves from a line of circles; joined they are one triangulation."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive.background import constant_background, random_background
from naive.metric import alpha
from naive.triangulation import check_triangulation, corners

from surfmesh._core import allow_threads
from surfmesh._core.packing import Packing, PackingStatus, pack_box
from surfmesh._core.triangulation import DONE, TODO
from surfmesh.api import mesh as mesh_of
from surfmesh.geometry.planar.planar_domain import PlanarDomain
from surfmesh.quality.measures.shape import shapes as alphas
from surfmesh.sizing.options.sizing import Sizing

UNIT = (0.0, 0.0, 1.0, 1.0)
LARGE = 50_000  # expected: what decides whether there are halves


def outside(packing: Packing) -> np.ndarray:
    """The real triangles that are not done, (k, 3, 2)."""
    t = packing.t
    real = (t.region == TODO) & (t.tri.reshape(-1, 3) >= 0).all(axis=1)
    return t.xy[t.tri.reshape(-1, 3)[real]]


@settings(max_examples=10)
@given(
    seed=st.integers(0, 2**31),
    cells=st.integers(1, 6),
    ratio=st.sampled_from([1.0, 10.0, 100.0]),
    stretch=st.sampled_from([1.0, 30.0]),
)
def test_any_field(seed, cells, ratio, stretch):
    field = random_background(seed, cells, ratio, stretch, size=0.05)
    packing = pack_box(field, UNIT, LARGE)
    assert packing.status == PackingStatus.FINISHED
    assert packing.halves == 2
    assert check_triangulation(packing.t) is None
    for at in np.random.default_rng(seed).random((20, 2)):  # the box is done everywhere
        a, b, c = np.moveaxis(outside(packing) - at, 1, 0)
        turns = [u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] for u, v in ((a, b), (b, c), (c, a))]
        assert not (np.min(turns, axis=0) > 0.0).any()


@pytest.mark.parametrize("box", [UNIT, (0.0, 0.0, 1.0, 0.1), (0.0, 0.0, 0.1, 1.0)])
def test_equal_circles_stay_a_lattice_across_the_line(box):
    width, height = box[2], box[3]
    packing = pack_box(constant_background(0.01, width, height), box, LARGE)
    assert packing.halves == 2
    done = corners(packing.t)[packing.t.region == DONE]
    centre = packing.t.xy[done].mean(axis=1)
    within = ((centre > 0.02) & (centre < np.array([width, height]) - 0.02)).all(axis=1)
    shapes = np.array([alpha(*packing.t.xy[triangle]) for triangle in done[within]])
    assert shapes.min() > 0.999


def test_any_number_of_threads_packs_the_same_circles():
    field, made = random_background(5, 4, 20.0, 3.0, size=0.01), []
    for count in (1, 2, 5):
        before = allow_threads(count)
        try:
            made.append(pack_box(field, UNIT, LARGE))
        finally:
            allow_threads(before)
    for other in made[1:]:
        assert np.array_equal(made[0].t.xy, other.t.xy)
        assert np.array_equal(made[0].t.tri, other.t.tri)


def test_a_small_box_is_packed_from_its_middle():
    packing = pack_box(constant_background(0.02, 1.0, 1.0), UNIT, 3000)
    assert packing.status == PackingStatus.FINISHED and packing.halves == 0
    assert check_triangulation(packing.t) is None


def test_the_watch_sees_all_circles_and_stops_both_halves():
    class Stop(Exception):
        pass

    told: list[int] = []

    def watch(circles):
        told.append(circles)
        if circles > 20_000:
            raise Stop

    before = allow_threads(2)
    try:
        with pytest.raises(Stop):
            pack_box(constant_background(0.003, 1.0, 1.0), UNIT, 130_000, watch)
    finally:
        allow_threads(before)
    assert told[-1] < 60_000


def test_halves_of_a_graded_square_are_as_good_as_the_whole():
    """Rows along the line fit too well: circles too many added up to a mean alpha of 0.988."""
    square = PlanarDomain([[0, 0], [1, 0], [1, 1], [0, 1]])

    def sizes(p):
        return 0.0017 * (1.0 + 4.0 * np.hypot(*(p - 0.5).T) / np.sqrt(0.5))

    mesh = mesh_of(square, Sizing(size=sizes, growth=1.1))
    assert len(mesh.triangles) > 2 * LARGE
    assert alphas(mesh).alpha.mean() > 0.993
