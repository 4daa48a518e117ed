"""What was asked for of each face, where it does not hold, and where a ``min_size`` forbids it.

farther than the chord of its face ----> could smaller triangles hold it, of min_size at least?
                                           yes: a violation, the mesh is not clean
                                           no:  an unattainable tolerance, a warning
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.quality.measures.dihedral import DihedralAngles
from surfmesh.quality.measures.known_surfaces import Rows
from surfmesh.quality.measures.places import Point, as_point, face_in_words
from surfmesh.result.surface_mesh import SurfaceMesh

CHORD_SLACK = 1e-9  # relative: rounding in the distance itself

CHORD_STEP, ANGLE_STEP = 0.75, 0.8
"""Of the size there: rounds ask for 0.8 and 0.85 of it at most (``size_requests.cpp``); within a
triangle sizes vary."""

WELL_ABOVE = 8.0
"""Times ``min_size``, and ``anisotropy``: sides of triangles of that size are shorter. The longest
that was seen is 2.6 times as long, and 5.1 times where ``simplify`` had moved its ends."""

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
    point: Point  # where it is largest

    def __str__(self) -> str:
        return limits_in_words([self])

    @property
    def called(self) -> str:
        """ "face 3 (top)" """
        return face_in_words(self.face, self.name)


def limits_in_words(group: Sequence[UnattainableTolerance]) -> str:
    """One line about faces that one ``min_size`` keeps from one tolerance."""
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
    """Triangles or edges beyond a tolerance that sizes would have allowed to keep."""

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
        given = tolerance_rows(mesh)
        if given is None or not len(given) or 1 < len(given) < _faces(mesh):
            given = np.full((1, 3), np.nan)
        chord, angle = (np.where(np.isnan(given[:, k]), np.inf, given[:, k]) for k in (0, 1))
        least = np.where(np.isnan(given[:, 2]), 0.0, given[:, 2])
        uniform = bool((chord == chord[0]).all() and (angle == angle[0]).all())
        return cls(chord, angle, least, uniform)

    def at(self, values: NDArray[np.float64], faces: NDArray) -> NDArray[np.float64]:
        """``chord``, ``angle`` or ``min_size`` at triangles or edges of these faces."""
        if len(values) == 1:
            return np.broadcast_to(values, len(faces))
        return values[np.clip(faces, 0, len(values) - 1)]

    def one(self, values: NDArray[np.float64], face: int) -> float | None:
        """Of one face; None where nothing is asked for."""
        asked = float(values[min(max(face, 0), len(values) - 1)])
        return asked if 0.0 < asked < np.inf else None

    @property
    def base_chord(self) -> float | None:
        """Where it is the same on every face."""
        return float(self.chord[0]) if self.uniform and np.isfinite(self.chord[0]) else None

    @property
    def base_angle(self) -> float | None:
        """Likewise, degrees."""
        return float(self.angle[0]) if self.uniform and np.isfinite(self.angle[0]) else None


def _faces(mesh: SurfaceMesh) -> int:
    """How many there are, by their numbers."""
    return max(int(mesh.face_ids.max(initial=0)) + 1, len(mesh.surfaces), 1)


def exceeds_chord(
    tolerances: Tolerances, mesh: SurfaceMesh, by_triangle: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """(m,) which triangles lie farther from the surface than their face allows."""
    chord = tolerances.at(tolerances.chord, mesh.face_ids)
    return by_triangle > chord * (1.0 + CHORD_SLACK)


def exceeds_angle(tolerances: Tolerances, dihedrals: DihedralAngles) -> NDArray[np.bool_]:
    """(k,) across which of ``dihedrals.edges`` the angle is larger than their face allows."""
    return dihedrals.above(tolerances.at(tolerances.angle, dihedrals.faces))


class ToleranceCheck(NamedTuple):
    """What does not keep to a tolerance: by the mesher's fault, and by the user's ``min_size``."""

    violation: Violation | None
    limits: tuple[UnattainableTolerance, ...]


class _Excess(NamedTuple):
    """Triangles or edges beyond a tolerance."""

    option: str  # "chord" or "angle"
    rows: NDArray[np.intp]  # (k,) their numbers
    faces: NDArray[np.int32]  # (k,)
    reached: NDArray[np.float64]  # (k,)
    asked: NDArray[np.float64]  # (k,)
    size: NDArray[np.float64]  # (k,) target size there; infinite: not known
    factor: NDArray[np.float64]  # (k,) of it, that would keep to the tolerance and be asked for
    longest: NDArray[np.float64]  # (k,) sides of the triangles
    points: NDArray[np.float64]  # (k, 3)
    by_face: NDArray[np.integer[Any]]  # (f,) how many triangles or edges there are in all
    total: int


def chord_check(
    tolerances: Tolerances, mesh: SurfaceMesh, by_triangle: NDArray[np.float64]
) -> ToleranceCheck:
    """Of the deviation (m,), which grows with the square of the size."""
    chord = tolerances.at(tolerances.chord, mesh.face_ids)
    far = np.flatnonzero(exceeds_chord(tolerances, mesh, by_triangle))
    if not len(far):
        return ToleranceCheck(None, ())
    points = mesh.points[mesh.triangles[far]].mean(axis=1)
    by_face = np.bincount(np.maximum(mesh.face_ids, 0))
    excess = _Excess(
        "chord", far, mesh.face_ids[far], by_triangle[far], chord[far],
        *_chord_sizes(mesh, far, by_triangle[far], chord[far]), points, by_face,
        len(mesh.triangles),
    )  # fmt: skip
    return _split(tolerances, mesh, excess)


def chord_forbidden(
    tolerances: Tolerances, mesh: SurfaceMesh, by_triangle: NDArray[np.float64]
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """(m,) at which triangles ``min_size`` leaves no room for smaller sizes; and which of them lie
    beyond the chord of their face, seen that they deviate by so much (m,)."""
    least = tolerances.at(tolerances.min_size, mesh.face_ids)
    if not least.any():
        none = np.zeros(len(by_triangle), bool)
        return none, none
    chord = tolerances.at(tolerances.chord, mesh.face_ids)
    sizes = _chord_sizes(mesh, np.arange(len(by_triangle)), chord, chord)
    bound = np.isfinite(chord) & _forbidden(mesh, least, *sizes)
    return bound, bound & exceeds_chord(tolerances, mesh, by_triangle)


def angle_check(
    tolerances: Tolerances, mesh: SurfaceMesh, dihedrals: DihedralAngles
) -> ToleranceCheck:
    """Of the dihedral angles, which grow with the size; the worst is a row of ``dihedrals``."""
    far = np.flatnonzero(exceeds_angle(tolerances, dihedrals))
    if not len(far):
        return ToleranceCheck(None, ())
    faces, reached = dihedrals.faces[far], dihedrals.angles[far]
    angle = tolerances.at(tolerances.angle, faces)
    ends = mesh.edges[dihedrals.edges[far]]
    size, points = _sizes(mesh, ends), mesh.points[ends].mean(axis=1)
    beside = mesh.connectivity.half_edges[dihedrals.edges[far]] // 3
    longest = np.maximum(*(_longest(mesh, triangles) for triangles in beside.T))
    by_face, total = dihedrals.number, int(dihedrals.number.sum())
    factor = np.minimum(angle / reached, ANGLE_STEP)
    excess = _Excess(
        "angle", far, faces, reached, angle, size, factor, longest, points, by_face, total
    )
    return _split(tolerances, mesh, excess)


def _chord_sizes(
    mesh: SurfaceMesh, triangles: Rows, deviation: NDArray, chord: NDArray
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Target sizes (k,), their factors (k,) that would keep to the chord, longest sides (k,)."""
    with np.errstate(invalid="ignore"):
        factor = np.minimum(np.sqrt(chord / deviation), CHORD_STEP)
    return _sizes(mesh, mesh.triangles[triangles]), factor, _longest(mesh, triangles)


