"""Tiny edges and slivers go away, the topology stays."""

import cadquery as cq
import numpy as np
import pytest

import surfmesh as sm


def notched() -> cq.Workplane:
    """A block whose top has a step of a thousandth of its length."""
    outside = [(0, 0), (100, 0), (100, 30), (50.01, 30), (50, 30.01), (0, 30.01)]
    return cq.Workplane().polyline(outside).close().extrude(20)


@pytest.fixture(scope="module")
def model():
    return sm.from_cadquery(notched())


def test_tiny_edges_are_one_segment_and_do_not_flood(model):
    plain = sm.mesh(sm.from_cadquery(cq.Workplane().box(100, 30, 20)), sm.Sizing(size=5.0))
    mesh = sm.mesh(model, sm.Sizing(size=5.0))
    assert sm.check(mesh).clean
    tiny = [k for k, edge in enumerate(model.edges) if edge.length < 0.02]
    assert tiny
    for number in tiny:
        assert (mesh.edge_ids == number).sum() == 1
    assert len(mesh.triangles) < 4 * len(plain.triangles)
    floored = sm.mesh(model, sm.Sizing(size=5.0, min_size=5.0))
    assert len(floored.triangles) < 1.3 * len(plain.triangles)


def test_simplified_mesh_has_no_short_edges(model):
    mesh = sm.mesh(model, sm.Sizing(size=5.0, min_size=1.0), simplify=True)
    report = sm.check(mesh)
    assert report.clean and report.closed and report.euler == 2
    assert report.edge_min >= 1.0 - 1e-9
    assert report.volume == pytest.approx(model.volume, rel=1e-3)
    assert any("has vanished" in warning for warning in mesh.warnings)
    assert mesh.broken_invariant() is None
    # edges of the model are still edges of the mesh
    known = set(map(tuple, mesh.edges.tolist()))
    assert {tuple(sorted(pair)) for pair in mesh.edge_segments.tolist()} <= known


def test_corners_keep_their_parameters(model):
    mesh = sm.mesh(model, sm.Sizing(size=5.0, min_size=1.0), simplify=True)
    for face in np.unique(mesh.face_ids):
        of = mesh.face_ids == face
        place = mesh.surfaces[face].evaluate(mesh.uv[of].reshape(-1, 2), 0)[0]
        away = np.linalg.norm(place - mesh.points[mesh.triangles[of]].reshape(-1, 3), axis=1)
        assert away.max() < 0.02  # where a point of a neighbouring face has taken the place


def test_a_mesh_without_short_edges_is_left_alone():
    model = sm.from_cadquery(cq.Workplane().box(10, 10, 10))
    plain = sm.mesh(model, sm.Sizing(size=3.0))
    again = sm.mesh(model, sm.Sizing(size=3.0), simplify=True)
    assert np.array_equal(plain.triangles, again.triangles)


def test_a_tiny_hole_stays_a_hole():
    part = cq.Workplane().box(10, 10, 10).faces(">Z").workplane().hole(0.2)
    mesh = sm.mesh(sm.from_cadquery(part), sm.Sizing(size=2.0, min_size=1.0), simplify=True)
    report = sm.check(mesh)
    assert report.closed and report.manifold and report.euler == 0


@pytest.mark.parametrize("least", [0.1, 0.12])
def test_many_small_turns_turn_no_triangle_over(least):
    """Each collapse turned by less than 45 degrees, several of them by more than 90."""
    part = cq.Workplane().box(2, 1.6, 0.5).faces(">Z").workplane().hole(0.8)
    mesh = sm.mesh(part.edges("|Z").fillet(0.2), min_size=least, simplify=True)
    assert sm.check(mesh).clean
