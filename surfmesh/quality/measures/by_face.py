"""The figures of each face: one row a face, in the order of the faces."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.surface import surface_kind
from surfmesh.quality.measures.by_solid import relative_error
from surfmesh.quality.measures.measurements import Measurements
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
    chord: float | None  # promised of it: the largest distance from the surface
    angle: float | None  # likewise the largest between its triangles, degrees
    limit: str  # a min_size of the user's that forbids one of them, in words; else empty
    deviation_max: float | None
    deviation_rms: float | None
    deviation_triangle: int | None  # where deviation_max is
    deviation_point: tuple[float, float, float] | None  # its centroid
    above_chord_share: float | None  # of its triangles that are farther away than its chord
    angle_max: float | None  # largest between its triangles that share an edge, degrees
    above_angle_share: float | None  # of the edges within it, above its angle
    folded: int | None  # triangles turned more than 60 degrees from the surface
    alpha_mean: float | None  # None where the face has no triangle
    alpha_min: float | None
    size_mean: float | None  # mean edge length that was reached
    size_wanted: float | None  # mean of what was wanted of the same edges


def by_face(measured: Measurements) -> tuple[FaceRow, ...]:
    """Rows of all surfaces, or of the numbers that occur where none is known.

    An edge between two faces counts for both, the row's sizes are means over edges. No row of a
    mesh whose ``face_ids`` are out of range.
    """
    mesh, shape, fit, lengths = (
        measured.mesh, measured.shapes, measured.deviation, measured.lengths,
    )  # fmt: skip
    tolerances, dihedrals, folded = (
        measured.tolerances, measured.dihedral_angles, measured.folds,
    )  # fmt: skip
    if mesh.surfaces:
        numbers, faces = np.arange(len(mesh.surfaces)), mesh.face_ids
        if len(faces) and not 0 <= faces.min() <= faces.max() < len(numbers):
            return ()
    else:
        numbers, faces = np.unique(mesh.face_ids, return_inverse=True)
    count = len(numbers)
    triangles = np.bincount(faces, minlength=count)
    area = np.bincount(faces, shape.area, count)
    alpha_sum, alpha_min = np.bincount(faces, shape.alpha, count), np.full(count, np.inf)
    np.fmin.at(alpha_min, faces, shape.alpha)
    size, wanted = _sizes(mesh, faces, count, lengths)
    largest = np.zeros(count)
    square, above, turned = np.zeros(count), np.zeros(count), np.zeros(count)
    worst = np.zeros(count, np.int64)
    if fit is not None:
        np.maximum.at(largest, faces, fit.by_triangle)
        at = np.flatnonzero(fit.by_triangle == largest[faces])[::-1]
        worst[faces[at]] = at  # the first of equals
        square = np.bincount(faces, shape.area * fit.mean_square, count)
        turned = np.bincount(faces, folded.ours, count)
        above = np.bincount(faces, exceeds_chord(tolerances, mesh, fit), count)
    turn, bent, inner = np.zeros(count), np.zeros(count), np.zeros(count, np.int64)
    if dihedrals is not None:
        np.maximum.at(turn, dihedrals.faces, dihedrals.angles)
        inner = np.bincount(dihedrals.faces, minlength=count)
        bent = np.bincount(dihedrals.faces, exceeds_angle(tolerances, dihedrals), count)
    exact = mesh.facts.faces if mesh.facts is not None else ()
    rows = []
    for k, face in enumerate(numbers.tolist()):
        here = int(triangles[k])
        known = fit is not None and here > 0
        surface = mesh.surfaces[face] if mesh.surfaces else None
        place = mesh.points[mesh.triangles[worst[k]]].mean(axis=0) if known else ()
        chord = tolerances.one(tolerances.chord, face)
        angle = tolerances.one(tolerances.angle, face)
        exact_area = exact[face].area if 0 <= face < len(exact) else None
        rms = float(square[k] / area[k]) ** 0.5 if known and area[k] > 0 else None
        rows.append(
            FaceRow(
                face=face,
                name=mesh.face_name(face),
                kind=exact[face].kind if 0 <= face < len(exact) else surface_kind(surface),
                triangles=here,
                area=float(area[k]),
                area_exact=exact_area,
                area_error=relative_error(float(area[k]), exact_area) if here else None,
                chord=chord,
                angle=angle,
                limit="; ".join(str(limit) for limit in measured.limits if limit.face == face),
                deviation_max=float(largest[k]) if known else None,
                deviation_rms=rms,
                deviation_triangle=int(worst[k]) if known else None,
                deviation_point=tuple(map(float, place)) if known else None,
                above_chord_share=float(above[k] / here) if known and chord else None,
                angle_max=float(turn[k]) if inner[k] else None,
                above_angle_share=float(bent[k] / inner[k]) if inner[k] and angle else None,
                folded=int(turned[k]) if known else None,
                alpha_mean=float(alpha_sum[k] / here) if here else None,
                alpha_min=float(alpha_min[k]) if here else None,
                size_mean=float(size[k]) if here else None,
                size_wanted=float(wanted[k]) if here and mesh.sizes is not None else None,
            )
        )
    return tuple(rows)


def _sizes(
    mesh: SurfaceMesh, faces: NDArray, count: int, lengths: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean length of the edges of each face, and mean of what was wanted of them."""
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
