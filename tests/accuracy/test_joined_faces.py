"""How fast pieces leave their sides, against differences at many places."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh._core.proof import side_rates
from surfmesh.accuracy.joined_faces import (
    _pairs,
    gaps_between,
    joined,
    rim_sides,
    shared_middles,
)
from surfmesh.accuracy.projected_pieces import nearest, slide_along
from surfmesh.geometry.cad_surfaces.elementary import Cone, Cylinder, Sphere, Torus
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.quality.measures.measurements import Measurements
from surfmesh.quality.measures.proof import moved_faces

AXES = np.linalg.qr([[1.0, 2, 0], [0, 1, 3], [2, 0, 1]])[0].T
FRAME = {"origin": np.array([0.1, 0.2, 0.3])} | dict(zip("xyz", AXES, strict=True))
DOMAIN = ((-10.0, 10.0), (-10.0, 10.0))
T = np.linspace(0.0, 1.0, 201)


SURFACES = (
    Cylinder(**FRAME, radius=0.7, domain=DOMAIN),
    Sphere(**FRAME, radius=0.7, domain=DOMAIN),
    Cone(**FRAME, radius=0.7, angle=0.4, domain=DOMAIN),
    Cone(**FRAME, radius=0.7, angle=-0.4, domain=DOMAIN),
)


def sides(surface, count, size):
    draw = np.random.default_rng(7)
    uv = draw.uniform(-1.0, 1.0, (count, 1, 2)) + draw.uniform(-size, size, (count, 2, 2))
    return uv, surface.evaluate(uv.reshape(-1, 2), 0)[0].reshape(-1, 2, 3)


def rates(curve, ends):
    """(2, k) along and across, by differences of curve (k, q, 3)."""
    side = ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(side, axis=1)
    unit = side / length[:, None]
    leaves = np.diff(curve, axis=1) / (np.diff(T)[:, None] * length[:, None, None])
    leaves = leaves - unit[:, None]
    along = np.einsum("kqc,kc->kq", leaves, unit)
    across = np.linalg.norm(leaves - along[:, :, None] * unit[:, None], axis=2)
    return np.abs(along).max(axis=1), across.max(axis=1)


@pytest.mark.parametrize("surface", SURFACES, ids=lambda s: s.kind)
def test_points_slide_no_faster_along_their_side(surface):
    _, ends = sides(surface, 300, 0.2)
    flat = (1.0 - T)[:, None] * ends[:, None, 0] + T[:, None] * ends[:, None, 1]
    moved = nearest(surface, flat)
    away = np.linalg.norm(moved - flat, axis=2).max(axis=1)
    along, _ = rates(moved, ends)
    bound = slide_along(surface, ends, away)
    assert (along <= bound + 1e-9).all()
    assert np.median(bound / np.maximum(along, 1e-6)) < 5.0


@pytest.mark.parametrize("surface", SURFACES, ids=lambda s: s.kind)
def test_nearest_points_lie_on_the_surface(surface):
    _, ends = sides(surface, 50, 0.2)
    moved = nearest(surface, ends + 0.01)
    again = nearest(surface, moved)
    assert np.abs(again - moved).max() < 1e-12
    assert np.abs(nearest(surface, ends) - ends).max() < 1e-12


def test_curves_leave_their_side_no_faster_than_is_said():
    torus = Torus(**FRAME, radius=1.0, tube=0.4, domain=DOMAIN)
    uv, ends = sides(torus, 300, 0.15)
    at = (1.0 - T)[:, None] * uv[:, None, 0] + T[:, None] * uv[:, None, 1]
    curve = torus.evaluate(at.reshape(-1, 2), 0)[0].reshape(*at.shape[:2], 3)
    along, across = rates(curve, ends)
    bound = side_rates(as_core_surface(torus), ends, uv)
    assert (along <= bound[:, 0] + 1e-9).all() and (across <= bound[:, 1] + 1e-9).all()
    assert np.median(bound[:, 1] / across) < 1.6


def moved_faces_of(part, fraction):
    cq = pytest.importorskip("cadquery")
    model = sm.from_cadquery(part(cq))
    mesh = sm.mesh(model, sm.Sizing(chord=model.diagonal / fraction), jobs=1)
    measured = Measurements(mesh)
    return mesh, moved_faces(measured.known, measured.proof)


PARTS = {
    "rounded": lambda cq: cq.Workplane().box(3, 2, 1).edges().fillet(0.2),
    "hole": lambda cq: cq.Workplane().box(3, 2, 1).faces(">Z").workplane().hole(0.6),
    "ends": lambda cq: cq.Workplane().add(cq.Solid.makeCylinder(1, 2)).edges().fillet(0.5),
}


@pytest.mark.parametrize("name", PARTS)
def test_curves_over_sides_of_two_faces_move_less_than_is_said(name):
    """From places of a side to the next, by no more than the slope of both triangles."""
    mesh, faces = moved_faces_of(PARTS[name], 500)
    sides = rim_sides(faces)
    moves = joined(faces, sides, len(mesh.points))
    assert gaps_between(faces, sides).max() < 1e-12
    one, other = _pairs(sides)
    assert len(one) > 50
    for own in (one, other):
        is_curved = (sides.normal[own] == 0.0).all(axis=1)
        move = np.zeros((is_curved.sum(), 5, 3))
        move[:, 1:4] = sides.piece[own[is_curved]]
        rate = np.linalg.norm(np.diff(move, axis=1), axis=2) / (
            0.25 * sides.length[own[is_curved], None]
        )
        assert (rate.max(axis=1) <= moves.slope[sides.triangle[own[is_curved]]] + 1e-9).all()
        far = np.linalg.norm(move, axis=2).max(axis=1)
        assert (far <= moves.away[sides.triangle[own[is_curved]]] + 1e-9).all()


def test_triangles_of_a_plane_follow_the_hole_in_it():
    mesh, faces = moved_faces_of(PARTS["hole"], 500)
    sides = rim_sides(faces)
    moves = joined(faces, sides, len(mesh.points))
    one, other = _pairs(sides)
    is_plane = (sides.normal != 0.0).any(axis=1)
    for own, beside in ((one, other), (other, one)):
        follows = is_plane[own] & ~is_plane[beside]
        far = np.linalg.norm(sides.piece[beside[follows]], axis=2).max(axis=1)
        assert (far <= moves.away[sides.triangle[own[follows]]]).all()
        assert (moves.slope[sides.triangle[own[follows]]] > 0.0).all()


def test_sides_of_two_faces_are_cut_at_one_place():
    mesh, faces = moved_faces_of(PARTS["rounded"], 500)
    is_bent = np.ones(len(mesh.points), bool)
    flat, moved, shared = shared_middles(faces, rim_sides(faces), mesh.points, is_bent)
    for face, own in zip(faces, shared, strict=True):
        at = own.numbers - len(mesh.points)
        points = face.surface.evaluate(own.uv, 0)[0]
        assert np.abs(points - moved[at]).max(initial=0.0) < 2e-3  # over (u, v), or nearest
    assert np.linalg.norm(moved - flat, axis=1).max() > 0.0
