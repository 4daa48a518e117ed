"""How many triangles the chord needs at least: those that a mesh has are compared with it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core import quality as core
from surfmesh.quality.measures.known_surfaces import KnownSurfaces
from surfmesh.quality.measures.tolerances import Tolerances


class LeastTriangles(NamedTuple):
    """Of the whole mesh."""

    least: float  # whatever their shape and size
    equilateral: float | None  # none longer one way than another; None: stretched, or balanced


def least_triangles(
    known: KnownSurfaces, area: NDArray[np.float64], tolerances: Tolerances
) -> LeastTriangles | None:
    """The sum over the faces of what each needs. area: (m,) of the triangles.

    The integral of c sqrt |K| / chord dA, K = k1 k2 by the curvature of the surface, with
    c = 2 / (3 sqrt 3) where K > 0 (Fejes Toth) and 1 / (2 sqrt 5) where K < 0 (Atariah, Rote,
    Wintraecken, arXiv 1511.01361), for vertices on the surface; where the vertices are balanced
    1 / (3 sqrt 3) and sqrt 3 / 8. Or what its rims need, where that is more, as on planes and
    cylinders: with n segments, the integral of sqrt(k / (8 chord)) ds, a face of Euler number x has
    n - 2 x triangles or more. Both are for a small chord: of few triangles fewer may do.

    None where no chord was asked for, and of quadratic triangles.
    """
    mesh = known.mesh
    if mesh.order != 1 or not np.isfinite(tolerances.chord).any():
        return None
    faces = np.arange(len(mesh.surfaces))
    chord = np.ascontiguousarray(tolerances.at(tolerances.chord, faces), float)
    corner = np.zeros(len(mesh.points), np.uint8)
    if mesh.vertex_ids is not None:
        corner[mesh.vertex_ids[mesh.vertex_ids >= 0]] = 1
    sizing = mesh.sizing
    balanced = sizing is not None and sizing.is_balanced
    least, equilateral = core.least_triangles(
        *known.arrays, mesh.connectivity.half_edges, area, chord, corner, balanced
    )
    alike = not balanced and not (sizing is not None and sizing.is_anisotropic)
    return LeastTriangles(float(least.sum()), float(equilateral.sum()) if alike else None)
