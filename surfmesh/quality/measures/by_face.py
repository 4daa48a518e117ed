"""The figures of each face: one row a face, in the order of the faces."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfmesh._core import quality as core
from surfmesh.accuracy.dihedral import SLACK
from surfmesh.quality.measures.face_rows import (
    FaceColumns,
    FaceDeviations,
    FaceDihedrals,
    FaceRows,
)
from surfmesh.quality.measures.measurements import Measurements


def by_face(measured: Measurements) -> FaceRows:
    """Rows of all surfaces, or of the numbers that occur where none is known.

    An edge between two faces counts for both, the row's sizes are means over edges. No row of a
    mesh whose ``face_ids`` are out of range.
    """
    mesh, shape, tolerances = measured.mesh, measured.shapes, measured.tolerances
    faces: NDArray[np.integer[Any]] = mesh.face_ids
    numbers = np.arange(len(mesh.surfaces))
    if not mesh.surfaces:
        numbers, faces = np.unique(faces, return_inverse=True)
    elif len(faces) and not 0 <= faces.min() <= faces.max() < len(numbers):
        return FaceRows()
    count = len(numbers)
    rows = faces.astype(np.int32, copy=False)
    triangles, area, alpha_sum, alpha_min = core.face_shapes(rows, shape.area, shape.alpha, count)
    size, target = _sizes(measured, rows, count)
    limits: dict[int, list[str]] = {}
    for limit in measured.limits:
        limits.setdefault(limit.face, []).append(str(limit))
    return FaceRows(
        FaceColumns(
            mesh=mesh,
            numbers=numbers,
            facts=measured.facts.faces,
            triangles=triangles,
            area=area,
            alpha_sum=alpha_sum,
            alpha_min=alpha_min,
            size=size,
            target=target,
            fits=_deviations(measured, rows, count),
            dihedrals=_dihedrals(measured, count),
            tolerances=tolerances,
            limits=limits,
        )
    )


def _deviations(
    measured: Measurements, faces: NDArray[np.int32], count: int
) -> FaceDeviations | None:
    fit, folds, far = measured.deviation, measured.folds, measured.beyond_chord
    if fit is None or folds is None or far is None:
        return None
    largest, worst, square, above = core.face_distances(
        faces, fit.by_triangle, fit.mean_square, measured.shapes.area, far.view(np.uint8), count
    )
    return FaceDeviations(
        largest,
        worst,
        measured.mesh.points[measured.mesh.triangles[worst]].mean(axis=1),
        square=square,
        above=above,
        folded=np.bincount(faces[folds.by_mesh], minlength=count),
    )


def _dihedrals(measured: Measurements, count: int) -> FaceDihedrals | None:
    found = measured.dihedral_angles
    if found is None:
        return None
    most = measured.tolerances.angle[:count] * (1.0 + SLACK)
    return FaceDihedrals(*core.face_angles(found.faces, found.angles, most, count))


def _sizes(
    measured: Measurements, faces: NDArray[np.int32], count: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean length of the edges of each face, and mean target size of them."""
    sides, sizes = measured.mesh.connectivity.half_edges, measured.edge_sizes
    reached = core.face_edge_means(faces, sides, measured.lengths, count)
    if sizes is None:
        return reached, np.zeros(count)
    return reached, core.face_edge_means(faces, sides, sizes.mean, count)
