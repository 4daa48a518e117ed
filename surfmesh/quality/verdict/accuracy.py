"""Where the mesh does not follow its surfaces as closely as was asked for."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from surfmesh.quality.measures.measurements import Measurements
from surfmesh.quality.measures.places import (
    as_point,
    count_in_words,
    face_in_words,
    place_in_words,
)
from surfmesh.quality.measures.tolerances import (
    UnattainableTolerance,
    Violation,
    limits_in_words,
)
from surfmesh.quality.measures.unseen import UnseenPlace
from surfmesh.quality.verdict.finding import Fault, Kind, Problem, Remark


@dataclass(frozen=True, kw_only=True)
class Exceeded(Problem):
    """A tolerance that does not hold."""

    violation: Violation
    triangles: tuple[int, ...]  # where it is worst
    face: str  # on which that is, where tolerances differ from face to face; else empty

    def _asked(self, unit: str = "") -> str:
        on = f" on {self.face}" * bool(self.face)
        return f"{self.violation.asked:.4g}{unit} was asked for{on}"

    @property
    def _percent(self) -> str:
        return f"{100 * self.violation.fraction:.3g} %"


@dataclass(frozen=True, kw_only=True)
class DeviationExceeded(Exceeded):
    """The mesh lies too far from the surface."""

    kind: Kind = Kind.DEVIATION

    @property
    def text(self) -> str:
        """How far, how often, and where it is worst."""
        return (
            f"the mesh lies up to {self.violation.reached:.4g} from the surface, {self._asked()} "
            f"({self._percent} of the triangles are farther); worst in triangle "
            f"{self.triangles[0]} at {place_in_words(self.place)}"
        )


@dataclass(frozen=True, kw_only=True)
class VerticesOffSurface(Problem):
    """Vertices that do not lie on the surface."""

    kind: Kind = Kind.DEVIATION
    count: int
    vertex: int  # the farthest
    distance: float

    @property
    def text(self) -> str:
        """How many, how far, and where the farthest is."""
        vertices = count_in_words(self.count, "vertex", "vertices")
        return (
            f"{vertices} off the surface, by up to {self.distance:.4g}: vertex {self.vertex} at "
            f"{place_in_words(self.place)}"
        )


@dataclass(frozen=True, kw_only=True)
class SurfaceDeviationExceeded(Exceeded):
    """The surface lies too far from the mesh. The place is known of its farthest point alone."""

    kind: Kind = Kind.SURFACE_DEVIATION
    at_rim: bool

    @property
    def text(self) -> str:
        """How far, how often, and where it is worst."""
        where = "on a rim" if self.at_rim else "between the mesh's samples"
        at = "" if self.place is None else f", {where} at {place_in_words(self.place)}"
        return (
            f"the surface lies up to {self.violation.reached:.4g} from the mesh, {self._asked()} "
            f"({self._percent} of the triangles are farther, one way or the other); worst over "
            f"triangle {self.triangles[0]}{at}"
        )


@dataclass(frozen=True, kw_only=True)
class DihedralAngleExceeded(Exceeded):
    """Neighbouring triangles of a face enclose too large an angle, degrees."""

    kind: Kind = Kind.DIHEDRAL_ANGLE

    @property
    def text(self) -> str:
        """By how much, how often, and where it is worst."""
        first, second = self.triangles
        return (
            f"neighbouring triangles turn by up to {self.violation.reached:.4g}°, "
            f"{self._asked('°')} ({self._percent} of the edges turn more); worst between "
            f"triangles {first} and {second} at {place_in_words(self.place)}"
        )


@dataclass(frozen=True, kw_only=True)
class FeaturesUnseen(Problem):
    """Features narrower than the triangles that are missing, or that nothing excludes."""

    kind: Kind = Kind.BETWEEN_SAMPLES
    found: bool  # else nothing excludes them
    height: float  # how far they lie, or may lie, from the mesh; infinite: no bound
    count: int  # triangles
    first: UnseenPlace | None

    @property
    def text(self) -> str:
        """How high they are, and where the first is."""
        at = ""
        if self.first is not None:
            u, v = self.first.uv
            at = f", first {self.first.triangle} at (u, v) = ({u:.8g}, {v:.8g})"
        where = f"between the samples of {count_in_words(self.count, 'triangle')}{at}"
        if self.found:
            return (
                f"features narrower than the triangles are missing: the surface lies up to "
                f"{self.height:.4g} from the mesh {where}"
            )
        most = "any height" if math.isinf(self.height) else f"a height up to {self.height:.4g}"
        return (
            f"features narrower than the triangles cannot be excluded: the formula's bounds admit "
            f"{most} {where}; lower the sizes there"
        )


@dataclass(frozen=True, kw_only=True)
class DistanceNotProved(Problem):
    """Triangles whose distance is not proved to keep to the chord, as ``proof`` asks."""

    kind: Kind = Kind.PROOF
    count: int
    bound: float  # the largest; infinite where there is none
    triangle: int  # that has it

    @property
    def text(self) -> str:
        """How many, and where the bound is largest."""
        most = f"up to {self.bound:.4g}" if math.isfinite(self.bound) else "no bound"
        return (
            f"the distance of {count_in_words(self.count, 'triangle')} is not proved to keep to "
            f"the chord ({most}); worst triangle {self.triangle} at {place_in_words(self.place)}"
        )


@dataclass(frozen=True, kw_only=True)
class WithoutBounds(Remark):
    """Faces of which nothing can be proved."""

    kind: Kind = Kind.PROOF
    faces: tuple[int, ...]
    name: str  # of the first

    @property
    def text(self) -> str:
        """Which, and why."""
        first = face_in_words(self.faces[0], self.name)
        more = f" and {len(self.faces) - 1} more" if len(self.faces) > 1 else ""
        return (
            f"nothing is proved of {first}{more}: its surface bounds nothing over boxes of (u, v), "
            "as a function of the caller does not; formulas, elementary, spline and swept surfaces "
            "and offsets of these do"
        )


@dataclass(frozen=True, kw_only=True)
class NoSurfaceToProve(Remark):
    """A proof that is asked for of a mesh without surfaces."""

    kind: Kind = Kind.PROOF

    @property
    def text(self) -> str:
        """Why nothing is, and what would help."""
        return "nothing is proved: the mesh carries no surface; name the one of a file beside it"


@dataclass(frozen=True, kw_only=True)
class MinSizeForbids(Remark):
    """A ``min_size`` that keeps faces from what was asked for."""

    kind: Kind = Kind.MIN_SIZE
    limits: tuple[UnattainableTolerance, ...]

    @property
    def text(self) -> str:
        """One line, however many faces there are."""
        return limits_in_words(self.limits)


def deviation_exceeded(measured: Measurements) -> Iterator[Problem]:
    """The mesh from the surface, where that is worse than the other way."""
    fit, violation = measured.deviation, _violation(measured)
    if fit is not None and not math.isfinite(fit.largest):
        yield Fault(kind=Kind.DEVIATION, words="the distance from the surface is not finite")
    elif fit is not None and violation is not None and not _is_of_surface(measured, violation):
        mesh, worst = measured.mesh, violation.worst
        place = fit.point
        if worst != fit.triangle:
            place = as_point(mesh.points[mesh.triangles[worst]].mean(axis=0))
        face = _face(measured, worst)
        yield DeviationExceeded(violation=violation, triangles=(worst,), face=face, place=place)


def vertices_off_surface(measured: Measurements) -> Iterator[Problem]:
    """Vertices that do not lie where their triangles' parameters say."""
    found = measured.off_surface
    if found is None or not len(found.vertices):
        return
    worst = int(np.argmax(found.distance))
    vertex = int(found.vertices[worst])
    yield VerticesOffSurface(
        count=len(found.vertices), vertex=vertex, distance=float(found.distance[worst]),
        place=as_point(measured.mesh.points[vertex]),
    )  # fmt: skip


