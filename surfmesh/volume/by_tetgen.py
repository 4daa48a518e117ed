"""TetGen fills one solid after the other; their triangles stay."""

import numpy as np
from numpy.typing import NDArray

from surfmesh.errors import MeshingError, needs
from surfmesh.result.surface_mesh import SurfaceMesh

RADIUS_TO_EDGE = 1.4  # of a tetrahedron that is refined: circumscribed radius over shortest edge


def fill(mesh: SurfaceMesh, size: float | None) -> tuple[NDArray, NDArray]:
    """Points, those of the mesh first, and tetrahedra: inside the solids, and in their cavities."""
    options = {}
    if size is not None:  # the volume of the regular tetrahedron
        options = {"fixedvolume": True, "maxvolume": size**3 / (6.0 * np.sqrt(2.0))}
    solids = np.asarray(mesh.solid_ids)
    points, tetrahedra = [mesh.points], []
    count = len(mesh.points)
    for solid in np.unique(solids[solids >= 0]).tolist():
        triangles = mesh.triangles[(solids == solid).any(axis=1)]
        vertices, corners = np.unique(triangles, return_inverse=True)
        found, rows = _filled(mesh.points[vertices], corners.reshape(-1, 3), options)
        inner = count + np.arange(len(found) - len(vertices))
        tetrahedra.append(np.concatenate((vertices, inner))[rows])
        points.append(found[len(vertices) :])
        count += len(inner)
    return np.concatenate(points), np.concatenate(tetrahedra)


def _filled(points: NDArray, triangles: NDArray, options: dict) -> tuple[NDArray, NDArray]:
    """Points, the given ones first, and tetrahedra; nothing is inserted on triangles and edges."""
    with needs("volume", "engine='tetgen'"):
        import tetgen
    work = tetgen.TetGen(points.copy(), triangles.astype(np.int32))
    try:
        work.tetrahedralize(
            plc=True, nobisect=True, quality=True, minratio=RADIUS_TO_EDGE, **options
        )
    except RuntimeError as error:
        raise MeshingError(f"TetGen: {error}") from None
    return np.asarray(work.node, float), np.asarray(work.elem, np.int64)[:, :4]
