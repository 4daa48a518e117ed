"""The figures of each face: one row a face, in the order of the faces."""

import numpy as np
from numpy.typing import NDArray

from surfmesh.quality.measures.face_rows import (
    FaceColumns,
    FaceDeviations,
    FaceDihedrals,
    FaceRows,
)
from surfmesh.quality.measures.measurements import Measurements
from surfmesh.quality.measures.places import middles
from surfmesh.quality.measures.tolerances import exceeds_angle


def by_face(measured: Measurements) -> FaceRows:
    """Rows of all surfaces, or of the numbers that occur where none is known.

    An edge between two faces counts for both, the row's sizes are means over edges. No row of a
    mesh whose ``face_ids`` are out of range.
    """
    mesh, shape, tolerances = measured.mesh, measured.shapes, measured.tolerances
    numbers, rows = measured.faces
    count = len(numbers)
    if not count:
        return FaceRows()
    triangles, area, alpha_sum, alpha_min = measured.joined.face_shapes(shape.area, shape.alpha)
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
            size=measured.edges.face_lengths,
            target=measured.edges.face_sizes,
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
    largest, worst, square, above = measured.joined.face_distances(
        fit.by_triangle, fit.mean_square, measured.shapes.area, far.view(np.uint8)
    )
    return FaceDeviations(
        largest,
        worst,
        middles(measured.mesh.points[measured.mesh.triangles[worst]]),
        square=square,
        above=above,
        folded=np.bincount(faces[folds.by_mesh] if folds.found else faces[:0], minlength=count),
    )


def _dihedrals(measured: Measurements, count: int) -> FaceDihedrals | None:
    found = measured.dihedral_angles
    if found is None:
        return None
    above = found.faces[exceeds_angle(measured.tolerances, found)]
    return FaceDihedrals(found.largest, np.bincount(above, minlength=count), found.number)