def surface_deviation_exceeded(measured: Measurements) -> Iterator[Problem]:
    """The surface from the mesh, where that is worse than the other way."""
    back, violation = measured.surface_deviation, _violation(measured)
    if back is not None and violation is not None and _is_of_surface(measured, violation):
        yield SurfaceDeviationExceeded(
            violation=violation,
            triangles=(violation.worst,),
            face=_face(measured, violation.worst),
            place=back.point if back.triangle == violation.worst else None,
            at_rim=back.at_rim,
        )


def _violation(measured: Measurements) -> Violation | None:
    """Of the chord, both ways."""
    return None if measured.chord_check is None else measured.chord_check.violation


def _is_of_surface(measured: Measurements, violation: Violation) -> bool:
    """Is the worst of both ways that of the surface from the mesh?"""
    fit, back = measured.deviation, measured.surface_deviation
    if fit is None or back is None:
        return False
    return bool(back.by_triangle[violation.worst] > fit.by_triangle[violation.worst])


def _face(measured: Measurements, triangle: int) -> str:
    """The face of a triangle by number and name, where tolerances are not those of all faces."""
    if measured.tolerances.uniform:
        return ""
    face = int(measured.mesh.face_ids[triangle])
    return face_in_words(face, measured.mesh.face_name(face))


