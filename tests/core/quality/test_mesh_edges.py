"""Soundness, edges, fans and repeated triangles of a mesh: the core against numpy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surfmesh._core import quality
from surfmesh.geometry.components import components
from surfmesh.result.connectivity import connect

seeds = st.integers(0, 2**31)
NO_CHAINS = np.empty((0, 2), np.int32)


def soup(seed, count=40, vertices=14):
    """Triangles at random on few vertices: crowded edges, clashes, repeats; and their table."""
    rng = np.random.default_rng(seed)
    triangles = np.argsort(rng.random((count, vertices)), axis=1)[:, :3].astype(np.int32)
    points = rng.normal(size=(vertices, 3))
    return rng, points, triangles, connect(triangles)


def joined(points, triangles, table):
    """On one face."""
    return quality.JoinedTriangles(points, triangles, np.zeros(len(triangles), np.int32), 1, *table)


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
    _, _, _, found, *_, clashing = joined(points, triangles, table).topology(NO_CHAINS)
    assert (found == np.bincount(heads, minlength=len(points))).all()
    assert clashing.tolist() == np.flatnonzero(table.uses == 2)[same].tolist()


@given(seeds)
def test_repeated_triangles_are_seen_whatever_their_order(seed):
    _, points, triangles, _ = soup(seed, 12, 20)
    several = len(np.unique(np.sort(triangles, axis=1), axis=0)) < len(triangles)
    assert quality.has_repeated_triangles(triangles, len(points)) is several
    again = np.concatenate([triangles, triangles[5:6, [2, 0, 1]]])
    assert quality.has_repeated_triangles(again, len(points))


def rim_losses(points, triangles, sides, sagitta, far):
    """Of rims, rows of ``sides``, each with a sagitta; (k,) and of the faces, one a triangle."""
    faces = np.arange(len(triangles), dtype=np.int32)
    uses = 1 + (sides[:, 1] >= 0).astype(np.int32)
    rows, corners = np.arange(len(sides)), triangles.ravel()
    ends = np.stack([corners[sides[:, 0]]] * 2, axis=1)  # nobody asks for them
    mesh = quality.JoinedTriangles(points, triangles, faces, len(faces), ends, sides, uses)
    return mesh.rim_losses(rows, sagitta, far, 0.1)


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
    mesh = quality.JoinedTriangles(points, triangles, faces, 3, *table)
    lost, of_faces = mesh.rim_losses(rows, sagitta, far, 0.1)
    rim = table.uses == 1
    rim[rows[rows >= 0]] = True
    assert (lost[~rim] == 0.0).all() and (lost[rim] > 0.0).all()
    sides = table.half_edges[table.uses <= 2]
    both = np.repeat(lost[table.uses <= 2], 2)[sides.ravel() >= 0]
    beside = faces[sides.ravel()[sides.ravel() >= 0] // 3]
    assert of_faces == pytest.approx(np.bincount(beside, both, 3))
    with pytest.raises(ValueError, match="edge"):
        mesh.rim_losses(rows + len(table.edges), sagitta, far, 0.1)


def test_sagittas_are_of_arcs_cut_in_segments_of_one_edge():
    angle = np.linspace(0.0, 1.2, 5)
    points = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    segments = np.stack([np.arange(4), np.arange(1, 5)], axis=1).astype(np.int32)
    found = quality.edge_sagittas(points, segments, np.zeros(4, np.int32))
    assert found == pytest.approx(np.full(4, 2.0 * (1.0 - np.cos(0.15))), rel=0.01)
    assert quality.edge_sagittas(points, segments, np.arange(4, dtype=np.int32)).max() == 0.0
    assert quality.edge_sagittas(points, segments[::2], np.zeros(2, np.int32)).max() == 0.0


def is_sound(triangles, count, **changes):
    """A mesh of so many vertices, with other arrays that are all right but for the changes."""
    held = {
        "points": np.ones((count, 3)), "sizes": np.ones(count), "mid_points": np.ones((2, 3)),
        "uv": np.ones((count, 2)), "uv_triangles": np.clip(triangles, 0, count - 1),
        "faces": np.zeros(len(triangles), np.int32), "surfaces": 1,
    } | changes  # fmt: skip
    return quality.is_sound(triangles=triangles, **held)


@given(seeds)
def test_proper_triangles_have_three_corners_each_its_own_and_leave_none_out(seed):
    rng, _, triangles, _ = soup(seed, 12)
    _, triangles = np.unique(triangles, return_inverse=True)
    triangles = triangles.reshape(-1, 3).astype(np.int32)
    count = int(triangles.max()) + 1
    repeated = len(np.unique(np.sort(triangles, axis=1), axis=0)) < len(triangles)
    assert is_sound(triangles, count) is not repeated
    assert not is_sound(triangles, count + 1)  # a vertex of no triangle
    assert not is_sound(triangles, count - 1)  # a number out of range
    for wrong in (-1, count, triangles[3, 1]):  # the last: a corner twice
        odd = triangles.copy()
        odd[3, 0] = wrong
        assert not is_sound(odd, count)
    twice = np.concatenate([triangles, triangles[rng.integers(12, size=1)][:, [2, 0, 1]]])
    assert not is_sound(twice, count)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("name, width", [("points", 3), ("sizes", 0), ("mid_points", 3), ("uv", 2)])
def test_a_sound_mesh_is_finite(name, width, bad):
    triangles = np.array([(0, 1, 2), (0, 2, 3)], np.int32)
    assert is_sound(triangles, 4)
    array = np.full((4, width) if width else 4, 1e308)
    assert is_sound(triangles, 4, **{name: array})
    array.flat[-1] = bad
    assert not is_sound(triangles, 4, **{name: array})


def test_a_sound_mesh_has_faces_parameters_and_sizes_that_there_are():
    triangles = np.array([(0, 1, 2), (0, 2, 3)], np.int32)
    nothing = dict.fromkeys(("sizes", "mid_points", "uv", "uv_triangles", "surfaces"))
    assert is_sound(triangles, 4, **nothing)
    beyond = np.array([0, 1], np.int32)
    assert is_sound(triangles, 4, faces=beyond, surfaces=None)
    assert not is_sound(triangles, 4, faces=beyond) and not is_sound(triangles, 4, faces=-beyond)
    assert not is_sound(triangles, 4, uv_triangles=triangles + 1)
    assert not is_sound(triangles, 4, uv_triangles=triangles - 1)
    assert not is_sound(triangles, 4, sizes=np.array([1.0, 1.0, 0.0, 1.0]))


def test_what_is_out_of_range_is_refused():
    _, points, triangles, table = soup(1)
    for call in (
        lambda: joined(points[:2], triangles, table),
        lambda: quality.has_repeated_triangles(triangles, 2),
    ):
        with pytest.raises(ValueError):
            call()
