"""Edges across which triangles have come to turn by more than ``angle``, as their vertices moved.

On the surface the angle held there: sizes that are a little smaller let it hold again. Where it did
not, at creases and apexes of the surface, no size would.
"""

import numpy as np
from numpy.typing import NDArray

from surfmesh.accuracy.dihedral import SLACK, dihedral_angles
from surfmesh.result.surface_mesh import SurfaceMesh


def turned_edges(
    mesh: SurfaceMesh, before: NDArray[np.float64], angles: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Triangles (k,) beside such edges, and how much (k,) the angle is of what is asked for.

    before: points (n, 3) on the surface. angles: (f,) asked for on the faces, degrees, infinite
    for none.
    """
    pairs = mesh.connectivity.half_edges[mesh.connectivity.uses == 2]
    face = mesh.face_ids[pairs // 3]
    pairs = pairs[(face[:, 0] == face[:, 1]) & np.isfinite(angles[face[:, 0]])]
    asked = np.radians(angles[mesh.face_ids[pairs[:, 0] // 3]]) * (1.0 + SLACK)
    after = dihedral_angles(mesh.points, mesh.triangles, pairs)
    turned = after > asked
    turned[turned] = dihedral_angles(before, mesh.triangles, pairs[turned]) <= asked[turned]
    beside = (pairs[turned] // 3).astype(np.int64).ravel()
    return beside, (after[turned] / asked[turned]).repeat(2)
