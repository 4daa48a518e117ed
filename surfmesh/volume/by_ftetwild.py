"""fTetWild fills any surface, even one that meets itself; it makes a new one within an envelope."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from surfmesh.errors import MeshingError
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.volume.solid_regions import CORNERS, positive

ENVELOPE = 1e-3  # of the diagonal: how far the new surface may be from the old one
LEFT_BEHIND = "__tracked_surface.stl"  # which it writes into the working directory


def fill_near(
    mesh: SurfaceMesh, size: float | None
) -> tuple[SurfaceMesh, NDArray, NDArray, str]:  # fmt: skip
    """The new surface, points (its own first), tetrahedra, and what to say of them."""
    try:
        import pytetwild
    except ImportError:
        raise ImportError("engine='ftetwild' needs pytetwild: pip install pytetwild") from None
    solids = np.unique(np.asarray(mesh.solid_ids))
    if len(solids[solids >= 0]) != 1:
        raise MeshingError("fTetWild fills one solid; this mesh has several")
    options = {} if size is None else {"edge_length_abs": float(size)}
    left_behind = Path(LEFT_BEHIND)
    kept = left_behind.exists()
    try:
        points, rows = pytetwild.tetrahedralize(
            mesh.points.copy(), mesh.triangles.astype(np.int32), epsilon=ENVELOPE, num_threads=1,
            **options,
        )  # fmt: skip
    except RuntimeError as error:
        raise MeshingError(f"fTetWild: {error}") from None
    finally:
        if not kept:
            left_behind.unlink(missing_ok=True)
    if not len(rows):
        raise MeshingError("fTetWild made no tetrahedra")
    rows = positive(points, rows.astype(np.int64))
    triangles = _outer_sides(rows)
    on = np.unique(triangles)
    rank = np.full(len(points), -1)
    rank[on] = np.arange(len(on))
    rest = np.flatnonzero(rank < 0)
    rank[rest] = len(on) + np.arange(len(rest))
    triangles = rank[triangles].astype(np.int32)
    centres = points[on][triangles].mean(axis=1)
    _, nearest = cKDTree(mesh.points[mesh.triangles].mean(axis=1)).query(centres)
    sides = np.tile(np.array([[int(solids.max()), -1]], np.int32), (len(triangles), 1))
    surface = SurfaceMesh(
        points=points[on], triangles=triangles, face_ids=mesh.face_ids[nearest], solid_ids=sides,
        groups=mesh.groups,
    )  # fmt: skip
    warning = f"fTetWild made a new surface within {ENVELOPE:g} of the diagonal of the old one"
    return surface, points[np.concatenate((on, rest))], rank[rows], warning


def _outer_sides(rows: NDArray) -> NDArray:
    """Sides of one tetrahedron alone, counter-clockwise from outside."""
    sides = rows[:, CORNERS].reshape(-1, 3)
    _, first, counts = np.unique(
        np.sort(sides, axis=1), axis=0, return_index=True, return_counts=True
    )
    return sides[np.sort(first[counts == 1])]
