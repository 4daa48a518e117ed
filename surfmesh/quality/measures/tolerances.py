"""What was promised of each face, where it does not hold, and where a ``min_size`` forbids it.

farther than the chord of its face ----> could smaller triangles hold it, of min_size at least?
                                           yes: a broken promise, the mesh is not clean
                                           no:  a limit that the user stated, a warning
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.quality.measures.deviation import Deviation
from surfmesh.quality.measures.dihedral import DihedralAngles
from surfmesh.result.surface_mesh import SurfaceMesh

CHORD_SLACK = 1e-9  # relative: rounding in the distance itself

SHOWN = 8  # faces that are named in one line


@dataclass(frozen=True)
class UnattainableTolerance:
    """A ``min_size`` that keeps a face from what was asked for; as text one line."""

    face: int
    name: str
    option: str  # "chord", or "angle" in degrees
    asked: float
    reached: float  # the largest on the face
    min_size: float
    share: float  # of its triangles, or its inner edges, that are beyond
    point: tuple[float, float, float]  # where it is largest

    def __str__(self) -> str:
        return _said([self])

    @property
    def called(self) -> str:
        """ "face 3 (top)" """
        plain = f"face {self.face}"
        return plain if self.name in ("", plain) else f"{plain} ({self.name})"


def stated(limits: Sequence[UnattainableTolerance]) -> list[str]:
    """One line for each ``min_size`` and what it forbids, however many faces have it."""
    groups: dict[tuple[str, float, float], list[UnattainableTolerance]] = {}
    for limit in limits:
        groups.setdefault((limit.option, limit.asked, limit.min_size), []).append(limit)
    return [_said(group) for group in groups.values()]


def _said(group: Sequence[UnattainableTolerance]) -> str:
    worst = max(group, key=lambda limit: limit.reached)
    who, most, there = worst.called, "", ""
    if len(group) > 1:
        more = len(group) - SHOWN
        who = ", ".join(str(limit.face) for limit in group[:SHOWN])
        who = f"faces {who}" + (f" and {more} more" if more > 0 else "")
        most, there = "up to ", f", on {worst.called}"
    head = f"min_size {worst.min_size:g} keeps {who} from the {worst.option} {worst.asked:g}"
    if worst.option == "chord":
        return f"{head}: {most}{worst.reached:.3g} away{there}"
    return f"{head}°: neighbours turn by {most}{worst.reached:.3g}°{there}"


class Violation(NamedTuple):
    """Triangles or edges beyond a promise that sizes would have allowed to keep."""

    fraction: float  # of all
    worst: int  # the one that is farthest beyond, by ratio
    reached: float
    asked: float


def tolerance_rows(mesh: SurfaceMesh) -> NDArray[np.float64] | None:
    """(f, 3), or (1, 3) for all faces: chord, angle and min_size, nan for none. None: nothing
    is known of them."""
    if mesh.promises is not None or mesh.sizing is None:
        return mesh.promises
    asked = (mesh.sizing.chord, mesh.sizing.angle, mesh.sizing.min_size)
    return np.array([[np.nan if value is None else value for value in asked]], float)


class Tolerances(NamedTuple):
    """By face number: infinite, or 0 for ``min_size``, where nothing is asked for."""

    chord: NDArray[np.float64]
    angle: NDArray[np.float64]
    min_size: NDArray[np.float64]
    uniform: bool  # the same on every face

    @classmethod
    def of(cls, mesh: SurfaceMesh) -> Tolerances:
        """Of the mesh's ``promises``, or of its ``sizing`` on every face."""
        count = max(int(mesh.face_ids.max(initial=0)) + 1, len(mesh.surfaces), 1)
        given = tolerance_rows(mesh)
        if given is None or 1 < len(given) < count or not len(given):
            given = np.full((1, 3), np.nan)
        chord, angle = (np.where(np.isnan(given[:, k]), np.inf, given[:, k]) for k in (0, 1))
        least = np.nan_to_num(given[:, 2], nan=0.0)
        uniform = bool((chord == chord[0]).all() and (angle == angle[0]).all())
        return cls(chord, angle, least, uniform)

    def at(self, values: NDArray[np.float64], faces: NDArray) -> NDArray[np.float64]:
        """``chord``, ``angle`` or ``min_size`` at triangles or edges of these faces."""
        if len(values) == 1:
            return np.broadcast_to(values, len(faces))
        return values[np.clip(faces, 0, len(values) - 1)]

    def one(self, values: NDArray[np.float64], face: int) -> float | None:
        """Of one face; None where nothing is asked for."""
        value = float(self.at(values, np.array([face]))[0])
        return value if 0.0 < value < np.inf else None

    @property
    def base_chord(self) -> float | None:
        """Where it is the same on every face."""
        return float(self.chord[0]) if self.uniform and np.isfinite(self.chord[0]) else None

    @property
    def base_angle(self) -> float | None:
        """Likewise, degrees."""
        return float(self.angle[0]) if self.uniform and np.isfinite(self.angle[0]) else None


