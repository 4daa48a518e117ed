"""Triangles that meet where they share nothing: of one body, of two, of faces never sewn."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from surfmesh.geometry.formulas.parametric import ParametricSurface
from surfmesh.quality.measures.bodies import BodyPair
from surfmesh.quality.measures.loose_edges import LooseEdges
from surfmesh.quality.measures.measurements import Measurements
from surfmesh.quality.measures.places import count_in_words, place_in_words
from surfmesh.quality.measures.self_intersection import MeetingPair, located
from surfmesh.quality.verdict.finding import Kind, Problem, Remark

LEAST_SEWN = 1e-6  # of the diagonal: a tolerance for gaps that are none


@dataclass(frozen=True, kw_only=True)
class SelfIntersection(Problem):
    """The mesh intersects itself."""

    kind: Kind = Kind.SELF_INTERSECTION
    count: int  # pairs of triangles
    first: MeetingPair
    faces: tuple[str, ...]  # of the first
    cure: str

    @property
    def text(self) -> str:
        """How often, and where first."""
        one, other = self.first.triangles
        return (
            f"the mesh intersects itself: {count_in_words(self.count, 'pair')} of triangles, first "
            f"{one} and {other} ({' and '.join(self.faces)}) at "
            f"{place_in_words(self.first.point)}{self.cure}"
        )


@dataclass(frozen=True, kw_only=True)
class SolidsOverlap(Problem):
    """Solids share volume."""

    kind: Kind = Kind.OVERLAP
    count: int  # pairs of solids
    deepest: BodyPair

    @property
    def text(self) -> str:
        """How many, and which do so most."""
        depth = self.deepest.depth
        lie = f" by at least {depth:.3g}" if depth else ", one within the other"
        return (
            f"{count_in_words(self.count, 'pair')} of solids overlap: "
            f"{' and '.join(self.deepest.names)}{lie}, at {place_in_words(self.deepest.point)}; "
            "join them or cut one by the other in the model"
        )


@dataclass(frozen=True, kw_only=True)
class BodiesMeet(Remark):
    """Bodies that touch and are meshed each by itself, or that lie near each other."""

    kind: Kind = Kind.CONTACT
    touch: bool  # else only their facets meet
    pairs: tuple[BodyPair, ...]

    @property
    def text(self) -> str:
        """How many, where first, and what helps."""
        what, cure = "do not touch in the model, and their triangles meet", "a smaller chord keeps"
        cure += " them apart"
        if self.touch:
            what = "touch without a common face"
            cure = "imprint=True of load or from_cadquery (--imprint) has their meshes joined"
        first = self.pairs[0]
        meeting = sum(pair.triangles for pair in self.pairs)
        met = f", {meeting:,} pairs of triangles meet" if meeting else ""
        gap = f", {first.gap:.3g} apart" if first.gap else ""
        return (
            f"{count_in_words(len(self.pairs), 'pair')} of bodies {what}{met}: first "
            f"{' and '.join(first.names)} at {place_in_words(first.point)}{gap}; {cure}"
        )


@dataclass(frozen=True, kw_only=True)
class FacesNotSewn(Remark):
    """Faces that lie edge to edge and share none."""

    kind: Kind = Kind.CONTACT
    loose: LooseEdges
    tolerance: str  # that would sew them

    @property
    def text(self) -> str:
        """How many, how far apart, and what helps."""
        loose = self.loose
        faces = count_in_words(loose.faces, "face")
        return (
            f"{loose.edges:,} edges of {faces} lie along other edges and are not joined to them, "
            f"up to {loose.gap:.2g} apart at {place_in_words(loose.point)}; "
            f"sew={self.tolerance} of load or from_cadquery (--sew {self.tolerance}) joins them"
        )


def self_intersections(measured: Measurements) -> Iterator[Problem]:
    """Unless the surface crosses itself by its nature."""
    pairs, mesh = measured.meeting, measured.mesh
    if pairs is None or not len(pairs) or measured.crosses_itself:
        return
    (first,) = located(mesh, pairs[:1])
    cure = ""
    if any(isinstance(surface, ParametricSurface) for surface in mesh.surfaces):
        cure = "; lower the sizes there, or say embedded = false in the facts of the surface"
    elif mesh.surfaces:
        cure = "; lower the sizes there, or repair the model if its own faces cross"
    faces = tuple(dict.fromkeys(mesh.face_name(face) for face in first.faces))
    yield SelfIntersection(count=len(pairs), first=first, faces=faces, cure=cure, place=first.point)


def overlaps(measured: Measurements) -> Iterator[Problem]:
    """Of solids."""
    found = () if measured.bodies is None else measured.bodies.overlapping
    if found:
        deepest = max(found, key=lambda pair: pair.depth or 0.0)
        yield SolidsOverlap(count=len(found), deepest=deepest, place=deepest.point)


def meeting_bodies(measured: Measurements) -> Iterator[Remark]:
    """Those that touch, then those that are near."""
    if measured.bodies is None:
        return
    for touch, pairs in ((True, measured.bodies.touching), (False, measured.bodies.near)):
        if pairs:
            yield BodiesMeet(touch=touch, pairs=pairs, place=pairs[0].point)


def faces_not_sewn(measured: Measurements) -> Iterator[Remark]:
    """With the tolerance of ``sew`` that joins them, of one digit."""
    loose, points = measured.loose_edges, measured.mesh.points
    if loose is None:
        return
    diagonal = max(float((points.max(axis=0) - points.min(axis=0)).max()), 1e-300)
    wide = max(2.0 * loose.gap, LEAST_SEWN * diagonal)
    step = 10.0 ** math.floor(math.log10(wide))
    tolerance = f"{math.ceil(wide / step) * step:.0e}"
    yield FacesNotSewn(loose=loose, tolerance=tolerance, place=loose.point)
