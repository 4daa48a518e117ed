"""How much of the allowed deviation a mesh uses: one much finer than needed uses little."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.edges import curvatures_at
from surfmesh.quality.measures.deviation import Deviation
from surfmesh.quality.measures.known_surfaces import KnownSurfaces
from surfmesh.quality.measures.tolerances import Tolerances
from surfmesh.sizing.rules.curvature_size import (
    chord_size,
    evened_chord_sizes,
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
    every = slice(None, None, -(-len(mesh.triangles) // SAMPLES))
    chosen = np.arange(len(mesh.triangles))[every]
    a, b, c = mesh.sizes.take(np.ascontiguousarray(mesh.triangles[every].T))
    target = (a + b + c) / 3.0
    decided = np.zeros(len(chosen), bool)
    faces = mesh.face_ids[every]
    chord = tolerances.at(tolerances.chord, faces)
    here = np.flatnonzero((known.in_plane[every] == 0) & (chord > 0.0) & np.isfinite(chord))
    if len(mesh.surfaces) > 1:
        here = here[np.argsort(faces[here], kind="stable")]
    if len(here):
        decided[here] = target[here] >= DECIDED * _allowed(known, chosen[here], chord[here])
    used = fit.by_triangle[chosen[decided]] / chord[decided]
    return ChordUse(float(decided.mean()), float(np.median(used)) if len(used) else None)


def _allowed(
    known: KnownSurfaces, triangles: NDArray[np.intp], chord: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Size (n,) that the curvature at the middles of triangles (n,), face by face, allows for
    ``chord`` (n,); infinite where it is flat."""
    sizing = known.mesh.sizing
    faces = known.mesh.face_ids[triangles]
    first = np.flatnonzero(np.diff(faces, prepend=-1))
    surfaces = [known.core_surfaces[face] for face in faces[first].tolist()]
    ends = np.append(first, len(triangles)).astype(np.int64)
    k1, k2, degenerate = curvatures_at(known.middle_uv(triangles), ends, surfaces)
    if sizing and sizing.is_anisotropic:
        sizes = evened_chord_sizes if sizing.is_evened else principal_chord_sizes
        size = np.minimum(*sizes(k1, k2, chord, sizing.anisotropy))
    elif sizing and sizing.is_curved:
        size = np.empty(len(chord))
        for one in np.unique(chord).tolist():
            some = chord == one
            size[some] = quadratic_chord_size(k1[some], k2[some], one)
    else:
        size = chord_size(k1, k2, chord)
    return np.where(degenerate.view(bool) | ~np.isfinite(size), np.inf, size)