def exceeds_chord(tolerances: Tolerances, mesh: SurfaceMesh, fit: Deviation) -> NDArray[np.bool_]:
    """(m,) which triangles lie farther from the surface than their face allows."""
    chord = tolerances.at(tolerances.chord, mesh.face_ids)
    return fit.by_triangle > chord * (1.0 + CHORD_SLACK)


def exceeds_angle(tolerances: Tolerances, dihedrals: DihedralAngles) -> NDArray[np.bool_]:
    """(k,) across which edges the dihedral angle is larger than their face allows."""
    return dihedrals.above(tolerances.at(tolerances.angle, dihedrals.faces))


def chord_violation(
    tolerances: Tolerances, mesh: SurfaceMesh, fit: Deviation
) -> tuple[Violation | None, list[UnattainableTolerance]]:
    """Broken promises of the distance from the surface, and those that ``min_size`` forbids.

    Deviation grows with the square of the size.
    """
    far = np.flatnonzero(exceeds_chord(tolerances, mesh, fit))
    if not len(far):
        return None, []
    faces, reached = mesh.face_ids[far], fit.by_triangle[far]
    chord = tolerances.at(tolerances.chord, faces)
    needed = np.full(len(far), np.inf)
    if mesh.sizes is not None:
        with np.errstate(invalid="ignore"):
            needed = mesh.sizes[mesh.triangles[far]].mean(axis=1) * np.sqrt(chord / reached)
    points = mesh.points[mesh.triangles[far]].mean(axis=1)
    count = np.bincount(np.maximum(mesh.face_ids, 0))
    return _split(
        "chord", tolerances, mesh, far, faces, reached, chord, needed, points, count,
        len(mesh.triangles),
    )  # fmt: skip


def angle_violation(
    tolerances: Tolerances, mesh: SurfaceMesh, dihedrals: DihedralAngles
) -> tuple[Violation | None, list[UnattainableTolerance]]:
    """The same for the angle between neighbours, which grows with the size.

    ``worst`` is a row of ``dihedrals``.
    """
    far = np.flatnonzero(exceeds_angle(tolerances, dihedrals))
    if not len(far):
        return None, []
    faces, reached = dihedrals.faces[far], dihedrals.angles[far]
    angle = tolerances.at(tolerances.angle, faces)
    ends = mesh.edges[dihedrals.edges[far]]
    needed = np.full(len(far), np.inf)
    if mesh.sizes is not None:
        needed = mesh.sizes[ends].mean(axis=1) * angle / reached
    points = mesh.points[ends].mean(axis=1)
    return _split(
        "angle", tolerances, mesh, far, faces, reached, angle, needed, points,
        np.bincount(dihedrals.faces), len(dihedrals.angles),
    )  # fmt: skip


def _split(
    option: str, tolerances: Tolerances, mesh: SurfaceMesh, far: NDArray, faces: NDArray,
    reached: NDArray, asked: NDArray, needed: NDArray, points: NDArray, count: NDArray, total: int,
) -> tuple[Violation | None, list[UnattainableTolerance]]:  # fmt: skip
    """far: (k,) numbers of what is beyond; count: how many there are on each face."""
    least = tolerances.at(tolerances.min_size, faces)
    forbidden = needed < least
    broken, limits = None, []
    free = np.flatnonzero(~forbidden)
    if len(free):
        with np.errstate(invalid="ignore"):
            worst = free[int(np.argmax(np.nan_to_num(reached[free] / asked[free], nan=np.inf)))]
        broken = Violation(
            len(free) / total, int(far[worst]), float(reached[worst]), float(asked[worst])
        )
    for face in np.unique(faces[forbidden]).tolist():
        here = np.flatnonzero(forbidden & (faces == face))
        top = here[int(np.argmax(reached[here]))]
        limits.append(
            UnattainableTolerance(
                face=face,
                name=mesh.face_name(face),
                option=option,
                asked=float(asked[top]),
                reached=float(reached[top]),
                min_size=float(least[top]),
                share=len(here) / max(int(count[max(face, 0)]), 1),
                point=tuple(points[top].tolist()),
            )
        )
    return broken, limits
