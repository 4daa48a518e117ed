"""Narrow faces, edges that run side by side, and the nodes that face each other on these."""

import cadquery as cq
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh._core.edges import MateRuns, graded_over_faces, lowered_to_mates, mate_runs
from surfmesh.cad.model.model_arrays import model_arrays
from surfmesh.meshing.edges.edge_nodes import cut_edges
from surfmesh.meshing.edges.edge_sampling import sample_edges
from surfmesh.sizing.options.model_sizing import model_sizing

CHORD = 0.1
ONE = np.zeros(1, np.int64)


def sampled(shape, chord=CHORD):
    model = sm.from_cadquery(shape)
    wanted = model_sizing(model, sm.Sizing(chord=chord))
    return model, wanted, sample_edges(model, wanted)


def lens(height: float, width: float) -> cq.Workplane:
    """The prism of a lens between two arcs over a chord of 10; its two tips are acute."""
    return (
        cq.Workplane()
        .moveTo(-5, 0)
        .threePointArc((0, height + width), (5, 0))
        .threePointArc((0, height), (-5, 0))
        .close()
        .extrude(3)
    )


@settings(max_examples=12, deadline=None)
@given(width=st.floats(0.01, 0.3), length=st.floats(1.0, 30.0))
def test_a_strip_is_narrow_up_to_the_chord(width, length):
    _, _, samples = sampled(cq.Workplane().box(length, 5.0, width))
    is_narrow = width <= CHORD
    assert len(samples.narrow) == (4 if is_narrow else 0)
    for face in samples.narrow.values():
        assert face.width == pytest.approx(width, rel=1e-9)
        assert not face.closed and all(len(side) == 1 for side in face.sides)


@settings(max_examples=12, deadline=None)
@given(width=st.floats(0.01, 0.2), off=st.floats(0.0, 0.9))
def test_a_ring_is_narrow_where_its_widest_place_is(width, off):
    """Circles that are off each other's centres: the ring is wider on one side."""
    tube = cq.Workplane().circle(5.0).extrude(4.0)
    tube = tube.cut(cq.Workplane().center(off * width, 0.0).circle(5.0 - width).extrude(4.0))
    _, _, samples = sampled(tube)
    widest = width * (1.0 + off)
    if abs(widest / CHORD - 1.0) < 1e-3:
        return
    assert len(samples.narrow) == (2 if widest <= CHORD else 0)
    for face in samples.narrow.values():
        assert face.closed
        assert face.width == pytest.approx(widest, rel=2e-3)  # as far as the samples see it


@settings(max_examples=12, deadline=None)
@given(height=st.floats(0.5, 2.0), width=st.floats(0.01, 0.4))
def test_feet_are_the_closest_points_of_a_mate(height, width):
    model, _, samples = sampled(lens(height, width))
    assert len(samples.mates)
    runs = samples.mates
    for edge, mate, first, end in zip(runs.edge, runs.mate, runs.first[:-1], runs.first[1:]):
        t, foot, gap = runs.t[first:end], runs.foot[first:end], runs.gap[first:end]
        assert (np.diff(t) > 0.0).all() and (gap <= CHORD).all()
        (points,) = model.edges[edge].evaluate(t)
        (feet,) = model.edges[mate].evaluate(foot)
        assert np.allclose(np.linalg.norm(points - feet, axis=1), gap, atol=1e-12)
        (dense,) = model.edges[mate].evaluate(np.linspace(0.0, 1.0, 2001))
        least = np.linalg.norm(points[:, None] - dense, axis=2).min(axis=1)
        assert (gap <= least + 1e-9).all()


@settings(max_examples=12, deadline=None)
@given(height=st.floats(0.5, 2.0), width=st.floats(0.01, 0.09))
def test_nodes_of_mates_face_each_other(height, width):
    """Each node inside a run lies as near to a node of the mate as that is to the curve."""
    model, wanted, samples = sampled(lens(height, width))
    nodes = cut_edges(model, wanted.base, samples, {})
    runs = samples.mates
    for edge, mate, first, end in zip(runs.edge, runs.mate, runs.first[:-1], runs.first[1:]):
        own, other = nodes[edge], nodes[mate]
        inside = (own.t > runs.t[first]) & (own.t < runs.t[end - 1])
        gap = np.interp(own.t[inside], runs.t[first:end], runs.gap[first:end])
        away = np.linalg.norm(own.points[inside, None] - other.points, axis=2).min(axis=1)
        assert (away <= gap + 0.31 * own.sizes[inside]).all()


def test_sizes_are_those_of_the_mate_where_they_are_larger():
    t = np.linspace(0.0, 1.0, 5)
    samples = np.r_[t, t], np.array([0, 5, 10])
    runs = MateRuns(ONE, ONE + 1, np.array([0, 3]), t[:3], t[2:], np.full(3, 0.1))
    sizes = np.r_[np.full(5, 2.0), 1.0, 1.0, 1.0, 1.5, 3.0]
    found = lowered_to_mates(runs, *samples, sizes)
    assert found[:5].tolist() == [1.0, 1.5, 2.0, 2.0, 2.0]
    assert found[5:].tolist() == sizes[5:].tolist()


def test_what_is_out_of_range_is_refused():
    model, _, samples = sampled(cq.Workplane().box(1, 1, 1))
    arrays = model_arrays(model)
    t = np.linspace(0.0, 1.0, 3)
    runs = MateRuns(ONE, ONE + 99, np.array([0, 3]), t, t, t)
    with pytest.raises(ValueError, match="runs"):
        lowered_to_mates(runs, samples.t, samples.first, samples.target_size)
    with pytest.raises(ValueError, match="no samples"):
        MateRuns(ONE, ONE, np.array([0, 0]), t[:0], t[:0], t[:0])
    with pytest.raises(ValueError, match="edges"):
        mate_runs(
            arrays.curves, samples.points, samples.t, samples.first, ONE + 99,
            np.zeros(1, np.uint8), np.array([0, 1]), ONE, ONE, np.ones(1), 1,
        )  # fmt: skip


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 10_000), lowered=st.floats(0.02, 0.5))
def test_sizes_graded_anew_are_those_graded_at_once(seed, lowered):
    model, wanted, samples = sampled(cq.Workplane().box(4, 3, 2).edges("|Z").fillet(0.4), 0.01)
    arrays, random = model_arrays(model), np.random.default_rng(seed)

    def graded(sizes, before=None):
        return graded_over_faces(
            samples.points, sizes, samples.first, arrays.mesh_ends, len(arrays.corners),
            *samples.edges_of_wide_faces, wanted.base.gradient, 1e-12, before,
        )  # fmt: skip

    first = graded(samples.target_size)
    smaller = samples.target_size.copy()
    smaller[random.integers(0, len(smaller), 3)] *= lowered
    at_once, anew = graded(smaller), graded(smaller, first)
    assert np.allclose(anew, at_once, rtol=3e-3)
    assert (anew <= smaller * (1.0 + 1e-12)).all()
    assert np.allclose(graded(first, first), first, rtol=1e-12)
