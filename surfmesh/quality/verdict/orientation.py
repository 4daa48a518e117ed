"""Solids and closed surfaces that face their inside: their volume is negative."""

from collections.abc import Iterator
from dataclasses import dataclass

from surfmesh.quality.measures.inward import inward_pieces
from surfmesh.quality.measures.measurements import Measurements
from surfmesh.quality.measures.places import as_point, place_in_words
from surfmesh.quality.verdict.connectivity import solid_in_words
from surfmesh.quality.verdict.finding import Kind, Remark


@dataclass(frozen=True, kw_only=True)
class SolidFacesInside(Remark):
    """A solid whose triangles face its inside."""

    kind: Kind = Kind.ORIENTATION
    solid: int
    name: str
    volume: float

    @property
    def text(self) -> str:
        """Which, and what helps."""
        return (
            f"{solid_in_words(self.solid, self.name)} faces its inside, its volume is "
            f"{self.volume:.5g}: mesh.flipped() (--flip) turns the whole mesh over"
        )


@dataclass(frozen=True, kw_only=True)
class PiecesFaceInside(Remark):
    """Closed pieces of no solid whose triangles face their inside."""

    kind: Kind = Kind.ORIENTATION
    count: int
    closed: int  # closed pieces in all
    is_all: bool  # the one piece is the whole mesh
    volume: float  # of the first

    @property
    def text(self) -> str:
        """How many, where the first is, and what helps."""
        if self.is_all:
            return (
                f"the closed surface faces its inside, its volume is {self.volume:.5g}: "
                "mesh.flipped() (--flip) turns it over"
            )
        return (
            f"{self.count:,} of {self.closed:,} closed pieces face{'s' * (self.count == 1)} the "
            f"inside, first at {place_in_words(self.place)}, volume {self.volume:.5g}: "
            "mesh.flipped() (--flip) turns all over"
        )


def turned_inward(measured: Measurements) -> Iterator[Remark]:
    """Solids first. Where a surface crosses itself, or has one side, nothing is told of pieces."""
    if not measured.finite or measured.broken:
        return
    for row in measured.solids:
        if row.volume is not None and row.volume < 0.0:
            yield SolidFacesInside(solid=row.solid, name=row.name, volume=row.volume)
    topology = measured.topology
    if topology.components == 1 and not topology.balanced:
        return
    if measured.mesh.one_sided or measured.facts.crosses_itself:
        return
    if measured.solid_figures.is_around_all(measured.mesh):
        return
    volume, first, closed = inward_pieces(measured.mesh, topology)
    if len(volume):
        yield PiecesFaceInside(
            count=len(volume),
            closed=closed,
            is_all=closed == 1 and topology.components == 1,
            volume=float(volume[0]),
            place=as_point(first),
        )
