"""How much of the allowed deviation a mesh uses: one much finer than needed uses little."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.differential.fundamental_forms import curvatures, forms_from_derivatives
from surfmesh.quality.measures.deviation import Deviation
from surfmesh.quality.measures.known_surfaces import KnownSurfaces
from surfmesh.quality.measures.tolerances import Tolerances
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.sizing.rules.curvature_size import (
    chord_size,
    principal_chord_sizes,
    quadratic_chord_size,
)

SAMPLES = 20_000  # triangles that are looked at: a median is known to 1 % from so many
DECIDED = 0.8  # of the size that chord allows from which it is said to decide


class ChordUse(NamedTuple):
    """Of the triangles whose size is what ``chord`` allows."""

    fraction: float  # of all triangles
    used: float | None  # median of deviation / chord; None when there are no such triangles


def chord_use(known: KnownSurfaces, fit: Deviation, tolerances: Tolerances) -> ChordUse | None:
    """None where no chord was asked for, or sizes are not known.

    ``chord`` decides where the target size at a triangle is at least 0.8 of what the curvature
    at its centroid allows: not where growth, ``max_size``, ``angle`` or a source ask for less,
    nor where an earlier round has lowered the sizes by more than that.
    """
    mesh = known.mesh
    if mesh.sizes is None or not np.isfinite(tolerances.chord).any():
        return None
    step = -(-len(mesh.triangles) // SAMPLES)
    chosen = np.arange(0, len(mesh.triangles), step)
    target = mesh.sizes[mesh.triangles[chosen]].mean(axis=1)
    decided = np.zeros(len(chosen), bool)
    faces = mesh.face_ids[chosen]
    for face in np.unique(faces):
        here = np.flatnonzero(faces == face)
        uv = known.middle_uv(chosen[here])
        chord = tolerances.one(tolerances.chord, int(face))
        if chord is not None:
            decided[here] = target[here] >= DECIDED * _allowed(mesh, int(face), uv, chord)
    used = fit.by_triangle[chosen[decided]] / tolerances.at(tolerances.chord, faces[decided])
    return ChordUse(float(decided.mean()), float(np.median(used)) if len(used) else None)


def _allowed(mesh: SurfaceMesh, face: int, uv: NDArray, chord: float) -> NDArray[np.float64]:
    """Size (n,) that the curvature at uv (n, 2) of a face allows; infinite where it is flat."""
    _, ru, rv, *second = mesh.surfaces[face].evaluate(uv, 2)
    forms = forms_from_derivatives(ru, rv, *second)
    k = curvatures(forms)
    if mesh.sizing and mesh.sizing.is_anisotropic:
        size = np.minimum(*principal_chord_sizes(k.k1, k.k2, chord, mesh.sizing.anisotropy))
    elif mesh.sizing and mesh.sizing.is_curved:
        size = quadratic_chord_size(k.k1, k.k2, chord)
    else:
        size = chord_size(k.k1, k.k2, chord)
    return np.where(forms.degenerate | ~np.isfinite(size), np.inf, size)
