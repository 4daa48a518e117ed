"""The figures of each face: one row a face, in the order of the faces."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.surface import surface_kind
from surfmesh.quality.measures.by_solid import relative_error
from surfmesh.quality.measures.measurements import Measurements
from surfmesh.quality.measures.places import Point
from surfmesh.quality.measures.tolerances import (
    exceeds_angle,
    exceeds_chord,
)
from surfmesh.result.surface_mesh import SurfaceMesh


@dataclass(frozen=True, kw_only=True)
class FaceRow:
    """Lengths and areas in model units. None: not known."""

    face: int
    name: str
    kind: str  # plane, cylinder, ...; empty when it is none of those
    triangles: int
    area: float
    area_exact: float | None
    area_error: float | None  # area / area_exact - 1
    chord: float | None  # asked for: the largest distance from the surface
    angle: float | None  # likewise the largest between its triangles, degrees
    limit: str  # a min_size of the user's that forbids one of them, in words; else empty
    deviation_max: float | None
    deviation_rms: float | None
    deviation_triangle: int | None  # where deviation_max is
    deviation_point: Point | None  # its centroid
    above_chord_share: float | None  # of its triangles that are farther away than its chord
    angle_max: float | None  # largest between its triangles that share an edge, degrees
    above_angle_share: float | None  # of the edges within it, above its angle
    folded: int | None  # triangles turned more than 60 degrees from the surface
    alpha_mean: float | None  # None where the face has no triangle
    alpha_min: float | None
    size_mean: float | None  # mean edge length that was reached
    size_wanted: float | None  # mean target size of the same edges


class _Deviations(NamedTuple):
    """By face (f,)."""

    largest: NDArray[np.float64]
    worst: NDArray[np.intp]  # the triangle where that is
    places: list[Point]  # the centroids of these
    square: NDArray[np.float64]  # mean square times area
    above: NDArray[np.float64]  # triangles farther away than the chord
    folded: NDArray[np.float64]  # triangles


class _Dihedrals(NamedTuple):
    """By face (f,)."""

    largest: NDArray[np.float64]
    above: NDArray[np.float64]  # edges
    edges: NDArray[np.intp]  # within the face


def by_face(measured: Measurements) -> tuple[FaceRow, ...]:
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
        return ()
    count = len(numbers)
    triangles, area = np.bincount(faces, minlength=count), np.bincount(faces, shape.area, count)
    alpha_sum, alpha_min = np.bincount(faces, shape.alpha, count), np.full(count, np.inf)
    np.fmin.at(alpha_min, faces, shape.alpha)
    size, target = _sizes(mesh, faces, count, measured.lengths)
    fits, dihedrals = _deviations(measured, faces, count), _dihedrals(measured, count)
    exact = measured.facts.faces
    chords = tolerances.of_each(tolerances.chord, numbers)
    angles = tolerances.of_each(tolerances.angle, numbers)
    limits: dict[int, list[str]] = {}
    for limit in measured.limits:
        limits.setdefault(limit.face, []).append(str(limit))
    rows = []
    for k, face in enumerate(numbers.tolist()):
        here, known = int(triangles[k]), exact[face] if 0 <= face < len(exact) else None
        kind = surface_kind(mesh.surfaces[face]) if mesh.surfaces else ""
        exact_area = None if known is None else known.area
        own_area, chord, angle = float(area[k]), chords[k], angles[k]
        fit = fits if here else None
        rms = (float(fit.square[k]) / own_area) ** 0.5 if fit and own_area > 0 else None
        dihedral = dihedrals if dihedrals is not None and dihedrals.edges[k] else None
        above_angle = (
            float(dihedral.above[k] / dihedral.edges[k]) if dihedral is not None and angle else None
        )
        rows.append(
            FaceRow(
                face=face,
                name=mesh.face_name(face),
                kind=kind if known is None else known.kind,
                triangles=here,
                area=own_area,
                area_exact=exact_area,
                area_error=relative_error(own_area, exact_area) if here else None,
                chord=chord,
                angle=angle,
                limit="; ".join(limits.get(face, ())),
                deviation_max=None if fit is None else float(fit.largest[k]),
                deviation_rms=rms,
                deviation_triangle=None if fit is None else int(fit.worst[k]),
                deviation_point=None if fit is None else fit.places[k],
                above_chord_share=float(fit.above[k] / here) if fit is not None and chord else None,
                angle_max=float(dihedral.largest[k]) if dihedral is not None else None,
                above_angle_share=above_angle,
                folded=None if fit is None else int(fit.folded[k]),
                alpha_mean=float(alpha_sum[k] / here) if here else None,
                alpha_min=float(alpha_min[k]) if here else None,
                size_mean=float(size[k]) if here else None,
                size_wanted=float(target[k]) if here and mesh.sizes is not None else None,
            )
        )
    return tuple(rows)


def _deviations(
    measured: Measurements, faces: NDArray[np.integer[Any]], count: int
) -> _Deviations | None:
    fit, folds = measured.deviation, measured.folds
    if fit is None or folds is None:
        return None
    largest, worst = np.zeros(count), np.zeros(count, np.intp)
    np.maximum.at(largest, faces, fit.by_triangle)
    at = np.flatnonzero(fit.by_triangle == largest[faces])[::-1]
    worst[faces[at]] = at  # the first of equals
    return _Deviations(
        largest,
        worst,
        _middles(measured.mesh, worst),
        square=_sums(faces, measured.shapes.area * fit.mean_square, count),
        above=_sums(faces, exceeds_chord(measured.tolerances, measured.mesh, fit), count),
        folded=_sums(faces, folds.by_mesh, count),
    )


def _dihedrals(measured: Measurements, count: int) -> _Dihedrals | None:
    found = measured.dihedral_angles
    if found is None:
        return None
    largest = np.zeros(count)
    np.maximum.at(largest, found.faces, found.angles)
    above = _sums(found.faces, exceeds_angle(measured.tolerances, found), count)
    return _Dihedrals(largest, above, np.bincount(found.faces, minlength=count))


def _sums(faces: NDArray[np.integer[Any]], values: NDArray[Any], count: int) -> NDArray[np.float64]:
    """(f,) of values (k,) on each face."""
    return np.bincount(faces, values, count).astype(np.float64, copy=False)


def _middles(mesh: SurfaceMesh, triangles: NDArray[np.intp]) -> list[Point]:
    """The centroids of triangles (f,)."""
    x, y, z = mesh.points[mesh.triangles[triangles]].mean(axis=1).T.tolist()
    return list(zip(x, y, z))


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
