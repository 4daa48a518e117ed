"""Edges, vertices and solids that are not as in the model, or as on a surface."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfmesh.quality.measures.measurements import Measurements
from surfmesh.quality.measures.places import as_point, count_in_words, place_in_words
from surfmesh.quality.measures.solids import solid_mesh
from surfmesh.quality.measures.topology import topology
from surfmesh.quality.verdict.finding import Kind, Problem, Remark
from surfmesh.result.surface_mesh import SurfaceMesh


@dataclass(frozen=True, kw_only=True)
class OddEdges(Problem):
    """Edges of the mesh: how many, and the first."""

    count: int
    nodes: tuple[int, int]
    what: str

    @property
    def text(self) -> str:
        """ "2 edges shared by more than two triangles, first 3-8 at (0, 0, 1)" """
        a, b = self.nodes
        edges = count_in_words(self.count, "edge")
        return f"{edges} {self.what}, first {a}-{b} at {place_in_words(self.place)}"


@dataclass(frozen=True, kw_only=True)
class OddVertices(Problem):
    """Vertices of the mesh: how many, and the first."""

    kind: Kind = Kind.VERTICES
    count: int
    vertex: int
    what: str

    @property
    def text(self) -> str:
        """ "1 vertex where parts only touch, first 3 at (0, 0, 1)" """
        vertices = count_in_words(self.count, "vertex", "vertices")
        return f"{vertices} {self.what}, first {self.vertex} at {place_in_words(self.place)}"


@dataclass(frozen=True, kw_only=True)
class OddSolid(Problem):
    """A solid whose mesh does not close around it."""

    kind: Kind = Kind.SOLID_OPEN
    solid: int
    name: str
    lacks: tuple[str, ...]  # of closed, manifold, oriented

    @property
    def text(self) -> str:
        """ "solid 0 (lid) is not closed" """
        return f"{solid_in_words(self.solid, self.name)} is not {' and not '.join(self.lacks)}"


@dataclass(frozen=True, kw_only=True)
class OddEulerNumber(Problem):
    """The mesh has not the topology of the model."""

    kind: Kind = Kind.EULER_NUMBER
    solid: int | None  # None: the mesh as a whole
    found: int
    exact: int

    @property
    def text(self) -> str:
        """ "the Euler number of the mesh is 0, that of the model 2" """
        of = "the mesh" if self.solid is None else f"solid {self.solid}"
        return f"the Euler number of {of} is {self.found}, that of the model {self.exact}"


@dataclass(frozen=True, kw_only=True)
class SheetsApart(Remark):
    """Faces of no solid that share an edge and face opposite ways."""

    kind: Kind = Kind.ORIENTATION
    count: int  # edges of the mesh

    @property
    def text(self) -> str:
        """How many edges, and where the first is."""
        return (
            f"faces of no solid turn opposite sides to each other along "
            f"{count_in_words(self.count, 'edge')}, as in the model: first at "
            f"{place_in_words(self.place)}"
        )


@dataclass(frozen=True, kw_only=True)
class TrianglesNotJoined(Remark):
    """Free edges that lie on each other and share no vertices."""

    kind: Kind = Kind.EDGES
    count: int
    nodes: tuple[int, int]

    @property
    def text(self) -> str:
        """How many, and where the first is."""
        a, b = self.nodes
        return (
            f"{self.count:,} free edges lie on each other and share no vertices, first {a}-{b} at "
            f"{place_in_words(self.place)}: triangles are not joined there; write the file with "
            "shared vertices"
        )


def solid_in_words(solid: int, name: str) -> str:
    """ "solid 0 (lid)" """
    return f"solid {solid}" + f" ({name})" * bool(name)


def odd_connectivity(measured: Measurements, missing: bool) -> Iterator[Problem]:
    """Solids, Euler numbers, edges and vertices. Faces that are ``missing`` say so already."""
    odd = measured.unexpected
    yield from _solids(measured, missing)
    if not missing:
        yield from _euler_numbers(measured)
    if measured.shares_faces and not odd.known:
        return  # three triangles and more may meet where solids do
    yield from _edges(measured, missing)
    yield from _vertices(measured, missing)
    if len(odd.clashing_edges) and not measured.mesh.one_sided:
        what = "between triangles of opposite orientation"
        yield _odd_edges(measured.mesh, odd.clashing_edges, Kind.ORIENTATION, what)


def sheets_apart(measured: Measurements) -> Iterator[Remark]:
    """Sheets of the model that turn opposite sides to each other."""
    found, mesh = measured.unexpected.sheets_clashing, measured.mesh
    if len(found):
        place = as_point(mesh.points[mesh.edges[found[0]]].mean(axis=0))
        yield SheetsApart(count=len(found), place=place)


def triangles_not_joined(measured: Measurements) -> Iterator[Remark]:
    """What looks whole and is not."""
    found, mesh = measured.coincident_edges, measured.mesh
    if len(found):
        a, b = mesh.edges[found[0]].tolist()
        place = as_point(mesh.points[[a, b]].mean(axis=0))
        yield TrianglesNotJoined(count=len(found), nodes=(a, b), place=place)


def _solids(measured: Measurements, missing: bool) -> Iterator[Problem]:
    """Solids that are not what the model's are."""
    mesh = measured.mesh
    if measured.unexpected.known:
        exact = () if missing else measured.facts.solids
        for row in measured.solids:
            if row.solid < len(exact) and exact[row.solid].closed and not row.closed:
                yield OddSolid(solid=row.solid, name=row.name, lacks=("closed",))
        return
    for row in measured.solids if measured.shares_faces else ():
        around = topology(solid_mesh(mesh, row.solid))
        lacks = tuple(
            name for name in ("closed", "manifold", "oriented") if not getattr(around, name)
        )
        if lacks:
            yield OddSolid(solid=row.solid, name="", lacks=lacks)


