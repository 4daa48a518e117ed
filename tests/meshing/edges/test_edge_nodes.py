"""Edges of CAD models: what they ask for, and how they are cut."""

from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh._core.edges import MateRuns
from surfmesh._core.space import edge_gaps
from surfmesh.meshing.edges.edge_nodes import cut_edges, graded_with_mates
from surfmesh.meshing.edges.edge_sampling import sample_edges
from surfmesh.sizing.options.model_sizing import model_sizing
from surfmesh.sizing.rules.size_limits import SizeLimits


def naive_gaps(points, size, first, ends, edges, first_of_face):
    """The smallest distance to any segment of any other edge of a face, all pairs tried."""
    gap = np.full(len(points), np.inf)
    for face in range(len(first_of_face) - 1):
        own = edges[first_of_face[face] : first_of_face[face + 1]]
        for a in own:
            for b in own:
                if a == b or set(ends[a]) & set(ends[b]):
                    continue
                for p in range(first[a], first[a + 1]):
                    for q in range(first[b], first[b + 1] - 1):
                        along = points[q + 1] - points[q]
                        square = along @ along
                        t = np.clip((points[p] - points[q]) @ along / square, 0, 1) if square else 0
                        d = np.linalg.norm(points[p] - points[q] - t * along)
                        if d < size[p]:
                            gap[p] = min(gap[p], d)
    return gap


@given(seed=st.integers(0, 1000))
def test_gaps_are_those_of_all_pairs(seed):
    draw = np.random.default_rng(seed)
    first = np.cumsum([0, *draw.integers(2, 6, size=5)])
    points = draw.normal(size=(first[-1], 3))
    size = draw.uniform(0.1, 3.0, size=first[-1])
    ends = draw.integers(0, 6, size=(5, 2))
    edges = np.array([0, 1, 2, 4, 3, 1, 2])
    first_of_face = np.array([0, 4, 4, 7])
    gap, boxes = edge_gaps(points, size, first, ends, edges, first_of_face)
    expected = naive_gaps(points, size, first, ends, edges, first_of_face)
    assert np.allclose(gap, expected, rtol=1e-12, equal_nan=True)
    own = [points[first[e] : first[e + 1]] for e in range(5)]
    assert np.array_equal(boxes, [[*p.min(axis=0), *p.max(axis=0)] for p in own])


def test_gaps_in_a_face_of_many_edges_are_those_of_all_pairs():
    """Most of them short, some as long as the face, some of many samples, beside each other."""
    draw = np.random.default_rng(4)
    counts = draw.choice([2, 3, 12], size=60, p=[0.6, 0.3, 0.1])
    first = np.cumsum([0, *counts])
    parts = [
        draw.uniform(0.0, (1.0, 5.0, 20.0))
        + draw.normal(scale=3.0 if k % 9 == 0 else 0.1, size=(n, 3))
        for k, n in enumerate(counts)
    ]
    points = np.concatenate(parts)
    size = draw.uniform(0.1, 2.0, size=first[-1])
    ends = np.stack([2 * np.arange(60), 2 * np.arange(60) + 1], axis=1)
    edges, first_of_face = draw.permutation(60), np.array([0, 60])
    gap, _ = edge_gaps(points, size, first, ends, edges, first_of_face)
    expected = naive_gaps(points, size, first, ends, edges, first_of_face)
    assert np.isfinite(expected).any() and np.isinf(expected).any()
    assert np.allclose(gap, expected, rtol=1e-12, equal_nan=True)


@pytest.fixture(scope="module")
def plate():
    """A slot 0.2 from the long side of a plate."""
    model = sm.from_cadquery(
        cq.Workplane().box(40, 20, 4).workplane().center(0, 6.3).slot2D(20, 7).cutThruAll()
    )
    sizing = model_sizing(model, sm.Sizing(size=2.0))
    return model, sizing.base, sample_edges(model, sizing)


def test_edges_beside_a_gap_are_cut_finer(plate):
    model, sizing, samples = plate
    nodes = cut_edges(model, sizing, samples, {})
    finest = min(cut.sizes.min() for cut in nodes)
    assert 0.19 < finest < 0.21
    assert max(cut.sizes.max() for cut in nodes) > 1.5


