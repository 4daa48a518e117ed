"""Meshes made by hand, with known answers, as fixtures."""

import numpy as np
import pytest
from handmade_meshes import Saddle, grid

from surfmesh.result.surface_mesh import SurfaceMesh


@pytest.fixture
def tetrahedron():
    points = [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]
    return SurfaceMesh(points=points, triangles=[(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 3, 2)])


@pytest.fixture
def saddle():
    return grid(
        Saddle(),
        8,
        sizes=np.full(81, 0.3),
        face_ids=np.repeat((0, 1), 64),
        surfaces=(Saddle(), Saddle()),
    )


@pytest.fixture
def moebius_band():
    """Seven triangles on seven vertices: t, t+1, t+2 modulo 7, which no orientation fits."""
    angle = 2 * np.pi * np.arange(7) / 7
    side = 0.3 * (-1.0) ** np.arange(7)  # in turns on either border of the band
    radius = 1 + side * np.cos(angle / 2)
    points = np.column_stack(
        (radius * np.cos(angle), radius * np.sin(angle), side * np.sin(angle / 2))
    )
    strip = [(t, t + 1, t + 2) if t % 2 == 0 else (t + 1, t, t + 2) for t in range(7)]
    return SurfaceMesh(points=points, triangles=np.array(strip) % 7)
