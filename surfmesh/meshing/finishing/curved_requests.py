"""Upper bounds of the size, for another round, where quadratic triangles keep not to the chord."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from surfmesh.accuracy.curved_triangles import are_bent
from surfmesh.meshing.finishing.second_order import of_second_order
from surfmesh.result.curved_fit import curved_fit
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.rules.size_limits import SizeLimits

TOLERATED = 0.96
"""Of the chord: what is let pass. Between the samples may be a little more."""

AIM = 0.85
"""Of the chord, at which smaller triangles aim, by an error of third order."""

FINEST, COARSEST = 0.5, 0.85
"""Of the sizes, in one round."""


def requests_for_curved(
    mesh: SurfaceMesh, chords: NDArray[np.float64], slope: float, known: Mapping[int, SizeLimits]
) -> dict[int, SizeLimits]:
    """By face, where its triangles are farther from their surface than its chord once they are
    quadratic.

    chords: (f,) of the faces of ``mesh``, which has sizes; nan for none. known: by face, from
    earlier rounds: what is asked for again at a place is smaller.
    """
    if mesh.sizes is None or mesh.parametrisation is None or not mesh.surfaces:
        return {}
    curved, chord = of_second_order(mesh), chords[mesh.face_ids]
    assert curved.mid_points is not None  # noqa: S101  for mypy
    sides = curved.elements[:, 3:].astype(np.int64) - len(mesh.points)
    bent = are_bent(mesh.points, curved.mid_points, mesh.edges, sides, chord)
    fit = curved_fit(curved, chosen=bent)
    far = np.flatnonzero(fit.largest > TOLERATED * chord)  # nan is no chord
    if not len(far):
        return {}
    factor = np.clip((AIM * chord[far] / fit.largest[far]) ** (1.0 / 3.0), FINEST, COARSEST)
    corners = mesh.triangles[far]
    sizes = mesh.sizes[corners].mean(axis=1)
    points = mesh.points[corners].mean(axis=1)
    uv = mesh.parametrisation.uv_points[mesh.parametrisation.uv_triangles[far]].mean(axis=1)
    faces = mesh.face_ids[far]
    requests = {}
    for face in np.unique(faces).tolist():
        own = np.flatnonzero(faces == face)
        before = sizes[own]
        if face in known:
            before = np.minimum(before, known[face](points[own]))
        requests[face] = SizeLimits(points[own], factor[own] * before, slope, uv=uv[own])
    return requests
