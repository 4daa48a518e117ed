"""What a report does not sample, as there is nothing to see: planes and straight edges."""

import numpy as np
import pytest
from naive.surface_to_mesh import Curves

import surfmesh as sm
from surfmesh._core.quality import TriangleStars
from surfmesh._core.space import triangle_distances
from surfmesh.quality.measures.deviation import deviation
from surfmesh.quality.measures.known_surfaces import KnownSurfaces
from surfmesh.quality.measures.shape import shapes
from surfmesh.quality.measures.surface_to_mesh import ALONG_RIM, surface_deviation
from surfmesh.quality.measures.tolerances import Tolerances

cq = pytest.importorskip("cadquery")


@pytest.fixture(scope="module")
def mesh():
    part = cq.Workplane().box(4.0, 3.0, 1.0).faces(">Z").workplane().hole(1.5)
    return sm.mesh(part, sm.Sizing(size=0.4))


def is_plane(mesh):
    return np.array([mesh.groups.face_kind(face) == "plane" for face in mesh.face_ids.tolist()])


def test_all_triangles_of_planes_are_known_and_no_other(mesh):
    found = KnownSurfaces.of(mesh).in_plane.view(bool)
    np.testing.assert_array_equal(found, is_plane(mesh))


@pytest.mark.parametrize("by", [1e-6, 0.1])
def test_a_corner_that_leaves_its_plane_is_looked_at(mesh, by):
    inner = np.setdiff1d(mesh.triangles[is_plane(mesh)], mesh.edge_links.edge_segments)[0]
    points = mesh.points.copy()
    points[inner] += by
    moved = mesh.replaced(points=points)
    known = KnownSurfaces.of(moved)
    beside = (moved.triangles == inner).any(axis=1)
    assert not known.in_plane[beside].any() and known.in_plane[is_plane(mesh) & ~beside].all()
    fit = deviation(moved, shapes(moved).area, known)
    assert fit.by_triangle[beside].max() == pytest.approx(by, rel=1e-6)
    back = surface_deviation(known, fit, Tolerances.of(moved))
    assert back.by_triangle[beside].max() > 0.1 * by


def test_parameters_that_are_wrong_are_looked_at(mesh):
    inner = np.setdiff1d(mesh.triangles[is_plane(mesh)], mesh.edge_links.edge_segments)[0]
    corner = np.flatnonzero((mesh.triangles == inner).ravel())[0]
    uv = mesh.uv_points.copy()
    uv[mesh.uv_triangles.ravel()[corner]] += 50.0  # beyond the face: the surface is far there
    known = KnownSurfaces.of(mesh.replaced(uv_points=uv))
    assert not known.in_plane[(mesh.triangles == inner).any(axis=1)].any()
    wrong = sm.check(known.mesh)
    assert wrong.accuracy.surface_deviation_max > 10.0


@pytest.mark.parametrize("moved", [0, 20])
def test_distances_within_planes_are_those_of_a_search(mesh, moved):
    """Of triangles that are in their planes to rounding, looked at both ways, and of those beside
    vertices that leave them."""
    rng = np.random.default_rng(3)
    points = mesh.points + 1e-12 * rng.normal(size=mesh.points.shape)
    points[rng.integers(0, len(points), moved)] += 0.01
    shaken = mesh.replaced(points=points)
    known, area = KnownSurfaces.of(shaken), shapes(shaken).area
    found = deviation(shaken, area, known)
    assert known.in_plane.any()
    searched = KnownSurfaces.of(shaken)
    searched.__dict__["in_plane"] = np.zeros_like(known.in_plane)
    expected = deviation(shaken, area, searched)
    assert found.rms == pytest.approx(expected.rms, rel=1e-6)
    assert found.largest == pytest.approx(expected.largest, rel=1e-6)
    np.testing.assert_allclose(found.by_triangle, expected.by_triangle, atol=2e-11)
    np.testing.assert_allclose(found.mean_square, expected.mean_square, atol=1e-21, rtol=1e-6)
    np.testing.assert_allclose(found.cosine, expected.cosine, rtol=1e-6)


def test_straight_edges_are_left_out_and_round_ones_looked_at(mesh):
    curves = Curves.of(mesh)
    every = np.arange(len(curves.segments))
    segments, points, off_arc = curves.between(every, ALONG_RIM, mesh.points)
    ends = mesh.points[curves.segments]
    is_round = np.abs(np.hypot(ends[..., 0], ends[..., 1]) - 0.75).max(axis=1) < 1e-9
    upright = np.abs(ends[:, 0, 2] - ends[:, 1, 2]) > 1e-9  # the seam
    np.testing.assert_array_equal(segments, np.flatnonzero(is_round & ~upright))
    assert points.shape == (len(segments) * len(ALONG_RIM), 3)
    assert (off_arc < 1e-9).all()
    np.testing.assert_allclose(np.hypot(points[:, 0], points[:, 1]), 0.75, rtol=1e-12)


def test_nodes_off_a_straight_edge_are_looked_at(mesh):
    curves = Curves.of(mesh)
    segments, _, _ = curves.between(np.arange(len(curves.segments)), ALONG_RIM, mesh.points)
    straight = np.setdiff1d(np.arange(len(curves.segments)), segments)[0]
    points = mesh.points.copy()
    points[curves.segments[straight, 0]] += 1e-5
    again, _, _ = curves.between(np.array([straight]), ALONG_RIM, points)
    assert again.tolist() == [straight]
    points[curves.segments[straight, 0]] += 1.0  # so far off it says nothing
    again, _, _ = curves.between(np.array([straight]), ALONG_RIM, points)
    assert again.tolist() == []


def test_the_distance_from_all_triangles_is_the_least(mesh):
    stars, corners = TriangleStars(mesh.points, mesh.triangles), mesh.points[mesh.triangles]
    for place in np.random.default_rng(1).normal(size=(20, 3)):
        every = triangle_distances(np.broadcast_to(place, (len(corners), 3)), corners)
        assert stars.distance_from_all(tuple(place.tolist()), 10.0) == every.min()
        assert stars.distance_from_all(tuple(place.tolist()), 1e-9) == min(1e-9, every.min())
