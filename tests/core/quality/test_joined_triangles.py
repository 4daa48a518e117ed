"""Figures of a mesh with its edge table: the core against numpy."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from naive.edge_figures import edge_figures

from surfmesh._core import quality
from surfmesh._core.optimisation import dihedral_angles
from surfmesh.result.connectivity import connect

seeds = st.integers(0, 2**31)
FACES = 4  # of which one has no triangle


def soup(seed, count=40, vertices=14):
    """Triangles at random on few vertices: crowded edges, clashes, repeats; and their table."""
    rng = np.random.default_rng(seed)
    triangles = np.argsort(rng.random((count, vertices)), axis=1)[:, :3].astype(np.int32)
    points = rng.normal(size=(vertices, 3))
    faces = rng.integers(0, FACES - 1, count).astype(np.int32)
    return rng, points, triangles, faces, connect(triangles)


def joined(points, triangles, faces, table):
    return quality.JoinedTriangles(points, triangles, faces, FACES, *table)


@settings(max_examples=30)
@given(seeds, st.booleans(), st.sampled_from(["", "no length", "no number"]))
def test_edges_are_those_of_numpy(seed, is_stretched, spoilt):
    rng, points, triangles, faces, table = soup(seed)
    if spoilt == "no length":
        points[table.edges[0, 0]] = points[table.edges[0, 1]]
    elif spoilt == "no number":
        points[3] = np.nan
    sizes = 0.1 + rng.random(len(points))
    roots, corners = None, None
    if is_stretched:
        roots = rng.normal(size=(20, 6))
        corners = rng.integers(0, 20, triangles.shape).astype(np.int32)
    found = joined(points, triangles, faces, table).edge_figures(sizes, roots, corners, 0.4, 1.5)
    slow = edge_figures(points, triangles, table, sizes, roots, corners, 0.4)
    np.testing.assert_allclose(found.lengths, slow.lengths, rtol=1e-14)
    np.testing.assert_allclose(found.metric_lengths, slow.metric_lengths, rtol=1e-12)
    assert found.ratios == pytest.approx(slow.ratios, rel=1e-12, nan_ok=True)
    steepest, largest, above = found.changes
    assert largest == pytest.approx(slow.over.max(), rel=1e-11)
    assert slow.over[steepest] == pytest.approx(largest, rel=1e-11)
    assert above == np.count_nonzero(slow.over > 1.5)
    assert found.length == pytest.approx(quality.spread(found.lengths), nan_ok=True)
    assert found.metric_length == pytest.approx(quality.spread(found.metric_lengths), nan_ok=True)


@given(seeds)
def test_an_edge_between_two_faces_counts_for_both(seed):
    rng, points, triangles, faces, table = soup(seed)
    sizes = rng.random(len(points))
    found = joined(points, triangles, faces, table).edge_figures(sizes, None, None, 0.0, 1.1)
    assert found.changes == (-1, 0.0, 0)  # not asked
    mean = sizes[table.edges].mean(axis=1)
    beside = np.where(table.half_edges < 0, table.half_edges[:, :1], table.half_edges) // 3
    for face in range(FACES):
        own = (faces[beside] == face).any(axis=1)
        assert found.face_lengths[face] == pytest.approx(
            found.lengths[own].mean() if own.any() else 0
        )
        assert found.face_sizes[face] == pytest.approx(mean[own].mean() if own.any() else 0)


def test_without_sizes_or_lengths_there_is_nothing_to_compare():
    _, points, triangles, faces, table = soup(3)
    found = joined(points, triangles, faces, table).edge_figures(None, None, None, 0.4, 1.1)
    assert not len(found.metric_lengths) and np.isnan(found.metric_length).all()
    assert found.changes[0] == -1 and not found.face_sizes.any()
    found = joined(0.0 * points, triangles, faces, table).edge_figures(
        np.ones(len(points)), None, None, 0.4, 1.1
    )
    assert found.changes[0] == -1 and np.isnan(found.ratios).all()


@given(seeds, st.sampled_from([20.0, 90.0, 179.0, 200.0]))
def test_angles_beyond_a_limit_and_the_largest_of_the_others(seed, limit):
    _, points, triangles, faces, table = soup(seed, 25, 18)
    if seed % 3 == 0:
        points[:, 2] = 0.0  # all in a plane: many angles are the same
    limits = np.array([limit, 45.0, limit, 30.0])
    first, second = faces[table.half_edges // 3].T
    within = np.flatnonzero((table.uses == 2) & (first == second))
    degrees = np.degrees(dihedral_angles(points, triangles, table.half_edges[within]))
    face = first[within]
    large = degrees > limits[face]
    edges, angles, largest, number, edge = joined(
        points, triangles, faces, table
    ).angles_within_faces(limits)
    assert edges.tolist() == within[large].tolist()
    assert angles == pytest.approx(degrees[large], rel=1e-14)
    assert number.tolist() == np.bincount(face, minlength=FACES).tolist()
    for k in range(FACES):
        most = degrees[(face == k) & ~large].max(initial=0.0)
        assert largest[k] == pytest.approx(most, rel=1e-14)
    others = np.where(large, -1.0, degrees)
    assert edge == (within[others.argmax()] if (~large).any() else -1)


@given(seeds)
def test_what_is_no_number_is_the_largest_angle(seed):
    _, points, triangles, faces, table = soup(seed, 25, 18)
    points[triangles[0]] *= 1e80  # products are infinite, their differences no numbers
    with np.errstate(all="ignore"):
        first, second = faces[table.half_edges // 3].T
        within = np.flatnonzero((table.uses == 2) & (first == second))
        degrees = np.degrees(dihedral_angles(points, triangles, table.half_edges[within]))
    found = joined(points, triangles, faces, table).angles_within_faces(np.full(FACES, 180.0))
    assert np.isnan(found[2]).any() == np.isnan(degrees).any()
    if len(degrees):
        assert found[4] == within[degrees.argmax()]


@given(seeds)
def test_topology_is_that_of_its_parts(seed):
    _, points, triangles, faces, table = soup(seed, 12, 30)
    mesh = joined(points, triangles, faces, table)
    vertices, _, free, fans, pinched, crowded, clashing = mesh.topology(np.empty((0, 2), np.int32))
    assert vertices == len(np.unique(triangles)) == np.count_nonzero(fans)
    assert free == np.count_nonzero(table.uses == 1)
    assert crowded.tolist() == np.flatnonzero(table.uses > 2).tolist()
    assert pinched.tolist() == np.flatnonzero(fans > 1).tolist()
    corners = triangles.ravel()[table.half_edges]
    same = (table.uses == 2) & (corners[:, 0] == corners[:, 1])
    assert clashing.tolist() == np.flatnonzero(same).tolist()


@given(seeds)
def test_solids_count_a_triangle_between_two_for_both(seed):
    rng, points, triangles, faces, table = soup(seed)
    solids = rng.integers(-1, 3, (len(triangles), 2)).astype(np.int32)
    area, bulge = rng.random((2, len(triangles)))
    found = joined(points, triangles, faces, table).solid_figures(solids, area, bulge, 4)
    a, b, c = points[triangles].transpose(1, 0, 2)
    six = np.einsum("ij,ij->i", a, np.cross(b, c))
    for solid in range(4):
        behind, before = (solids == solid).T
        assert found[0][solid] == behind.sum() + before.sum()
        assert found[1][solid] == pytest.approx(area[behind].sum() + area[before].sum())
    whole = np.stack([np.zeros_like(faces), np.full_like(faces, -1)], axis=1)
    twice = np.concatenate([triangles, triangles[:, ::-1]])  # encloses nothing, about any point
    both = quality.JoinedTriangles(
        points, twice, np.zeros(len(twice), np.int32), 1, *connect(twice)
    ).solid_figures(np.concatenate([whole, whole]), np.ones(len(twice)), None, 1)
    assert both[2] == pytest.approx([0.0], abs=1e-12 * np.abs(six).sum())
    known = solids >= 0
    assert found[3:] == (known[:, 0].sum(), known[:, 1].sum(), known.all(axis=1).sum())


def test_volume_between_curved_triangles_and_straight_ones():
    corners = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
    triangles = np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)], np.int32)
    mesh = quality.JoinedTriangles(
        corners + 1e6, triangles, np.zeros(4, np.int32), 1, *connect(triangles)
    )
    behind = np.array([(0, 1)] * 4, np.int32)
    found = mesh.solid_figures(behind, np.ones(4), np.full(4, 0.01), 2)
    assert found[2] == pytest.approx([1 / 6 + 0.04, -1 / 6 - 0.04], rel=1e-12)


def test_losses_grow_with_the_square_of_the_distance_up_to_the_whole():
    points = np.array([(0, 0, 0), (2, 0, 0), (1, 1, 0)], float)
    triangles = np.tile(np.arange(3, dtype=np.int32), (4, 1))
    mesh = quality.JoinedTriangles(
        points, triangles, np.arange(4, dtype=np.int32), 4, *connect(triangles)
    )
    distance = np.array([0.0, 0.1, 9.0, 0.1])
    assert mesh.explained_areas(np.ones(4), distance, None, 16.0) == pytest.approx(
        [0, 0.16, 1, 0.16]
    )
    bend = np.array([1.0, 2.0, 1.0, 20.0])  # so much more at a distance, at most all
    assert mesh.explained_areas(np.ones(4), distance, bend, 16.0) == pytest.approx([0, 0.36, 1, 1])


def test_what_does_not_belong_to_the_mesh_is_refused():
    _, points, triangles, faces, table = soup(1)
    edges, half_edges, uses = table
    for wrong in (
        (points[:5], triangles, faces, FACES, *table),
        (points, triangles, faces[1:], FACES, *table),
        (points, triangles, faces, 1, *table),
        (points, triangles, faces - 1, FACES, *table),
        (points, triangles, faces, FACES, edges - 1, half_edges, uses),
        (points, triangles, faces, FACES, edges, half_edges + 3 * len(triangles), uses),
        (points, triangles, faces, FACES, edges, half_edges, uses[1:]),
    ):
        with pytest.raises(ValueError):
            quality.JoinedTriangles(*wrong)
    mesh, count = joined(points, triangles, faces, table), len(triangles)
    ones, pair = np.ones(count), np.zeros((count, 2), np.int32)
    for call in (
        lambda: mesh.edge_figures(np.ones(3), None, None, 0.0, 1.1),
        lambda: mesh.edge_figures(None, np.ones((2, 6)), None, 0.0, 1.1),
        lambda: mesh.edge_figures(None, np.ones((2, 6)), triangles + 2, 0.0, 1.1),
        lambda: mesh.angles_within_faces(np.ones(FACES + 1)),
        lambda: mesh.topology(np.array([[0, 3 * count]], np.int32)),
        lambda: mesh.solid_figures(pair, ones, None, 0),
        lambda: mesh.solid_figures(pair[1:], ones, None, 1),
        lambda: mesh.explained_areas(ones, ones[1:], None, 16.0),
        lambda: mesh.face_shapes(ones, ones[1:]),
        lambda: mesh.face_distances(ones, ones, ones, np.ones(1, np.uint8)),
    ):
        with pytest.raises(ValueError):
            call()
