"""Corners of faces that touch along two edges: triangles there do not lie on each other."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh.meshing.solids.crowded_chords import with_flat_corners_cut


@pytest.fixture(scope="module")
def saddle_and_plane():
    """They touch in the middle and share four straight edges that leave it at right angles."""
    saddle = sm.ParametricSurface("u", "v", "u*u - v*v", (-1, 1.1), (-1.2, 1), name="saddle")
    plane = sm.ParametricSurface("u", "v", "0", (-1.5, 1.515), (-1.5, 1.5), name="plane")
    return sm.intersect([saddle, plane])


@pytest.mark.parametrize("size", [0.3, 0.4, 0.7])
def test_no_triangle_of_a_saddle_lies_in_its_tangent_plane(saddle_and_plane, size):
    mesh = sm.mesh(saddle_and_plane, size)
    bent = [number for number, surface in enumerate(mesh.surfaces) if surface.name == "saddle"]
    own = mesh.triangles[np.isin(mesh.face_ids, bent)]
    assert len(own) and (np.abs(mesh.points[own][:, :, 2]).max(axis=1) > 1e-6).all()
    assert sm.check(mesh).clean


def test_corners_of_a_block_are_left_alone():
    cadquery = pytest.importorskip("cadquery")
    model = sm.from_cadquery(cadquery.Workplane().box(1, 2, 3))
    mesh = sm.mesh(model, 2.0)
    assert with_flat_corners_cut(model, mesh) is mesh