def angle_exceeded(measured: Measurements) -> Iterator[Problem]:
    """Dihedral angles within faces."""
    dihedrals, check = measured.dihedral_angles, measured.angle_check
    if dihedrals is None or check is None or check.violation is None:
        return
    mesh, edge = measured.mesh, dihedrals.edges[check.violation.worst]
    first, second = (mesh.connectivity.half_edges[edge] // 3).tolist()
    yield DihedralAngleExceeded(
        violation=check.violation,
        triangles=(first, second),
        face=_face(measured, first),
        place=as_point(mesh.points[mesh.edges[edge]].mean(axis=0)),
    )


def features_unseen(measured: Measurements) -> Iterator[Problem]:
    """What was found between the samples, and what cannot be excluded there."""
    if measured.unseen is None:
        return
    seen = measured.unseen.faults
    found = next((place for place in seen.places if place.found), None)
    possible = next((place for place in seen.places if not place.found), None)
    if seen.found and found is not None:
        yield FeaturesUnseen(
            found=True, height=seen.largest, count=seen.found, first=found, place=found.point
        )
    if seen.open:
        yield FeaturesUnseen(
            found=False,
            height=seen.possible,
            count=seen.open,
            first=possible,
            place=None if possible is None else possible.point,
        )


def not_proved(measured: Measurements) -> Iterator[Problem]:
    """Triangles beyond the chord by their bounds; faces without any are remarks of their own."""
    found = measured.proof
    if found is None:
        return
    left = ~found.is_proved & ~np.isin(measured.mesh.face_ids, found.without_bounds)
    if not left.any():
        return
    worst = int(np.flatnonzero(left)[np.argmax(found.bound[left])])
    mesh = measured.mesh
    yield DistanceNotProved(
        count=int(np.count_nonzero(left)), bound=float(found.bound[worst]), triangle=worst,
        place=as_point(mesh.points[mesh.triangles[worst]].mean(axis=0)),
    )  # fmt: skip


def without_bounds(measured: Measurements) -> Iterator[Remark]:
    """Faces of which nothing can be proved, or that there are none."""
    found = measured.proof
    if found is None:
        yield NoSurfaceToProve()
    elif found.without_bounds:
        first = found.without_bounds[0]
        yield WithoutBounds(faces=found.without_bounds, name=measured.mesh.face_name(first))


def min_size_forbids(measured: Measurements) -> Iterator[Remark]:
    """One for each ``min_size`` and what it forbids, however many faces have it."""
    groups: dict[tuple[str, float, float], list[UnattainableTolerance]] = {}
    for limit in measured.limits:
        groups.setdefault((limit.option, limit.asked, limit.min_size), []).append(limit)
    for group in groups.values():
        worst = max(group, key=lambda limit: limit.reached)
        yield MinSizeForbids(limits=tuple(group), place=worst.point)
