"""Solids and faces that have not the volume or area of the model.

What the deviation explains is allowed, and by how much the exact figures may be wrong.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from surfmesh.geometry.surface import surface_kind
from surfmesh.quality.measures.area_and_volume import explained_volume
from surfmesh.quality.measures.face_rows import FaceRows
from surfmesh.quality.measures.measurements import Measurements
from surfmesh.quality.measures.places import face_in_words, more_in_words
from surfmesh.quality.measures.solids import bounds_solid
from surfmesh.quality.verdict.connectivity import solid_in_words
from surfmesh.quality.verdict.finding import Kind, Problem, Remark
from surfmesh.result.surface_mesh import SurfaceMesh

INEXACT = {"plane": 1e-3, "cylinder": 1e-3, "cone": 1e-3, "sphere": 1e-3, "torus": 1e-3}
OTHERWISE = 0.02  # relative errors of exact figures by the kind of a face
LEAST_INEXACT = min(INEXACT.values())
NEARLY = 1e-6  # relative: what is looked at closely before it is judged
LEAST = 1e-6  # of the area of all: what a face may miss unsaid


@dataclass(frozen=True, kw_only=True)
class VolumeUnexplained(Problem):
    """A solid that has lost or won volume."""

    kind: Kind = Kind.VOLUME
    solid: int
    name: str
    found: float
    exact: float
    error: float  # found / exact - 1
    explained: float  # of that
    more: str  # how many other solids there are

    @property
    def text(self) -> str:
        """Which, and how much."""
        return (
            f"{solid_in_words(self.solid, self.name)} has the volume {self.found:.6g}, "
            f"{100 * self.error:+.3g} % of the model's {self.exact:.6g}: distances from the "
            f"surface explain {100 * self.explained:.2g} %{self.more}"
        )


@dataclass(frozen=True, kw_only=True)
class AreaUnexplained(Problem):
    """A face, or the whole surface, that has lost or won area."""

    kind: Kind = Kind.AREA
    face: str  # by number and name; empty: the whole
    found: float
    exact: float
    explained: float
    more: str  # how many other faces there are

    @property
    def text(self) -> str:
        """Which, and how much."""
        if not self.face:
            return (
                f"the area is {self.found:.6g}, of the surface {self.exact:.6g}: distances from it "
                f"and along its rims explain {self.explained:.2g} of the difference"
            )
        return (
            f"{self.face} has the area {self.found:.6g}, in the model {self.exact:.6g}: distances "
            f"from the surface and its rims explain {self.explained:.2g} of it{self.more}"
        )


@dataclass(frozen=True, kw_only=True)
class VolumeExceeded(Problem):
    """A solid whose volume is farther off than ``Sizing(volume=)`` allows."""

    kind: Kind = Kind.VOLUME
    solid: int
    name: str
    error: float  # relative
    asked: float

    @property
    def text(self) -> str:
        """Which, and by how much."""
        return (
            f"the volume of {solid_in_words(self.solid, self.name)} is {self.error:.3g} off, "
            f"{self.asked:g} was asked for"
        )


@dataclass(frozen=True, kw_only=True)
class MinSizeForbidsVolume(Remark):
    """The same where a ``min_size`` of the user's forbids it."""

    kind: Kind = Kind.MIN_SIZE
    solid: int
    name: str
    error: float
    asked: float
    min_size: float

    @property
    def text(self) -> str:
        """Which, and by how much."""
        return (
            f"min_size {self.min_size:g} keeps {solid_in_words(self.solid, self.name)} from the "
            f"volume {self.asked:g}: it is {self.error:.3g} off"
        )


def unexplained(measured: Measurements, faces: FaceRows) -> Iterator[Problem]:
    """Volumes of solids, and areas of faces, or of the whole where those are not known.

    What distances explain is asked for only where more is lost than exact figures may be wrong by.
    """
    if measured.has_exact_figures:
        yield from _volumes(measured)
        yield from _areas(measured, faces)


