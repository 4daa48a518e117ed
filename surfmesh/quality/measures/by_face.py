"""The figures of each face: one row a face, in the order of the faces."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfmesh.quality.measures.face_rows import (
    FaceColumns,
    FaceDeviations,
    FaceDihedrals,
    FaceRows,
)
from surfmesh.quality.measures.measurements import Measurements
from surfmesh.quality.measures.tolerances import (
    exceeds_angle,
    exceeds_chord,
)
from surfmesh.result.surface_mesh import SurfaceMesh


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
    count, exact = len(numbers), measured.facts.faces
    alpha_min = np.full(count, np.inf)
    np.fmin.at(alpha_min, faces, shape.alpha)
    size, target = _sizes(mesh, faces, count, measured.lengths)
    limits: dict[int, list[str]] = {}
    for limit in measured.limits:
        limits.setdefault(limit.face, []).append(str(limit))
    return FaceRows(
        FaceColumns(
            mesh=mesh,
            numbers=numbers,
            known=[exact[face] if 0 <= face < len(exact) else None for face in numbers.tolist()],
            triangles=np.bincount(faces, minlength=count),
            area=_sums(faces, shape.area, count),
            alpha_sum=_sums(faces, shape.alpha, count),
            alpha_min=alpha_min,
            size=size,
            target=target,
            fits=_deviations(measured, faces, count),
            dihedrals=_dihedrals(measured, count),
            chords=tolerances.of_each(tolerances.chord, numbers),
            angles=tolerances.of_each(tolerances.angle, numbers),
            limits=limits,
        )
    )


def _deviations(
    measured: Measurements, faces: NDArray[np.integer[Any]], count: int
) -> FaceDeviations | None:
    fit, folds = measured.deviation, measured.folds
    if fit is None or folds is None:
        return None
    largest, worst = np.zeros(count), np.zeros(count, np.intp)
    np.maximum.at(largest, faces, fit.by_triangle)
    at = np.flatnonzero(fit.by_triangle == largest[faces])[::-1]
    worst[faces[at]] = at  # the first of equals
    return FaceDeviations(
        largest,
        worst,
        measured.mesh.points[measured.mesh.triangles[worst]].mean(axis=1),
        square=_sums(faces, measured.shapes.area * fit.mean_square, count),
        above=_sums(faces, exceeds_chord(measured.tolerances, measured.mesh, fit), count),
        folded=_sums(faces, folds.by_mesh, count),
    )


def _dihedrals(measured: Measurements, count: int) -> FaceDihedrals | None:
    found = measured.dihedral_angles
    if found is None:
        return None
    largest = np.zeros(count)
    np.maximum.at(largest, found.faces, found.angles)
    above = _sums(found.faces, exceeds_angle(measured.tolerances, found), count)
    return FaceDihedrals(largest, above, np.bincount(found.faces, minlength=count))


def _sums(faces: NDArray[np.integer[Any]], values: NDArray[Any], count: int) -> NDArray[np.float64]:
    """(f,) of values (k,) on each face."""
    return np.bincount(faces, values, count).astype(np.float64, copy=False)


def _sizes(
    mesh: SurfaceMesh, faces: NDArray[np.integer[Any]], count: int, lengths: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean length of the edges of each face, and mean target size of them."""
    table = mesh.connectivity
    first = faces[table.half_edges[:, 0] // 3]
    second = faces[np.maximum(table.half_edges[:, 1], 0) // 3]
    both = np.flatnonzero((table.half_edges[:, 1] >= 0) & (second != first))
    second = second[both]

    def mean(values: NDArray[np.float64]) -> NDArray[np.float64]:
        total = np.bincount(first, values, count) + np.bincount(second, values[both], count)
        return total / np.maximum(number, 1)

    number = np.bincount(first, minlength=count) + np.bincount(second, minlength=count)
    if mesh.sizes is None:
        return mean(lengths), np.zeros(count)
    a, b = mesh.edges.T
    return mean(lengths), mean((mesh.sizes[a] + mesh.sizes[b]) / 2)
