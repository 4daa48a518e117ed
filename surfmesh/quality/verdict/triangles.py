"""Triangles without area, and triangles turned far from the surface's normals."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfmesh.quality.measures.folds import Folds
from surfmesh.quality.measures.measurements import Measurements
from surfmesh.quality.measures.narrow import without_area
from surfmesh.quality.measures.places import Point, as_point, count_in_words, place_in_words
from surfmesh.quality.verdict.finding import Kind, Problem, Remark
from surfmesh.result.surface_mesh import SurfaceMesh

LISTED_FACES = 5  # of those that are folded in themselves


@dataclass(frozen=True, kw_only=True)
class FoldCause:
    """What turns triangles: a boundary off the surface, or parameters that are not theirs."""

    what: str
    reached: float
    count: int  # triangles

    def text_among(self, total: int) -> str:
        """ "; 2 of them beside edges that lie up to 0.1 off the surface" """
        many = "" if self.count == total else f"{self.count:,} of them "
        return f"; {many}{self.what.format(self.reached)}"


@dataclass(frozen=True, kw_only=True)
class BadTriangles(Problem):
    """Triangles: how many, and the first."""

    count: int
    triangle: int
    what: str
    causes: tuple[FoldCause, ...] = ()

    @property
    def text(self) -> str:
        """ "2 triangles without area, first 7 at (0, 0, 1)" """
        triangles = count_in_words(self.count, "triangle")
        place = place_in_words(self.place)
        why = "".join(cause.text_among(self.count) for cause in self.causes)
        return f"{triangles} {self.what}, first {self.triangle} at {place}{why}"


@dataclass(frozen=True, kw_only=True)
class FoldedFace:
    """A face that bends sharply or turns over."""

    name: str
    place: Point  # of the triangle that is turned most
    triangles: int


@dataclass(frozen=True, kw_only=True)
class FoldedSurface(Remark):
    """Faces that no triangles can follow, as they bend sharply or turn over."""

    kind: Kind = Kind.FOLDED
    radius: float  # below which they bend
    faces: tuple[FoldedFace, ...]

    @property
    def text(self) -> str:
        """The first of them, and how many more there are."""
        listed = "; ".join(
            f"{face.name} at {place_in_words(face.place)}, {face.triangles:,} triangles"
            for face in self.faces[:LISTED_FACES]
        )
        more = len(self.faces) - LISTED_FACES
        return (
            f"folded in themselves, with radii below {self.radius:.3g} that no triangle follows: "
            f"{listed}" + (f" and {more} more" if more > 0 else "")
        )


def bad_triangles(measured: Measurements) -> Iterator[Problem]:
    """Those without area or with a doubtful Jacobian, those turned over, those turned by 60°."""
    mesh, folds = measured.mesh, measured.folds
    flat = without_area(mesh, measured.shapes.alpha, measured.alpha_spread.least)
    yield from _triangles(mesh, flat, Kind.WITHOUT_AREA, "without area")
    if measured.curved_shapes is not None:
        turned = ~flat & ~(measured.curved_shapes.jacobian > 0.0)
        yield from _triangles(mesh, turned, Kind.INVERTED, "whose Jacobian may change its sign")
    if folds is None or not folds.found:
        return
    folded = folds.by_mesh & ~folds.inverted
    for bad, kind, what in (
        (folds.inverted, Kind.INVERTED, "inverted against the surface"),
        (folded, Kind.FOLDED, "folded: turned more than 60° from the surface"),
    ):
        if bad.any():
            yield from _triangles(mesh, bad, kind, what, _causes(folds, bad))


def folded_surfaces(measured: Measurements) -> Iterator[Remark]:
    """Faces that bend sharply or turn over, and where each does most."""
    folds, mesh = measured.folds, measured.mesh
    if folds is None or not folds.found or not folds.by_surface.any():
        return
    faces = []
    for face in np.unique(mesh.face_ids[folds.by_surface]).tolist():
        some = np.flatnonzero(folds.by_surface & (mesh.face_ids == face))
        worst = some[folds.cosine[some].argmin()]
        place = as_point(mesh.points[mesh.triangles[worst]].mean(axis=0))
        faces.append(FoldedFace(name=mesh.face_name(face), place=place, triangles=len(some)))
    yield FoldedSurface(radius=folds.radius, faces=tuple(faces), place=faces[0].place)


def _triangles(
    mesh: SurfaceMesh,
    bad: NDArray[np.bool_],
    kind: Kind,
    what: str,
    causes: tuple[FoldCause, ...] = (),
) -> Iterator[BadTriangles]:
    found = np.flatnonzero(bad)
    if len(found):
        first = int(found[0])
        place = as_point(mesh.points[mesh.triangles[first]].mean(axis=0))
        yield BadTriangles(
            kind=kind, count=len(found), triangle=first, what=what, causes=causes, place=place
        )


def _causes(folds: Folds, bad: NDArray[np.bool_]) -> tuple[FoldCause, ...]:
    """Edges off the surface, or images in (u, v) that are not those of their nodes."""
    edges = "beside edges that lie up to {:.3g} off the surface"
    images = (
        f"beside nodes that lie on the surface to {folds.nearest:.2g} and their (u, v) up to "
        "{:.3g} from there, moved apart where the boundary crosses itself, or so in the file"
    )
    causes = []
    for reached, here, what in (
        (folds.off_surface, bad & (folds.off_surface > 0.0), edges),
        (folds.misplaced, bad & (folds.misplaced > folds.off_surface), images),
    ):
        if here.any():
            most = float(reached[here].max())
            causes.append(FoldCause(what=what, reached=most, count=int(np.count_nonzero(here))))
    return tuple(causes)
