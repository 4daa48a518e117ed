"""Edges, fans and repeated triangles of a mesh: the core against numpy."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfmesh._core import quality
from surfmesh._core.optimisation import dihedral_angles
from surfmesh.geometry.components import components
from surfmesh.result.connectivity import connect

seeds = st.integers(0, 2**31)


def soup(seed, count=40, vertices=14):
    """Triangles at random on few vertices: crowded edges, clashes, repeats; and their table."""
    rng = np.random.default_rng(seed)
    triangles = np.argsort(rng.random((count, vertices)), axis=1)[:, :3].astype(np.int32)
    points = rng.normal(size=(vertices, 3))
    return rng, points, triangles, connect(triangles)


@given(seeds)
def test_fans_join_corners_across_edges_of_two(seed):
    _, points, triangles, table = soup(seed)
    corners = triangles.ravel()
    here, there = table.half_edges[table.uses == 2].T
    after = np.where(np.arange(len(corners)) % 3 == 2, -2, 1) + np.arange(len(corners))
    same = corners[here] == corners[there]
    links = np.concatenate([
        np.stack([here, np.where(same, there, after[there])], axis=1),
        np.stack([after[here], np.where(same, after[there], there)], axis=1),
    ])  # fmt: skip
    labels = components(len(corners), links)
    heads = corners[labels == np.arange(len(corners))]
    found = quality.triangle_fans(triangles, len(points), table.half_edges[table.uses == 2])
    assert (found == np.bincount(heads, minlength=len(points))).all()
    clashing = quality.clashing_edges(triangles, table.half_edges, table.uses)
    assert clashing.tolist() == np.flatnonzero(table.uses == 2)[same].tolist()


@given(seeds)
def test_repeated_triangles_are_seen_whatever_their_order(seed):
    _, points, triangles, _ = soup(seed, 12, 20)
    several = len(np.unique(np.sort(triangles, axis=1), axis=0)) < len(triangles)
    assert quality.has_repeated_triangles(triangles, len(points)) is several
    again = np.concatenate([triangles, triangles[5:6, [2, 0, 1]]])
    assert quality.has_repeated_triangles(again, len(points))


@settings(max_examples=20)
@given(seeds)
def test_lengths_angles_and_faces_are_those_of_numpy(seed):
    rng, points, triangles, table = soup(seed)
    a, b = points[table.edges].transpose(1, 0, 2)
    lengths = quality.edge_lengths(points, table.edges)
    assert np.allclose(lengths, np.linalg.norm(b - a, axis=1), rtol=1e-15)
    faces = rng.integers(0, 3, len(triangles)).astype(np.int32)
    first, second = faces[table.half_edges // 3].T
    within = np.flatnonzero((table.uses == 2) & (first == second))
    edges, own, degrees = quality.angles_within_faces(
        points, triangles, faces, table.half_edges, table.uses
    )
    assert edges.tolist() == within.tolist() and own.tolist() == first[within].tolist()
    wanted = np.degrees(dihedral_angles(points, triangles, table.half_edges[within]))
    assert degrees.tolist() == wanted.tolist()


def rim_losses(points, triangles, sides, sagitta, far):
    """Of rims, rows of ``sides``, each with a sagitta; (k,) and of the faces, one a triangle."""
    faces = np.arange(len(triangles), dtype=np.int32)
    uses = 1 + (sides[:, 1] >= 0).astype(np.int32)
    rows = np.arange(len(sides))
    return quality.rim_losses(
        points, triangles, faces, sides, uses, rows, sagitta, far, 0.1, len(faces)
    )


def test_rims_lose_their_length_times_the_farther_of_sagitta_and_slanted_distance():
    points = np.array([(0, 0, 0), (2, 0, 0), (1, 1, 0), (1, 0, 1)], float)
    triangles = np.array([(0, 1, 2), (1, 0, 3)], np.int32)  # at a right angle
    sides = np.array([(0, 3), (1, -1), (0, 3), (2, -1)], np.int32)
    sagitta, far = np.array([0.1, 0.2, 0.0, 9.0]), np.array([0.01, 0.05])
    root = 2.0**0.5
    lost, of_faces = rim_losses(points, triangles, sides, sagitta, far)
    assert lost == pytest.approx([0.2, 0.2 * root, 0.1, 2.0])  # never more than its length squared
    assert of_faces == pytest.approx([lost.sum(), 0.3])
    flat = np.array([(0, 0, 0), (2, 0, 0), (1, 1, 0), (1, -1, 0)], float)
    (lost,), _ = rim_losses(flat, triangles, sides[2:3], sagitta[2:3], far)
    assert lost == pytest.approx(2.0 * 0.05 / 0.1)


@given(seeds)
def test_rims_are_free_edges_and_those_with_a_sagitta(seed):
    rng, points, triangles, table = soup(seed, 12)
    faces = rng.integers(0, 3, len(triangles)).astype(np.int32)
    rows = rng.integers(-1, len(table.edges), 10)
    sagitta, far = rng.random(10), rng.random(len(triangles))
    given = points, triangles, faces, table.half_edges, table.uses
    lost, of_faces = quality.rim_losses(*given, rows, sagitta, far, 0.1, 3)
    rim = table.uses == 1
    rim[rows[rows >= 0]] = True
    assert (lost[~rim] == 0.0).all() and (lost[rim] > 0.0).all()
    sides = table.half_edges[table.uses <= 2]
    both = np.repeat(lost[table.uses <= 2], 2)[sides.ravel() >= 0]
    beside = faces[sides.ravel()[sides.ravel() >= 0] // 3]
    assert of_faces == pytest.approx(np.bincount(beside, both, 3))
    with pytest.raises(ValueError, match="edge"):
        quality.rim_losses(*given, rows + len(table.edges), sagitta, far, 0.1, 3)


def test_sagittas_are_of_arcs_cut_in_segments_of_one_edge():
    angle = np.linspace(0.0, 1.2, 5)
    points = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    segments = np.stack([np.arange(4), np.arange(1, 5)], axis=1).astype(np.int32)
    found = quality.edge_sagittas(points, segments, np.zeros(4, np.int32))
    assert found == pytest.approx(np.full(4, 2.0 * (1.0 - np.cos(0.15))), rel=0.01)
    assert quality.edge_sagittas(points, segments, np.arange(4, dtype=np.int32)).max() == 0.0
    assert quality.edge_sagittas(points, segments[::2], np.zeros(2, np.int32)).max() == 0.0


@given(seeds)
def test_changes_of_sizes_are_quotients_that_are_finite(seed):
    rng = np.random.default_rng(seed)
    apart = rng.integers(0, 4, 30).astype(float)
    lengths = rng.choice([0.0, 1.0, 2.0, np.inf, np.nan], 30, p=[0.2, 0.3, 0.3, 0.1, 0.1])
    with np.errstate(divide="ignore", invalid="ignore"):
        over = np.nan_to_num(apart / (0.5 * lengths), nan=0.0, posinf=0.0)
    steepest, largest, above = quality.size_changes(apart, lengths, 0.5, 2.5)
    assert (steepest, largest, above) == (over.argmax(), over.max(), (over > 2.5).sum())
    assert quality.size_changes(apart, np.zeros(30), 0.5, 2.5)[0] == -1


@given(seeds)
def test_proper_triangles_have_three_corners_each_its_own_and_leave_none_out(seed):
    rng, _, triangles, _ = soup(seed, 12)
    _, triangles = np.unique(triangles, return_inverse=True)
    triangles = triangles.reshape(-1, 3).astype(np.int32)
    count = int(triangles.max()) + 1
    repeated = len(np.unique(np.sort(triangles, axis=1), axis=0)) < len(triangles)
    assert quality.are_proper(triangles, count) is not repeated
    assert not quality.are_proper(triangles, count + 1)  # a vertex of no triangle
    assert not quality.are_proper(triangles, count - 1)  # a number out of range
    for wrong in (-1, count, triangles[3, 1]):  # the last: a corner twice
        odd = triangles.copy()
        odd[3, 0] = wrong
        assert not quality.are_proper(odd, count)
    twice = np.concatenate([triangles, triangles[rng.integers(12, size=1)][:, [2, 0, 1]]])
    assert not quality.are_proper(twice, count)


def test_what_is_out_of_range_is_refused():
    _, points, triangles, table = soup(1)
    wrong = np.array([[0, 3 * len(triangles)]], np.int32)
    for call in (
        lambda: quality.triangle_fans(triangles, len(points), wrong),
        lambda: quality.triangle_fans(triangles, 3, table.half_edges),
        lambda: quality.edge_lengths(points[:2], table.edges),
        lambda: quality.has_repeated_triangles(triangles, 2),
        lambda: quality.clashing_edges(triangles, table.half_edges, table.uses[1:]),
    ):
        with pytest.raises(ValueError):
            call()


@given(seeds)
def test_sizes_at_the_ends_of_edges(seed):
    rng, points, _, table = soup(seed)
    sizes = rng.random(len(points))
    mean, apart = quality.edge_sizes(table.edges, sizes)
    first, second = sizes[table.edges].T
    np.testing.assert_array_equal(mean, 0.5 * (first + second))
    np.testing.assert_array_equal(apart, np.abs(first - second))
    with pytest.raises(ValueError, match="edges"):
        quality.edge_sizes(table.edges, sizes[:-3])
