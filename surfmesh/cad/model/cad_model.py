"""A CAD model as plain data: vertices, edges, faces and solids by number, no OCP anywhere.

          vertex 4        edges[7]: from vertex 4 to vertex 5, t0 -> t1 along its curve
            o------------o
      loop  |   faces    |   every face walks along its loops with its inside on the left in the
      <-----|    [2]     |   (u, v) of its surface: coedges (edge, reversed, pcurve)
            o------------o

An edge lies in space once. A *coedge* is one use of it by a face: a curve in the (u, v) of that
face, run the same way as the edge or backwards. A seam has two coedges in one face; so has an
edge inside a face, there and back. A degenerate edge (a pole, an apex) is one point in space and
a curve in (u, v).
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from surfmesh.cad.model.invariants import broken
from surfmesh.geometry.cad_surfaces.curves import CoreCurve
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface

AND = " + "  # between the names of what was made of several

Colour = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class CadVertex:
    """point: (3,) float, model units. tolerance: the ends of its edges lie this near."""

    point: np.ndarray
    tolerance: float


@dataclass(frozen=True, eq=False)
class CadEdge:
    """The part of a curve between two vertices; shared by all faces that meet there.

    curve: ``evaluate(t (n,), order)`` in 3D, or None for a degenerate edge. t0 < t1 are the
    curve's parameters at the vertices start and end (numbers; the same for a closed edge).
    tolerance: its p-curves on the faces lie this near. length: model units. names: of all that it
    was made of, where imprinting made it of several; ``name`` holds them too.
    """

    curve: CoreCurve | None
    t0: float
    t1: float
    start: int
    end: int
    tolerance: float
    degenerate: bool
    name: str
    length: float
    names: tuple[str, ...] = ()

    @property
    def closed(self) -> bool:
        """Whether it ends where it starts."""
        return self.start == self.end

    @property
    def is_straight(self) -> bool:
        """Whether it is part of a straight line."""
        return self.curve is not None and self.curve.kind == "line"

    def parameters(self, fraction: np.ndarray) -> np.ndarray:
        """Fractions of the parameter range, 0 at the start and 1 at the end -> curve parameters."""
        return self.t0 + np.asarray(fraction, float) * (self.t1 - self.t0)

    def evaluate(self, fraction: np.ndarray, order: int = 0) -> tuple[np.ndarray, ...]:
        """Points (n, 3) at fractions (n,) of the range, and derivatives by the curve's parameter.

        Raises ValueError for a degenerate edge, which has none.
        """
        if self.curve is None:
            raise ValueError("a degenerate edge has no curve in space")
        return self.curve.evaluate(self.parameters(fraction), order)


@dataclass(frozen=True, eq=False)
class CadCoedge:
    """One use of an edge by a face.

    edge: number. reversed: the loop runs from the edge's end to its start. pcurve: curve in
    (u, v); p0, p1 are its parameters where the edge has t0, t1, linear in between. seam: the
    face uses this edge twice.
    """

    edge: int
    reversed: bool
    pcurve: CoreCurve
    p0: float
    p1: float
    seam: bool

    @property
    def is_straight(self) -> bool:
        """Whether it is part of a straight line in (u, v)."""
        return self.pcurve.kind == "line"

    def uv(self, fraction: np.ndarray) -> np.ndarray:
        """Parameters at these fractions of the *edge's* range: (n,) -> (n, 2)."""
        parameters = self.p0 + np.asarray(fraction, float) * (self.p1 - self.p0)
        return self.pcurve.evaluate(parameters, 0)[0]

    def walk(self, fraction: np.ndarray) -> np.ndarray:
        """The same in the direction of the loop: 0 where the loop enters, 1 where it leaves."""
        fraction = np.asarray(fraction, float)
        return self.uv(1.0 - fraction if self.reversed else fraction)


@dataclass(frozen=True, eq=False)
class CadFace:
    """The part of a surface inside loops.

    surface: its domain is the (u, v) box of the loops. loops: coedges in walking order with the
    inside on the left in (u, v); the outer loop first. reversed: the face's normal is
    -(r_u x r_v). colour: (r, g, b) from 0 to 1 (sRGB), or None. area: model units squared.
    fault: why it cannot be meshed, found when it was read; mostly empty.
    names: as of an edge.
    """

    surface: FaceSurface
    loops: tuple[tuple[CadCoedge, ...], ...]
    reversed: bool
    tolerance: float
    name: str
    colour: Colour | None
    area: float
    kind: str
    names: tuple[str, ...] = ()
    fault: str = ""

    @property
    def coedges(self) -> Iterator[CadCoedge]:
        """All coedges, loop after loop."""
        return (coedge for loop in self.loops for coedge in loop)

    def label(self, number: int) -> str:
        """What it is called in messages as face ``number``: ``face 3 (lid)``, or by its kind."""
        return f"face {number} ({self.name or self.kind})"


Shell = tuple[tuple[int, bool], ...]  # (face number, True where outside is against its normal)


@dataclass(frozen=True, eq=False)
class CadSolid:
    """A body: its outer shell first, then its voids.

    shells: (face number, reversed) pairs; reversed where the face's own normal points into the
    body. volume: positive, model units cubed. closed: every edge is used evenly, once each way.
    """

    shells: tuple[Shell, ...]
    name: str
    colour: Colour | None
    volume: float
    closed: bool
    names: tuple[str, ...] = ()  # as of an edge