def _volumes(measured: Measurements) -> Iterator[Problem]:
    mesh, kinds = measured.mesh, measured.facts.faces
    bad: list[tuple[float, VolumeUnexplained]] = []
    for row in measured.solids:
        if row.volume is None or row.volume_exact is None or row.volume_error is None:
            continue
        if abs(row.volume_error) <= LEAST_INEXACT or measured.deviation is None:
            continue  # whatever its faces are
        own, by_triangle = bounds_solid(mesh, row.solid), measured.deviation.by_triangle
        allowed = explained_volume(measured.shapes.area, by_triangle, own) / row.volume_exact
        if abs(row.volume_error) <= allowed + LEAST_INEXACT:
            continue
        inexact = [
            _inexact(kinds[face].kind if face < len(kinds) else "")
            for face in np.flatnonzero(np.bincount(mesh.face_ids[own])).tolist()
        ]
        if abs(row.volume_error) > allowed + max(inexact):
            problem = VolumeUnexplained(
                solid=row.solid, name=row.name, found=row.volume, exact=row.volume_exact,
                error=row.volume_error, explained=allowed, more="",
            )  # fmt: skip
            bad.append((abs(row.volume_error) - allowed, problem))
    if bad:
        _, worst = max(bad, key=lambda one: one[0])
        yield replace(worst, more=more_in_words(bad, "; so have {} more"))


def _areas(measured: Measurements, faces: FaceRows) -> Iterator[Problem]:
    area_exact = faces.area_exact
    known = np.flatnonzero(np.isfinite(area_exact))
    if not len(known):
        yield from _whole_area(measured, faces)
        return
    least = LEAST * sum(area_exact[known].tolist())
    errors = np.abs(faces.area - area_exact)
    inexact = LEAST_INEXACT * area_exact + least
    suspects = known[errors[known] > (1.0 - NEARLY) * inexact[known]]
    if not len(suspects) or measured.explained_areas is None:
        return
    allowed = measured.explained_areas
    near = (1.0 - NEARLY) * (allowed[faces.numbers[suspects]] + inexact[suspects])
    bad: list[tuple[float, AreaUnexplained]] = []
    for k in suspects[errors[suspects] > near].tolist():
        row, exact = faces[k], float(area_exact[k])
        error, explained = abs(row.area - exact), float(allowed[row.face])
        if error > explained + _inexact(row.kind) * exact + least:
            called = face_in_words(row.face, row.name)
            problem = AreaUnexplained(
                face=called, found=row.area, exact=exact, explained=explained, more=""
            )
            bad.append((error - explained, problem))
    if bad:
        _, worst = max(bad, key=lambda one: one[0])
        yield replace(worst, more=more_in_words(bad, "; {} more have not that of the model"))


def _whole_area(measured: Measurements, faces: FaceRows) -> Iterator[Problem]:
    exact = measured.facts.area
    if not exact or not faces:
        return
    area, inexact = sum(faces.area.tolist()), INEXACT["plane"] * exact
    if abs(area - exact) <= inexact or measured.explained_areas is None:
        return
    allowed = float(measured.explained_areas.sum())
    if abs(area - exact) > allowed + inexact:
        yield AreaUnexplained(face="", found=area, exact=exact, explained=allowed, more="")


def _inexact(kind: str) -> float:
    return INEXACT.get(kind, OTHERWISE)


def volumes_exceeded(measured: Measurements) -> Iterator[VolumeExceeded | MinSizeForbidsVolume]:
    """Solids whose volume is farther off than was asked for.

    The error grows with the square of the size: where sizes that keep to it are below
    ``min_size`` the user forbids it.
    """
    mesh = measured.mesh
    asked = None if mesh.sizing is None else mesh.sizing.volume
    if mesh.sizing is None or asked is None:
        return
    least = mesh.sizing.min_size or 0.0
    for row in measured.solids:
        if row.volume is None or not row.volume_exact:
            continue
        error = abs(row.volume / row.volume_exact - 1.0)
        if error <= asked:
            continue
        if _curved_size(mesh, row.solid) * np.sqrt(asked / error) < least:
            yield MinSizeForbidsVolume(
                solid=row.solid, name=row.name, error=error, asked=asked, min_size=least
            )
        else:
            yield VolumeExceeded(solid=row.solid, name=row.name, error=error, asked=asked)


def _curved_size(mesh: SurfaceMesh, solid: int) -> float:
    """Mean target size on the curved faces of a solid; infinite where nothing is known."""
    if mesh.sizes is None or mesh.solid_ids is None or not mesh.surfaces:
        return np.inf
    curved = np.array([surface_kind(surface) != "plane" for surface in mesh.surfaces])
    of = bounds_solid(mesh, solid) & curved[mesh.face_ids]
    return float(mesh.sizes[mesh.triangles[of]].mean()) if of.any() else np.inf
