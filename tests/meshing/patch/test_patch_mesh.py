"""The one patch mesher: seams identified, requests where the optimiser could not do it."""

import numpy as np
import pytest

import surfmesh as sm
from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.differential.sides import find_sides
from surfmesh.meshing.boundary.boundary_loops import boundary_loops
from surfmesh.meshing.patch.patch_mesh import mesh_patch
from surfmesh.meshing.patch.size_requests import joined
from surfmesh.result.connectivity import connect
from surfmesh.sizing.field.size_field import size_field
from surfmesh.sizing.rules.size_limits import SizeLimits


def patch_of(name, **asked):
    surface = sm.load(name)
    sides, chart = find_sides(surface), Chart.of(surface)
    field = size_field(surface, sm.Sizing(**asked), sides, chart=chart)
    return mesh_patch(surface, chart, field, boundary_loops(surface, sides, field))


@pytest.mark.parametrize("name, euler", [("torus", 0), ("klein", 0), ("mobius", 0), ("sphere", 2)])
def test_sides_are_identified(name, euler):
    patch = patch_of(name, size=0.3)
    space = patch.space
    table = connect(space.triangles)
    assert len(space.points) - len(table.edges) + len(space.triangles) == euler
    assert table.uses.max() == 2 and not len(space.non_manifold)
    assert patch.limits_for_seams(0.5) is None
    assert len(patch.sizes) == len(space.points) and len(patch.uv) > len(space.points)
    surface = sm.load(name)
    corners = surface.evaluate(patch.uv[space.uv_triangles.ravel()], 0)[0]
    assert np.abs(corners - space.points[space.triangles.ravel()]).max() < 1e-9


def test_nothing_is_requested_where_all_is_well():
    assert joined(*patch_of("torus", size=0.3).requests) is None


def test_requests_are_joined_in_their_order():
    one, two = (SizeLimits(np.zeros((1, 3)), np.array([size]), 0.2) for size in (1.0, 2.0))
    none = SizeLimits(np.empty((0, 3)), np.empty(0), 0.2)
    assert joined(None, none) is None
    assert joined(None, two, none, one).sizes.tolist() == [2.0, 1.0]