@dataclass(frozen=True, eq=False)
class CadNode:
    """A part or assembly by name: the numbers of its own solids and faces, and what is below."""

    name: str
    solids: tuple[int, ...] = ()
    faces: tuple[int, ...] = ()  # that are of none of its solids
    children: tuple[CadNode, ...] = ()

    def lines(self, depth: int = 0) -> list[str]:
        """The tree as indented lines."""
        held = [f"solids {_spans(self.solids)}"] if self.solids else []
        held += [f"faces {_spans(self.faces)}"] if self.faces else []
        own = "  " * depth + (self.name or "(no name)") + (f": {', '.join(held)}" if held else "")
        return [own] + [line for child in self.children for line in child.lines(depth + 1)]


@dataclass(frozen=True, eq=False)
class CadTag:
    """A tag of CadQuery and the numbers of what it stands for: of nothing, when later steps have
    removed what it held (in words: "1 face")."""

    name: str
    held: str
    faces: tuple[int, ...] = ()
    edges: tuple[int, ...] = ()
    vertices: tuple[int, ...] = ()
    solids: tuple[int, ...] = ()


@dataclass(frozen=True, eq=False, repr=False)
class CadModel:
    """Everything that was read, in plain Python and numpy; see the module's docstring.

    free_shells, free_faces: what belongs to no solid; a free face is in no shell either.
    unit: of every length; file_unit: that of the file. diagonal: of the box around everything.
    healing: what was changed or could not be, one sentence each. source: the file, or what else
    it came from; sha256: of that file. tags: of CadQuery. left_out: faces that cannot be meshed,
    each with the reason; ``mesh`` refuses such a model unless strict=False.
    """

    vertices: tuple[CadVertex, ...]
    edges: tuple[CadEdge, ...]
    faces: tuple[CadFace, ...]
    solids: tuple[CadSolid, ...]
    free_shells: tuple[Shell, ...]
    free_faces: tuple[int, ...]
    name: str
    unit: str
    file_unit: str
    diagonal: float
    tree: CadNode
    healing: tuple[str, ...]
    source: str
    sha256: str = ""
    tags: tuple[CadTag, ...] = ()
    left_out: tuple[str, ...] = ()
    _faces_of_edge: list[tuple[int, ...]] = field(default_factory=list, compare=False)

    def face_label(self, face: int) -> str:
        """What a face is called in messages; see ``CadFace.label``."""
        return self.faces[face].label(face)

    def faces_of_edge(self, edge: int) -> tuple[int, ...]:
        """Numbers of the faces that use an edge; twice the same for a seam."""
        if not self._faces_of_edge and self.edges:
            users: list[list[int]] = [[] for _ in self.edges]
            for number, face in enumerate(self.faces):
                for coedge in face.coedges:
                    users[coedge.edge].append(number)
            self._faces_of_edge.extend(tuple(user) for user in users)
        return self._faces_of_edge[edge]

    @property
    def area(self) -> float:
        """Of all faces, shared ones once."""
        return math.fsum(face.area for face in self.faces)

    @property
    def volume(self) -> float:
        """Of all solids."""
        return math.fsum(solid.volume for solid in self.solids)

    def broken_invariant(self) -> str:
        """The first broken invariant in words; empty when all is well."""
        return next(broken(self), "")

    def problems(self) -> list[str]:
        """All broken invariants, in words."""
        return list(broken(self))

    def summary(self) -> str:
        """What the model is made of, several lines of text."""
        kinds = Counter(face.kind for face in self.faces)
        seams = {c.edge for face in self.faces for c in face.coedges if c.seam}
        degenerate = sum(edge.degenerate for edge in self.edges)
        lines = [
            f"{self.name or self.source}: {_counted(len(self.solids), 'solid')}, "
            f"{_counted(len(self.faces), 'face')}, {_counted(len(self.edges), 'edge')}, "
            f"{_counted(len(self.vertices), 'vertex', 'vertices')}",
            "faces: " + ", ".join(f"{n} {kind}" for kind, n in kinds.most_common()),
            f"edges: {len(seams)} seams or inside a face, {degenerate} degenerate",
            f"unit {self.unit}, diagonal {self.diagonal:.6g}, area {self.area:.6g}, "
            f"volume {self.volume:.6g}",
        ]
        loose = sum(len(shell) for shell in self.free_shells) + len(self.free_faces)
        if loose:
            lines.append(f"{_counted(loose, 'face')} in no solid")
        opened = sum(not solid.closed for solid in self.solids)
        if opened:
            lines.append(f"{_counted(opened, 'solid')} not closed")
        lines += [f"left out: {sentence}" for sentence in self.left_out]
        lines += [f"healing: {sentence}" for sentence in self.healing]
        return "\n".join(lines + self.tree.lines())

    def __repr__(self) -> str:
        return (
            f"CadModel({self.name!r}, solids={len(self.solids)}, faces={len(self.faces)}, "
            f"edges={len(self.edges)}, unit={self.unit!r}, diagonal={self.diagonal:.6g})"
        )


def _counted(count: int, one: str, many: str = "") -> str:
    return f"{count} {one if count == 1 else many or one + 's'}"


def _spans(numbers: tuple[int, ...]) -> str:
    """(0, 1, 2, 5) -> "0-2, 5"."""
    spans: list[list[int]] = []
    for number in sorted(numbers):
        if spans and number == spans[-1][1] + 1:
            spans[-1][1] = number
        else:
            spans.append([number, number])
    return ", ".join(str(a) if a == b else f"{a}-{b}" for a, b in spans)
