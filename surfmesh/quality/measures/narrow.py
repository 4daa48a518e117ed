"""Triangles of faces narrower than the chord: counted apart, as good shape is not owed there."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.quality.measures.spread import Spread
from surfmesh.result.surface_mesh import SurfaceMesh

DEGENERATE = 1e-6
"""Alpha below which a triangle has no area to speak of."""

DEGENERATE_NARROW = 1e-9
"""The same across a face that is itself that narrow: there it must be well above rounding only."""


class NarrowTriangles(NamedTuple):
    """How many there are, and the shapes of the others; None where there are no others."""

    number: int
    alpha_mean_elsewhere: float | None
    alpha_min_elsewhere: float | None


def in_narrow_faces(mesh: SurfaceMesh) -> NDArray[np.bool_]:
    """(m,) which triangles close a face that is narrower than the chord between its two sides."""
    if mesh.narrow_faces is None:
        return np.zeros(len(mesh.triangles), bool)
    return mesh.narrow_faces[mesh.face_ids]


def narrow_triangles(
    mesh: SurfaceMesh, alpha: NDArray[np.float64], of_all: Spread
) -> NarrowTriangles:
    """alpha: (m,) of all triangles, and how they are spread."""
    faces, others = mesh.narrow_faces, alpha
    if faces is not None and faces.any():
        others = alpha[~in_narrow_faces(mesh)]
        of_all = Spread.of(others)
    count = len(alpha) - len(others)
    if not len(others):
        return NarrowTriangles(count, None, None)
    return NarrowTriangles(count, of_all.mean, of_all.least)


def without_area(mesh: SurfaceMesh, alpha: NDArray[np.float64], least: float) -> NDArray[np.bool_]:
    """(m,) which triangles have none to speak of, for the face that they are on. least: of alpha,
    NaN where one is."""
    if least > DEGENERATE:
        return np.zeros(len(alpha), bool)
    flat = ~(alpha > DEGENERATE)
    if mesh.narrow_faces is not None:
        flat &= ~(in_narrow_faces(mesh) & (alpha > DEGENERATE_NARROW))
    return flat
