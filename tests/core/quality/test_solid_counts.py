"""Vertices and edges of solids, against sets of them."""

import numpy as np
import pytest
from handmade_meshes import icosphere
from hypothesis import given
from hypothesis import strategies as st

from surfmesh._core.quality import solid_counts
from surfmesh.quality.measures.topology import topology
from surfmesh.result.surface_mesh import SurfaceMesh


def slow(triangles, solid, solids):
    counts = []
    for k in range(solids):
        own = triangles[solid == k].tolist()
        balance = {}
        for a, b in ((t[i], t[(i + 1) % 3]) for t in own for i in range(3)):
            key = min(a, b), max(a, b)
            balance[key] = balance.get(key, 0) + (1 if a < b else -1)
        used = {corner for t in own for corner in t}
        counts.append((len(used), len(balance), sum(value != 0 for value in balance.values())))
    return np.array(counts).T


@given(st.integers(0, 2**31))
def test_counts_are_those_of_sets(seed):
    draw = np.random.default_rng(seed)
    triangles = draw.integers(0, 6, size=(20, 3)).astype(np.int32)
    a, b, c = triangles.T
    triangles = triangles[(a != b) & (b != c) & (c != a)]
    solid = draw.integers(0, 3, len(triangles)).astype(np.int32)
    assert (np.array(solid_counts(triangles, solid, 6, 3)) == slow(triangles, solid, 3)).all()


def test_what_is_out_of_range_is_refused():
    one = np.array([[0, 1, 2]], np.int32)
    for triangles, solid in ((one, [1]), (one + 1, [0]), (one, [0, 0]), (one, [-1])):
        with pytest.raises(ValueError):
            solid_counts(triangles, np.array(solid, np.int32), 3, 1)


@given(st.integers(0, 2**31))
def test_one_solid_of_all_triangles_is_counted_as_the_mesh(seed):
    """So ``by_solid`` takes it: the same Euler number, and closed where the mesh is balanced."""
    draw = np.random.default_rng(seed)
    triangles = icosphere(1).triangles.copy()
    for _ in range(draw.integers(0, 3)):  # turned over, or all corners moved to others
        k = draw.integers(0, len(triangles))
        triangles[k] = draw.choice((triangles[k][::-1], draw.permutation(12)[:3]))
    mesh = SurfaceMesh(points=icosphere(1).points, triangles=triangles)
    found = topology(mesh)
    (vertices,), (edges,), (opened,) = solid_counts(
        triangles, np.zeros(len(triangles), np.int32), len(mesh.points), 1
    )
    assert found.euler == vertices - edges + len(triangles)
    assert found.balanced == (opened == 0)
