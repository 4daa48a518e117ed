"""How fast pieces leave their sides, against differences at many places."""

import numpy as np
import pytest

from surfmesh._core.proof import side_rates
from surfmesh.accuracy.projected_pieces import nearest, slide_along
from surfmesh.geometry.cad_surfaces.elementary import Cone, Cylinder, Sphere, Torus
from surfmesh.geometry.core_surface import as_core_surface

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
