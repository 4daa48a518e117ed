"""How much of the allowed deviation a mesh uses: one much finer than needed uses little."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.edges import curvatures_at
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
    chosen = chosen[np.argsort(mesh.face_ids[chosen], kind="stable")]
    a, b, c = (mesh.sizes[corner] for corner in mesh.triangles[chosen].T)
    faces, first = np.unique(mesh.face_ids[chosen], return_index=True)
    surfaces = [known.core_surfaces[face] for face in faces.tolist()]
    first = np.append(first, len(chosen))
    k1, k2, degenerate = curvatures_at(known.middle_uv(chosen), first.astype(np.int64), surfaces)
    decided = np.zeros(len(chosen), bool)
    for face, here in zip(faces.tolist(), map(slice, first[:-1], first[1:])):
        chord = tolerances.one(tolerances.chord, face)
        if chord is None:
            continue
        allowed = _allowed(mesh, k1[here], k2[here], chord)
        bent = np.isfinite(allowed) & (degenerate[here] == 0)
        decided[here] = bent & ((a[here] + b[here] + c[here]) / 3.0 >= DECIDED * allowed)
    chord_of = tolerances.at(tolerances.chord, mesh.face_ids[chosen[decided]])
    used = fit.by_triangle[chosen[decided]] / chord_of
    return ChordUse(float(decided.mean()), float(np.median(used)) if len(used) else None)


def _allowed(mesh: SurfaceMesh, k1: NDArray, k2: NDArray, chord: float) -> NDArray[np.float64]:
    """Size (n,) that principal curvatures allow; infinite where they are 0."""
    if mesh.sizing and mesh.sizing.is_anisotropic:
        return np.minimum(*principal_chord_sizes(k1, k2, chord, mesh.sizing.anisotropy))
    if mesh.sizing and mesh.sizing.is_curved:
        return quadratic_chord_size(k1, k2, chord)
    return chord_size(k1, k2, chord)
