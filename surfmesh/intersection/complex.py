"""Vertices, edges and faces that share them by number, and where each face comes from."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadEdge, CadFace, CadModel, CadVertex
from surfmesh.geometry.quadrature import unit_rule
from surfmesh.geometry.small_matrices import product
from surfmesh.intersection.contents import region_area

GAUSS, WEIGHTS, PIECES = *unit_rule(5), 32
"""The rule on each piece of an edge, and how many pieces its length is summed over."""


class Origin(NamedTuple):
    """What a patch is of besides: source, original as of a `Patch`; is r_u x r_v of that face
    against that of the patch, and is that face reversed?"""

    source: int
    original: int
    against: bool
    reversed: bool


@dataclass(frozen=True, eq=False)
class Patch:
    """A face, or a part of one. source: the number of what was intersected; original: of the face
    there; also: the faces of others that coincide with it."""

    face: CadFace
    source: int
    original: int
    also: tuple[Origin, ...] = ()

    @property
    def origins(self) -> tuple[Origin, ...]:
        """All that it is of."""
        return (Origin(self.source, self.original, False, self.face.reversed), *self.also)

    def is_of(self, source: int) -> bool:
        """Is it a part of one of the inputs, also?"""
        return any(origin.source == source for origin in self.origins)


@dataclass(frozen=True, eq=False)
class Complex:
    """Patches with edges and vertices in common; an edge may have any number of patches."""

    vertices: Sequence[CadVertex]
    edges: Sequence[CadEdge]
    patches: Sequence[Patch]

    @staticmethod
    def of(model: CadModel, source: int, name: str) -> Complex:
        """All faces of a model, which is called ``name`` in messages."""
        patches = []
        for k, face in enumerate(model.faces):
            if face.surface.name != name:
                called = replace(face.surface, name=f"{name}, {face.surface.name}")
                face = replace(face, surface=called)
            patches.append(Patch(face, source, k))
        return Complex(model.vertices, model.edges, patches)


def compacted(
    vertices: Sequence[CadVertex], edges: Sequence[CadEdge], faces: Sequence[CadFace]
) -> tuple[list[CadVertex], list[CadEdge], list[CadFace]]:
    """Without the edges and vertices that no face uses, numbered anew in their order."""
    used = sorted({coedge.edge for face in faces for coedge in face.coedges})
    number = {edge: k for k, edge in enumerate(used)}
    ends = sorted({v for k in used for v in (edges[k].start, edges[k].end)})
    rank = {vertex: k for k, vertex in enumerate(ends)}
    kept = [replace(edges[k], start=rank[edges[k].start], end=rank[edges[k].end]) for k in used]
    numbered = [
        replace(
            face,
            loops=tuple(
                tuple(replace(coedge, edge=number[coedge.edge]) for coedge in loop)
                for loop in face.loops
            ),
        )
        for face in faces
    ]
    return [vertices[k] for k in ends], kept, numbered


def with_areas(faces: Sequence[CadFace]) -> list[CadFace]:
    """Faces that were cut, whose areas are nan, with them."""
    return [
        replace(face, area=region_area(face.surface, face.loops)) if math.isnan(face.area) else face
        for face in faces
    ]


def with_seams_marked(loops: Sequence[Sequence[CadCoedge]]) -> tuple[tuple[CadCoedge, ...], ...]:
    """Coedges that know whether the face uses their edge twice."""
    uses: dict[int, int] = {}
    for coedge in (coedge for loop in loops for coedge in loop):
        uses[coedge.edge] = uses.get(coedge.edge, 0) + 1
    return tuple(
        tuple(replace(coedge, seam=uses[coedge.edge] > 1) for coedge in loop) for loop in loops
    )


def part_of_edge(edge: CadEdge, first: float, last: float, start: int, end: int) -> CadEdge:
    """The edge between two fractions of its range; its length is measured."""
    t0, t1 = edge.parameters(np.array([first, last]))
    if edge.curve is None:
        return replace(edge, t0=float(t0), t1=float(t1), start=start, end=end)
    made = replace(edge, t0=float(t0), t1=float(t1), start=start, end=end)
    return replace(made, length=measured_length(made))


def measured_length(edge: CadEdge) -> float:
    """Of an edge that is not degenerate, model units."""
    fraction = (np.arange(PIECES)[:, None] + 0.5 * (GAUSS + 1.0)).ravel() / PIECES
    speed = np.linalg.norm(edge.evaluate(fraction, 1)[1], axis=1)
    weight = np.tile(0.5 * WEIGHTS, PIECES) / PIECES
    return float(product(speed, weight)) * (edge.t1 - edge.t0)