def _longest(mesh: SurfaceMesh, triangles: Rows) -> NDArray[np.float64]:
    """(k,) longest sides of triangles."""
    corners = mesh.points[mesh.triangles[triangles]]
    return np.linalg.norm(corners - corners[:, [1, 2, 0]], axis=2).max(axis=1)


def _sizes(mesh: SurfaceMesh, corners: NDArray[np.int32]) -> NDArray[np.float64]:
    """(k,) mean target sizes at vertices (k, j); infinite where they are not known."""
    if mesh.sizes is None:
        return np.full(len(corners), np.inf)
    return mesh.sizes[corners].mean(axis=1)


def _forbidden(
    mesh: SurfaceMesh, least: NDArray, size: NDArray, factor: NDArray, longest: NDArray
) -> NDArray[np.bool_]:
    """(k,) does ``least`` forbid the factor on the size? Not where triangles are much larger than
    that: they are far for another reason."""
    ratio = np.inf if mesh.sizing is None else mesh.sizing.anisotropy or 1.0
    return (size * factor < least) & (longest <= WELL_ABOVE * ratio * least)


def _split(tolerances: Tolerances, mesh: SurfaceMesh, excess: _Excess) -> ToleranceCheck:
    """Those that smaller triangles would mend, and those where ``min_size`` forbids them."""
    least = tolerances.at(tolerances.min_size, excess.faces)
    forbidden = _forbidden(mesh, least, excess.size, excess.factor, excess.longest)
    violation = None
    free = np.flatnonzero(~forbidden)
    if len(free):
        with np.errstate(invalid="ignore"):
            ratio = excess.reached[free] / excess.asked[free]
        worst = free[int(np.argmax(np.nan_to_num(ratio, nan=np.inf)))]
        violation = Violation(
            fraction=len(free) / excess.total,
            worst=int(excess.rows[worst]),
            reached=float(excess.reached[worst]),
            asked=float(excess.asked[worst]),
        )
    limits = []
    for face in np.unique(excess.faces[forbidden]).tolist():
        here = np.flatnonzero(forbidden & (excess.faces == face))
        top = here[int(np.argmax(excess.reached[here]))]
        limits.append(
            UnattainableTolerance(
                face=face,
                name=mesh.face_name(face),
                option=excess.option,
                asked=float(excess.asked[top]),
                reached=float(excess.reached[top]),
                min_size=float(least[top]),
                share=len(here) / max(int(excess.by_face[max(face, 0)]), 1),
                point=as_point(excess.points[top]),
            )
        )
    return ToleranceCheck(violation, tuple(limits))
