"""Free edges that lie on each other and share no vertices: triangles that were never joined.

Files whose triangles each bring their own corners look whole and are not: nothing is closed.
"""

import numpy as np
from numpy.typing import NDArray

from surfmesh.result.surface_mesh import SurfaceMesh


def coincident_edges(mesh: SurfaceMesh) -> NDArray[np.intp]:
    """Rows of ``mesh.edges``: free ones of a face whose ends lie where those of another free edge
    of it lie, to the last bit. Those of different faces are ``loose_edges``."""
    free = np.flatnonzero(mesh.connectivity.uses == 1)
    ends = mesh.points[mesh.edges[free]]
    if not len(free) or not np.isfinite(ends).all():
        return free[:0]
    _, place = np.unique(ends.reshape(-1, 3), axis=0, return_inverse=True)
    face = mesh.face_ids[mesh.connectivity.half_edges[free, 0] // 3]
    edges = np.column_stack([np.sort(place.reshape(-1, 2), axis=1), face])
    _, of, count = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
    return free[count[of.reshape(-1)] > 1]
