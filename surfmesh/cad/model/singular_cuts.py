"""Faces are cut along lines inside them that are one point in space: the pinch of a torus, an apex.

    v |  +----<----+            v |  +----<----+       the line v = c is one point: what lies
      |  |         |              |  v    A    ^       below it and what lies above it meet
    c |--|- - - - -|--->   ->   c |  +---->----+  pole of A    there in a vertex, not along
      |  v         ^              |  +----<----+  pole of B    an edge
      |  +---->----+              |  +---->-B--+
      +------------- u            +------------- u

Edges that pass through the point are split at a vertex there, in all faces that use them. The
pieces of a face are faces of their own, with degenerate edges along the line. Where the line is
the rim of a face and a p-curve jumps along it, the degenerate edge that lacks is added.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from surfmesh.cad.model.cad_model import (
    CadCoedge,
    CadEdge,
    CadFace,
    CadModel,
    CadNode,
    CadTag,
    CadVertex,
)
from surfmesh.cad.model.centres import face_area
from surfmesh.cad.model.invariants import ENDS, FRACTIONS, NOISE, signed_area
from surfmesh.cad.model.loops import Loop, end_of, start_of
from surfmesh.cad.model.singular_crossings import ON_LINE, crossings, lines_of, slack_of
from surfmesh.geometry.cad_surfaces.curves import Line
from surfmesh.geometry.cad_surfaces.singular_lines import SingularLine
from surfmesh.geometry.inside_loops import is_inside
from surfmesh.geometry.quadrature import gauss_rule
from surfmesh.geometry.small_matrices import norm, product

LOOSE = 1e-8  # of the model's diagonal: tolerance of a new vertex
ASIDE = 0.01  # of an edge: so far from a line it is seen which of two p-curves lies to the right
POLYGON = 33  # points of a coedge, to tell which loop a hole is in
LENGTH_PANELS = 16  # of Gauss's rule with twelve points


def cut_at_singular_lines(model: CadModel) -> CadModel:
    """The model with such faces cut; the same model when there are none.

    The first piece keeps the number of its face, others are added at the end; a sentence of
    ``healing`` says which. Solids, shells, tags and names take in the new ones.
    """
    lines = {number: lines_of(face) for number, face in enumerate(model.faces)}
    lines = {number: found for number, found in lines.items() if found}
    if not lines:
        return model
    work = _Work(model)
    work.split_edges(lines)
    for number, found in lines.items():
        work.cut(number, found)
    return work.result() if work.changed else model


@dataclass
class _Work:
    """The model as it is taken apart."""

    model: CadModel
    vertices: list[CadVertex] = field(init=False)
    edges: list[CadEdge] = field(init=False)
    faces: list[CadFace] = field(init=False)
    pieces: dict[int, list[int]] = field(default_factory=dict)  # of faces that were cut
    parts: dict[int, list[int]] = field(default_factory=dict)  # of edges that were split
    sentences: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.vertices = list(self.model.vertices)
        self.edges = list(self.model.edges)
        self.faces = list(self.model.faces)

    @property
    def changed(self) -> bool:
        return bool(self.sentences)

    def split_edges(self, lines: dict[int, list[SingularLine]]) -> None:
        """Split the edges whose p-curves cross a line, in all faces."""
        places: dict[int, dict[float, np.ndarray]] = defaultdict(dict)
        for number, found in lines.items():
            face = self.faces[number]
            for line in found:
                for coedge in face.coedges:
                    for fraction in crossings(coedge, line, slack_of(face, line.axis)):
                        near = [s for s in places[coedge.edge] if abs(s - fraction) < ON_LINE]
                        if not near and not self.edges[coedge.edge].degenerate:
                            places[coedge.edge][fraction] = line.point
        rows = {edge: self._split(edge, sorted(at.items())) for edge, at in places.items() if at}
        if not rows:
            return
        for number, face in enumerate(self.faces):
            if any(coedge.edge in rows for coedge in face.coedges):
                loops = tuple(
                    tuple(part for coedge in loop for part in _parts(coedge, rows.get(coedge.edge)))
                    for loop in face.loops
                )
                self.faces[number] = replace(face, loops=loops)

    def _split(self, number: int, places: list[tuple[float, np.ndarray]]) -> list[tuple]:
        """Edges (number, first fraction, last fraction) that a cut edge becomes."""
        edge = self.edges[number]
        fractions = [0.0, *(fraction for fraction, _ in places), 1.0]
        known = {edge.start, edge.end}
        corners = [edge.start, *(self.vertex_at(point, known) for _, point in places), edge.end]
        rows = []
        for k, (first, last) in enumerate(pairwise(fractions)):
            t0, t1 = edge.parameters(np.array([first, last])).tolist()
            own = replace(
                edge, t0=t0, t1=t1, start=corners[k], end=corners[k + 1],
                length=_length(edge, t0, t1),
            )  # fmt: skip
            if k:
                self.edges.append(own)
            else:
                self.edges[number] = own
            rows.append((len(self.edges) - 1 if k else number, first, last))
        self.parts[number] = [row[0] for row in rows]
        return rows

    def vertex_at(self, point: np.ndarray, known: set[int]) -> int:
        """The vertex at a singular point: of those ``known``, or made for one before, or new."""
        noise = NOISE * self.model.diagonal
        for number in [*sorted(known), *range(len(self.model.vertices), len(self.vertices))]:
            vertex = self.vertices[number]
            if norm(vertex.point - point) <= vertex.tolerance + noise:
                return number
        self.vertices.append(CadVertex(point, LOOSE * self.model.diagonal))
        return len(self.vertices) - 1

    def _vertices_of(self, face: CadFace) -> set[int]:
        edges = [self.edges[coedge.edge] for coedge in face.coedges]
        return {vertex for edge in edges for vertex in (edge.start, edge.end)}

    def cut(self, number: int, lines: list[SingularLine]) -> None:
        """Replace a face by its pieces on either side of the lines."""
        face = self.faces[number]
        groups: list[tuple[Loop, ...]] = [face.loops]
        for line in lines:
            vertex = self.vertex_at(line.point, self._vertices_of(face))
            self._one_vertex(face, line, vertex)
            groups = [
                side for loops in groups for side in self._sides(face, loops, line, vertex) if side
            ]
        made = [self._piece(face, loops) for group in groups for loops in _regions(group)]
        numbers = [number, *range(len(self.faces), len(self.faces) + len(made) - 1)]
        self.faces[number : number + 1] = made[:1]
        self.faces += made[1:]
        self.pieces[number] = numbers
        self._say(number, lines, numbers)

    def _say(self, number: int, lines: list[SingularLine], numbers: list[int]) -> None:
        noise = NOISE * self.model.diagonal
        points = [[0.0 if abs(x) < noise else x for x in line.point] for line in lines]
        places = dict.fromkeys(f"({', '.join(f'{x:.6g}' for x in point)})" for point in points)
        where = f"its surface is one point at {' and '.join(places)}"
        if len(numbers) > 1:
            others = f"face{'s' * (len(numbers) > 2)} {', '.join(map(str, numbers[1:]))}"
            self.sentences.append(f"face {number}: {where}, and is cut there: {others} added")
        else:
            self.sentences.append(f"face {number}: {where}, degenerate edge added")

    def _one_vertex(self, face: CadFace, line: SingularLine, vertex: int) -> None:
        """All vertices of a face that lie on a line are one."""
        slack = slack_of(face, line.axis)
        others = set()
        for coedge in face.coedges:
            on = np.abs(coedge.walk(ENDS)[:, line.axis] - line.value) <= slack
            ends = start_of(coedge, self.edges), end_of(coedge, self.edges)
            others |= {end for end, there in zip(ends, on) if there and end != vertex}
        if not others:
            return
        for number, edge in enumerate(self.edges):
            if edge.start in others or edge.end in others:
                start, end = (vertex if e in others else e for e in (edge.start, edge.end))
                self.edges[number] = replace(edge, start=start, end=end)

    def _sides(
        self, face: CadFace, loops: tuple[Loop, ...], line: SingularLine, vertex: int
    ) -> Iterator[tuple[Loop, ...]]:
        """The loops below and above a line, each closed by degenerate edges along it."""
        for above in (False, True):
            whole, chains = [], []
            for loop in loops:
                found, closed = _chains(loop, line, slack_of(face, line.axis), above)
                chains += found
                if closed:
                    whole.append(loop)
            # above v = c one walks to the right with the inside on the left, above u = c down
            way = 1.0 if above == (line.axis == 1) else -1.0
            begins, ends = _ranks(face, line, chains, way)
            yield tuple(whole + self._closed(chains, begins, ends, line, vertex))

    def _closed(
        self, chains: list[Loop], begins: list, ends: list, line: SingularLine, vertex: int
    ) -> list[Loop]:
        """Loops of chains that begin and end on the line, by their ranks along it.

        From where a chain ends one walks along the line to the nearest place where one begins.
        """
        free = set(range(len(chains)))
        loops = []
        while free:
            first = place = min(free)
            loop: list[CadCoedge] = []
            while True:
                free.discard(place)
                loop += chains[place]
                ahead = [k for k in (*sorted(free), first) if begins[k] > ends[place]]
                after = min(ahead, key=lambda k: begins[k]) if ahead else first
                loop += self._along(chains[place][-1], chains[after][0], line, vertex)
                if after == first:
                    break
                place = after
            loops.append(tuple(loop))
        return loops

    def _along(
        self, here: CadCoedge, after: CadCoedge, line: SingularLine, vertex: int
    ) -> list[CadCoedge]:
        """The degenerate coedge between the end of one coedge and the start of another, if any."""
        across = 1 - line.axis
        first = float(here.walk(ENDS[1:])[0, across])
        last = float(after.walk(ENDS[:1])[0, across])
        if abs(first - last) <= ON_LINE * ON_LINE * max(abs(first), abs(last)):
            return []
        low, high = min(first, last), max(first, last)
        direction = np.zeros(2)
        direction[across] = 1.0
        tolerance = self.vertices[vertex].tolerance
        number = len(self.edges)
        self.edges.append(CadEdge(None, low, high, vertex, vertex, tolerance, True, "", 0.0))
        return [CadCoedge(number, first > last, Line(line.at(0.0), direction), low, high, False)]

    def _piece(self, face: CadFace, loops: tuple[Loop, ...]) -> CadFace:
        uv = np.concatenate([coedge.uv(FRACTIONS) for loop in loops for coedge in loop])
        (u0, v0), (u1, v1) = uv.min(axis=0).tolist(), uv.max(axis=0).tolist()
        surface = face.surface.with_domain(((u0, u1), (v0, v1)))
        uses: dict[int, int] = defaultdict(int)
        for loop in loops:
            for coedge in loop:
                uses[coedge.edge] += 1
        loops = tuple(
            tuple(replace(coedge, seam=uses[coedge.edge] > 1) for coedge in loop) for loop in loops
        )
        piece = replace(face, surface=surface, loops=loops)
        return replace(piece, area=face_area(piece))

    def result(self) -> CadModel:
        model = self.model

        def faces(numbers: tuple[int, ...]) -> tuple[int, ...]:
            return tuple(new for old in numbers for new in self.pieces.get(old, [old]))

        def shell(uses: tuple) -> tuple:
            return tuple((new, way) for old, way in uses for new in self.pieces.get(old, [old]))

        def node(old: CadNode) -> CadNode:
            return replace(old, faces=faces(old.faces), children=tuple(map(node, old.children)))

        def tag(old: CadTag) -> CadTag:
            parts = {new for one in old.edges for new in self.parts.get(one, [one])}
            return replace(old, faces=tuple(sorted(faces(old.faces))), edges=tuple(sorted(parts)))

        self._drop_unused_edges()
        return replace(
            model,
            vertices=tuple(self.vertices),
            edges=tuple(self.edges),
            faces=tuple(self.faces),
            solids=tuple(
                replace(solid, shells=tuple(map(shell, solid.shells))) for solid in model.solids
            ),
            free_shells=tuple(map(shell, model.free_shells)),
            free_faces=faces(model.free_faces),
            tree=node(model.tree),
            healing=(*model.healing, *self.sentences),
            tags=tuple(map(tag, model.tags)),
            _faces_of_edge=[],
        )

    def _drop_unused_edges(self) -> None:
        """Degenerate edges that have been replaced leave no number behind."""
        used = sorted({coedge.edge for face in self.faces for coedge in face.coedges})
        if len(used) == len(self.edges):
            return
        number = {old: new for new, old in enumerate(used)}
        self.edges = [self.edges[old] for old in used]
        for old in range(len(self.model.edges)):
            parts = self.parts.get(old, [old])
            self.parts[old] = [number[part] for part in parts if part in number]
        for place, face in enumerate(self.faces):
            loops = tuple(
                tuple(replace(coedge, edge=number[coedge.edge]) for coedge in loop)
                for loop in face.loops
            )
            self.faces[place] = replace(face, loops=loops)


def _parts(coedge: CadCoedge, rows: list[tuple] | None) -> list[CadCoedge]:
    """A coedge as uses of the edges (number, first fraction, last fraction) that its own became."""
    if rows is None:
        return [coedge]
    width = coedge.p1 - coedge.p0
    found = [
        replace(coedge, edge=edge, p0=coedge.p0 + first * width, p1=coedge.p0 + last * width)
        for edge, first, last in rows
    ]
    return found[::-1] if coedge.reversed else found


def _length(edge: CadEdge, t0: float, t1: float) -> float:
    if edge.curve is None:
        return 0.0
    t, weights = gauss_rule(t0, t1, LENGTH_PANELS, 12)
    return float(product(np.linalg.norm(edge.curve.evaluate(t, 1)[1], axis=1), weights))


def _chains(loop: Loop, line: SingularLine, slack: float, above: bool) -> tuple[list[Loop], bool]:
    """Runs of coedges on one side of a line, from the line to the line; or: the loop is whole.

    What lies on the line itself is in none of them.
    """
    sign = 1.0 if above else -1.0
    beside = [sign * (coedge.walk(FRACTIONS)[:, line.axis] - line.value) for coedge in loop]
    here = [bool(far.max() > slack and far.max() > -far.min()) for far in beside]
    begins = [there and far[0] <= slack for there, far in zip(here, beside)]
    if not any(begins):
        return [], all(here)
    chains: list[list[CadCoedge]] = []
    start = begins.index(True)
    for k in (*range(start, len(loop)), *range(start)):
        if begins[k]:
            chains.append([])
        if here[k]:
            chains[-1].append(loop[k])
    return [tuple(chain) for chain in chains], False


def _ranks(
    face: CadFace, line: SingularLine, chains: list[Loop], way: float
) -> tuple[list[tuple], list[tuple]]:
    """Where chains begin and end along the line, in walking order.

    Of two at the same place the one that lies ahead a little away from the line comes last.
    """
    across = 1 - line.axis
    low, slack = face.surface.domain[across][0], slack_of(face, across)

    def rank(coedge: CadCoedge, at: float, beside: float) -> tuple[float, float]:
        here, aside = coedge.walk(np.array([at, beside]))[:, across]
        return way * round((here - low) / slack), way * float(aside)

    return (
        [rank(chain[0], 0.0, ASIDE) for chain in chains],
        [rank(chain[-1], 1.0, 1.0 - ASIDE) for chain in chains],
    )


def _regions(loops: tuple[Loop, ...]) -> list[tuple[Loop, ...]]:
    """Each outer loop with the holes inside it."""
    areas = [signed_area(loop) for loop in loops]
    outer = sorted((k for k, area in enumerate(areas) if area > 0.0), key=lambda k: areas[k])
    if len(outer) < 2:
        holes = [k for k in range(len(loops)) if k not in outer]
        return [tuple(loops[k] for k in (*outer, *holes))]
    fraction = np.linspace(0.0, 1.0, POLYGON)[:-1]
    rings = {k: np.concatenate([c.walk(fraction) for c in loops[k]]) for k in outer}
    found: dict[int, list[Loop]] = {k: [loops[k]] for k in outer}
    for k, loop in enumerate(loops):
        if k in found:
            continue
        place = loop[0].walk(np.array([0.5]))
        owner = next((o for o in outer if is_inside([rings[o]], place)[0]), outer[-1])
        found[owner].append(loop)
    return [tuple(found[k]) for k in sorted(outer)]
