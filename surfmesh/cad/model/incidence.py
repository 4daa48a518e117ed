"""How often faces use each edge, and how many fans they form at each vertex of a model.

A mesh that is what its model is has as many triangles along an edge as faces use it, and at a
vertex as many fans: two boxes that share a corner have two there.

            d \\    / c         Two loops of one face that meet in a vertex part its inside
          ///  \\  /  ///       into two sectors, b-c and d-a: between an edge that leaves the
        -- a --- V --- b --    vertex and the next one, counter-clockwise, that comes in.
          ///////////////
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadFace, CadModel
from surfmesh.cad.model.collapsed_edges import collapsed_edges, vanishes, vertex_numbers
from surfmesh.cad.model.curve_samples import walked
from surfmesh.cad.model.invariants import ENDS
from surfmesh.geometry.components import components

SAME_PLACE = 0.01  # of the (u, v) box: (u, v) of one vertex are as near, or a seam apart
BESIDE = 1e-3  # fraction of an edge's range at which its direction is seen
BACKWARDS = 1e-9  # radians: an edge that comes in as another leaves lies all round from it

End = tuple[int, bool]  # an end of an edge: its number, True where it ends


class _Passage(NamedTuple):
    """Where a loop goes through a vertex."""

    vertex: int
    into: CadCoedge
    out_of: CadCoedge
    direct: bool  # without an edge between that is but a point
    place: np.ndarray  # (2,) in (u, v) of the face, from where it goes on

    @property
    def ends(self) -> tuple[End, End]:
        """The ends of the edges by which the loop comes and goes."""
        return (self.into.edge, not self.into.reversed), (self.out_of.edge, self.out_of.reversed)


def edge_uses(model: CadModel) -> tuple[int, ...]:
    """How often faces use each edge: twice along a seam."""
    uses = [0] * len(model.edges)
    for face in model.faces:
        for coedge in face.coedges:
            uses[coedge.edge] += 1
    return tuple(uses)


def vertex_fans(model: CadModel) -> tuple[int, ...]:
    """Into how many fans the faces at each vertex fall that no edge joins; 0 where another
    vertex stands for this one, as only a tiny edge lies between."""
    number, collapsed = vertex_numbers(model), collapsed_edges(model)
    joined: list[tuple[End, End]] = []
    lone = [0] * len(model.vertices)
    of_vertex = number.tolist()

    starts = walked([coedge for face in model.faces for coedge in face.coedges], ENDS[:1])[:, 0]
    last = 0
    for face in model.faces:
        first, last = last, last + sum(map(len, face.loops))
        if vanishes(model, face):
            continue
        passages, points = _passages(model, face, of_vertex, collapsed, starts[first:last])
        for vertex in set(points) - {passage.vertex for passage in passages}:
            lone[vertex] += 1
        joined += _sectors(face, passages)
    fans = lone
    pairs = np.array(joined, np.int64).reshape(-1, 2, 2) @ (2, 1)  # ends: 2 edge + at its end
    for end in np.unique(components(2 * len(model.edges), pairs)[pairs]).tolist():
        edge = model.edges[end // 2]
        fans[number[edge.end if end % 2 else edge.start]] += 1
    return tuple(fans)


def _passages(
    model: CadModel, face: CadFace, number: list[int], collapsed: Sequence[bool],
    starts: np.ndarray,
) -> tuple[list[_Passage], list[int]]:  # fmt: skip
    """Where the loops of a face go through vertices, and the vertices that are loops of theirs.

    starts: (c, 2) where its coedges are entered, in (u, v).
    """
    passages, points = [], []
    first = 0
    for loop in face.loops:
        real = [k for k, c in enumerate(loop) if not collapsed[c.edge]]
        if not real and loop:
            points.append(number[model.edges[loop[0].edge].start])
        for k, following in zip(real, real[1:] + real[:1]):
            edge = model.edges[loop[k].edge]
            vertex = number[edge.start if loop[k].reversed else edge.end]
            direct = (following - k) % len(loop) == 1 % len(loop)
            place = starts[first + following]
            passages.append(_Passage(vertex, loop[k], loop[following], direct, place))
        first += len(loop)
    return passages, points


def _sectors(face: CadFace, passages: list[_Passage]) -> list[tuple[End, End]]:
    """Pairs of ends of edges between which the face lies."""
    at: dict[int, list[_Passage]] = {}
    found = []
    for passage in passages:
        if passage.direct:
            at.setdefault(passage.vertex, []).append(passage)
        else:  # about a pole
            found.append(passage.ends)
    for group in at.values():
        for here in _by_place(face, group) if len(group) > 1 else [group]:
            found += _between(here) if len(here) > 1 else [here[0].ends]
    return found


def _by_place(face: CadFace, group: list[_Passage]) -> list[list[_Passage]]:
    """Passages through one vertex, parted by their places in (u, v)."""
    (u0, u1), (v0, v1) = face.surface.domain
    near = SAME_PLACE * np.array([u1 - u0, v1 - v0])
    parts: list[tuple[np.ndarray, list[_Passage]]] = []
    for passage in group:
        place = passage.place
        for there, part in parts:
            if (np.abs(place - there) <= near).all():
                part.append(passage)
                break
        else:
            parts.append((place, [passage]))
    return [part for _, part in parts]


def _between(here: list[_Passage]) -> list[tuple[End, End]]:
    """The sectors at one place of (u, v); as the loops go where directions do not tell."""
    into = [_angle(passage.into, 1.0 - BESIDE, 1.0) for passage in here]
    leaving = [_angle(passage.out_of, BESIDE, 0.0) for passage in here]
    chosen = []
    for angle in leaving:
        turn = [(other - angle) % (2.0 * math.pi) for other in into]
        turn = [2.0 * math.pi if by < BACKWARDS else by for by in turn]
        chosen.append(min(range(len(here)), key=turn.__getitem__))
    if len(set(chosen)) < len(here):
        chosen = list(range(len(here)))
    return [(here[k].ends[0], passage.ends[1]) for k, passage in zip(chosen, here)]


def _angle(coedge: CadCoedge, fraction: float, vertex: float) -> float:
    """The direction in (u, v) from a vertex to a point of an edge beside it."""
    ahead, at = coedge.walk(np.array([fraction, vertex]))
    return math.atan2(ahead[1] - at[1], ahead[0] - at[0])