def _euler_numbers(measured: Measurements) -> Iterator[Problem]:
    """Of solids; of the whole mesh, where none of them tells."""
    odd = [
        OddEulerNumber(solid=row.solid, found=row.euler, exact=row.euler_exact)
        for row in measured.solids
        if row.euler_exact is not None and row.euler != row.euler_exact
    ]
    yield from odd
    exact, found = measured.facts.euler, measured.topology.euler
    if not odd and exact is not None and exact != found:
        yield OddEulerNumber(solid=None, found=found, exact=exact)


def _edges(measured: Measurements, missing: bool) -> Iterator[Problem]:
    odd = measured.unexpected
    crowded = "shared by more than two triangles"
    if odd.known:
        crowded = "with more triangles than the model has faces there"
    if len(odd.crowded_edges):
        yield _odd_edges(measured.mesh, odd.crowded_edges, Kind.EDGES, crowded)
    if len(odd.bare_edges) and not missing:
        bare = "with fewer triangles than the model has faces there"
        yield _odd_edges(measured.mesh, odd.bare_edges, Kind.EDGES, bare)
    if len(measured.torn_edges) and not missing:
        torn = "with nothing beside them where the surface goes on"
        yield _odd_edges(measured.mesh, measured.torn_edges, Kind.EDGES, torn)


def _odd_edges(mesh: SurfaceMesh, found: NDArray[np.intp], kind: Kind, what: str) -> OddEdges:
    a, b = mesh.edges[found[0]].tolist()
    place = as_point(mesh.points[[a, b]].mean(axis=0))
    return OddEdges(kind=kind, count=len(found), nodes=(a, b), what=what, place=place)


def _vertices(measured: Measurements, missing: bool) -> Iterator[Problem]:
    odd, points = measured.unexpected, measured.mesh.points
    model = " unlike in the model" if odd.known else ""
    joined = odd.joined_vertices[:0] if missing else odd.joined_vertices
    for found, what in (
        (odd.pinched_vertices, "where parts only touch"),
        (joined, "where parts are joined"),
    ):
        if len(found):
            first = int(found[0])
            yield OddVertices(
                count=len(found), vertex=first, what=what + model, place=as_point(points[first])
            )