def test_sizes_grow_no_faster_than_asked(plate):
    model, sizing, samples = plate
    for cut in cut_edges(model, sizing, samples, {}):
        step = np.linalg.norm(np.diff(cut.points, axis=0), axis=1)
        # interpolated between samples: a little more at kinks
        assert (np.abs(np.diff(cut.sizes)) <= 1.1 * sizing.gradient * step + 1e-12).all()


def test_edges_out_of_reach_of_a_limit_keep_their_nodes(plate):
    model, sizing, samples = plate
    before = cut_edges(model, sizing, samples, {})
    corner = model.vertices[0].point
    faces = [k for k, face in enumerate(model.faces) if any(
        0 in (model.edges[c.edge].start, model.edges[c.edge].end) for c in face.coedges
    )]  # fmt: skip
    limit = SizeLimits(corner[None], np.array([0.5]), sizing.gradient)
    after = cut_edges(model, sizing, samples, dict.fromkeys(faces, limit), before)
    changed = np.flatnonzero(after.made != before.made).tolist()
    assert 0 < len(changed) < len(after) and set(after.made.tolist()) == {0, 1}
    for k in set(range(len(after))) - set(changed):
        assert all(np.array_equal(now, then) for now, then in zip(after[k], before[k]))
    numbers = np.concatenate([cut.numbers[1:-1] for cut in after])
    assert len(np.unique(numbers)) == len(numbers)
    near = [k for k, e in enumerate(model.edges) if 0 in (e.start, e.end)]
    assert set(near) <= set(changed)
    for cuts in (before, after):  # edge after edge in rows
        assert cuts.first.tolist() == np.cumsum([0, *(len(cut.t) for cut in cuts)]).tolist()
        for place, row in enumerate(cuts.rows):
            assert np.array_equal(row, np.concatenate([cut[place] for cut in cuts]))


def test_an_edge_that_is_one_vertex_has_no_rows():
    model = sm.from_cadquery(cq.Workplane().sphere(1))
    sizing = model_sizing(model, sm.Sizing(size=0.5))
    cuts = cut_edges(model, sizing.base, sample_edges(model, sizing), {})
    empty = [cut is None for cut in cuts]
    assert any(empty) and not all(empty)
    assert np.array_equal(np.diff(cuts.first) == 0, empty)


def test_an_estimate_looks_at_fewer_places_of_circles_and_lines():
    model = sm.from_cadquery(cq.Workplane().box(4, 4, 1).faces(">Z").hole(1))
    sizing = model_sizing(model, sm.Sizing(size=0.3))
    every, few = (sample_edges(model, sizing, few) for few in (False, True))
    kinds = np.array([edge.curve.kind for edge in model.edges])
    assert set(np.diff(every.first)[kinds == "circle"]) == {129}
    assert set(np.diff(every.first)[kinds == "line"]) == {33}
    assert set(np.diff(few.first)[kinds == "circle"]) == {33}
    assert set(np.diff(few.first)[kinds == "line"]) == {17}
    nodes = [cut_edges(model, sizing.base, samples, {}) for samples in (every, few)]
    assert [len(cut.t) for cut in nodes[0]] == [len(cut.t) for cut in nodes[1]]


def test_sizes_lowered_to_those_of_a_mate_grow_from_there():
    """They jumped where the mate ended: the mate had been graded, what was lowered to it not."""
    model = sm.from_cadquery(cq.Workplane().box(40, 30, 20).val())
    wanted = model_sizing(model, sm.Sizing(size=10.0))
    samples = sample_edges(model, wanted)
    ends = [{edge.start, edge.end} for edge in model.edges]
    mate = next(k for k in range(1, 12) if not ends[k] & ends[0])
    half = samples.t[samples.of(0)][:17]
    one = np.zeros(1, np.int64)
    runs = MateRuns(one, one + mate, np.array([0, 17]), half, half, np.full(17, 0.1))
    samples = replace(samples, mates=runs)
    samples.target_size[samples.of(mate)] = 0.5
    sizes, graded, _ = graded_with_mates(model, samples, samples.target_size, wanted.base)
    own = samples.of(0)
    step = np.linalg.norm(np.diff(samples.points[own], axis=0), axis=1)
    assert np.allclose(sizes[own][samples.t[own] <= 0.5], 0.5)
    assert (np.abs(np.diff(sizes[own])) <= 1.001 * wanted.base.gradient * step).all()
    assert np.allclose(sizes, graded)
