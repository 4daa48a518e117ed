"""Angles between neighbouring triangles, against numpy and on shapes where they are known."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from surfmesh.accuracy.dihedral import dihedral_angles
from surfmesh.quality.measures.dihedral import angles_within_faces, largest_angle
from surfmesh.quality.measures.joined import joined_triangles
from surfmesh.quality.measures.known_surfaces import KnownSurfaces
from surfmesh.result.connectivity import connect
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.curvature_size import (
    BENT_RESERVE,
    ROUND_RESERVE,
    angle_size,
    principal_angle_sizes,
)


def angles_of(points, triangles):
    table = connect(np.asarray(triangles, np.int32))
    angles = dihedral_angles(points, np.asarray(triangles, np.int32), table.half_edges)
    return np.where(table.uses == 2, angles, 0.0)


def test_octahedron():
    """All dihedral angles are arccos(-1/3), the normals turn by what is missing to pi."""
    points = np.concatenate([np.eye(3), -np.eye(3)])
    triangles = [(0, 1, 2), (1, 3, 2), (3, 4, 2), (4, 0, 2)]
    triangles += [(1, 0, 5), (3, 1, 5), (4, 3, 5), (0, 4, 5)]
    np.testing.assert_allclose(angles_of(points, triangles), np.arccos(1 / 3), rtol=1e-12)


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 2**31), st.floats(-6, 6), st.booleans())
def test_angle_of_two_triangles_does_not_depend_on_scale_or_order(seed, power, turned):
    points = np.random.default_rng(seed).normal(size=(4, 3))
    a, b, c, d = points
    m, n = np.cross(b - a, c - a), np.cross(a - b, d - b)
    cosine = m @ n / np.linalg.norm(m) / np.linalg.norm(n)
    second = (2, 0, 3)[::-1] if turned else (1, 0, 3)  # other way round: a Moebius strip
    second = (0, 1, 3) if turned else second
    found = angles_of(10.0**power * points, [(0, 1, 2), second]).max()
    assert np.cos(found) == pytest.approx(cosine, abs=1e-9)


def test_triangles_without_area_turn_by_nothing():
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0.3, 0, 0], [0.5, 1, 1]])
    assert not angles_of(points, [(0, 1, 2), (1, 0, 3)]).any()


@pytest.mark.parametrize("ratio", [1.0, 0.5, 0.0, -0.4, -1.0])
def test_angle_size_keeps_its_reserve_at_the_worst_edge_of_a_quadric(ratio):
    """Two equilateral triangles with corners on z = (x^2 + ratio y^2) / 2, in all directions."""
    worst, h = 0.0, angle_size(np.ones(1), np.full(1, ratio), 0.1)[0]
    corners = h * np.array([[-0.5, 0], [0.5, 0], [0, 0.75**0.5], [0, -(0.75**0.5)]])
    for direction in np.linspace(0, np.pi, 181):
        c, s = np.cos(direction), np.sin(direction)
        xy = corners @ [[c, s], [-s, c]]
        points = np.column_stack([xy, xy**2 @ [0.5, 0.5 * ratio]])
        worst = max(worst, angles_of(points, [(0, 1, 2), (1, 0, 3)]).max())
    mean, bent = 0.5 * (1.0 + ratio), 1.0 - ratio
    reserve = (mean + bent) / (mean / ROUND_RESERVE + bent / BENT_RESERVE)
    assert np.degrees(worst) == pytest.approx(0.1 * reserve, rel=1e-3)


@pytest.mark.parametrize("k2", [1.0, 0.3, 0.0, -0.2, -1.0])
def test_stretched_sizes_keep_the_angle_in_all_directions(k2):
    h1, h2 = (float(h[0]) for h in principal_angle_sizes(np.ones(1), np.full(1, k2), 0.1, 8.0))
    h2 = min(h2, 8.0 * h1)
    corners = np.array([[-0.5, 0], [0.5, 0], [0, 0.75**0.5], [0, -(0.75**0.5)]])
    worst = 0.0
    for direction in np.linspace(0, np.pi, 181):
        c, s = np.cos(direction), np.sin(direction)
        xy = corners @ [[c, s], [-s, c]] * [h1, h2]
        points = np.column_stack([xy, xy**2 @ [0.5, 0.5 * k2]])
        worst = max(worst, angles_of(points, [(0, 1, 2), (1, 0, 3)]).max())
    assert 0.98 * ROUND_RESERVE < np.degrees(worst) / 0.1 < 1.02 * BENT_RESERVE


class Roof:
    """z = -slope |v|: a crease along v = 0."""

    domain, name, loops = ((-1.0, 1.0), (-1.0, 1.0)), "roof", ()

    def __init__(self, slope):
        self.slope = slope

    def evaluate(self, uv, order):
        u, v = uv.T
        no, one = np.zeros_like(u), np.ones_like(u)
        parts = [np.stack([u, v, -self.slope * np.abs(v)], 1), np.stack([one, no, no], 1)]
        parts += [np.stack([no, one, -self.slope * np.sign(v)], 1)] + [np.zeros((len(u), 3))] * 3
        return tuple(parts[: (1, 3, 6)[order]])


def roof_mesh(surface, angle):
    uv = np.array([[-0.5, 0.0], [0.5, 0.0], [0.0, 0.5], [0.0, -0.5]])
    points = np.column_stack([uv, -np.abs(uv[:, 1])])
    triangles = [(0, 1, 2), (1, 0, 3)]
    return SurfaceMesh(
        points=points, triangles=triangles, uv_points=uv, surfaces=(surface,),
        sizing=Sizing(angle=angle),
    )  # fmt: skip


def within_faces(mesh):
    limits = np.array([mesh.sizing.angle])
    return angles_within_faces(KnownSurfaces.of(mesh), joined_triangles(mesh), limits)


def test_creases_of_the_surface_are_no_fault():
    assert within_faces(roof_mesh(Roof(1.0), 10.0)).largest.max() == 0.0
    bent = roof_mesh(Roof(0.0), 10.0)  # on a plane it is one
    turns = within_faces(bent)
    largest, triangles, place = largest_angle(bent, turns)
    assert largest == pytest.approx(90.0) and sorted(triangles) == [0, 1]
    assert place == pytest.approx((0.0, 0.0, 0.0))
    assert turns.above(10.0).all() and not turns.above(90.0).any()
