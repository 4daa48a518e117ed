"""What a CAD model knows of itself and its mesh can be held to: areas, volumes, Euler numbers."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable
from weakref import WeakKeyDictionary

import numpy as np

from surfmesh.cad.model.cad_model import CadFace, CadModel
from surfmesh.cad.model.collapsed_edges import collapsed_edges, vanishes, vertex_numbers
from surfmesh.cad.model.curve_samples import walked
from surfmesh.cad.model.incidence import SAME_PLACE, edge_uses, vertex_fans
from surfmesh.cad.model.invariants import signed_areas
from surfmesh.cad.model.loops import closes
from surfmesh.result.model_facts import FaceFacts, ModelFacts, SolidFacts

_KNOWN: WeakKeyDictionary[CadModel, ModelFacts] = WeakKeyDictionary()  # asked for every round


def model_facts(model: CadModel) -> ModelFacts:
    """Exact figures of a model, of each face and each solid."""
    if model not in _KNOWN:
        _KNOWN[model] = _model_facts(model)
    return _KNOWN[model]


def _model_facts(model: CadModel) -> ModelFacts:
    solids = []
    numbers = _EulerNumbers(model)
    for solid in model.solids:
        faces = {face for shell in solid.shells for face, _ in shell}
        area = math.fsum(model.faces[face].area for face in faces)
        euler = numbers.of(faces)
        solids.append(SolidFacts(solid.name, area, solid.volume, euler, solid.closed))
    return ModelFacts(
        source=model.source,
        sha256=model.sha256 or None,
        unit=model.unit,
        area=model.area,
        volume=model.volume if model.solids else None,
        euler=numbers.of(range(len(model.faces))),
        faces=tuple(FaceFacts(face.kind, face.area) for face in model.faces),
        solids=tuple(solids),
        edge_uses=edge_uses(model),
        vertex_fans=vertex_fans(model),
        healing=model.healing,
    )


def euler_number(model: CadModel, faces: Iterable[int]) -> int:
    """V - E + F of what these faces form, a face with L loops counted as 2 - L.

    One with islands, or with outer loops beside each other, is several pieces: 2 for each.

    A seam is one edge, a degenerate edge only its vertex: so a sphere has two vertices, one
    edge and one face. So is an edge that the mesh has as one vertex, being tiny.
    """
    return _EulerNumbers(model).of(faces)


class _EulerNumbers:
    """Those of any faces of a model; what a face adds inside is found once."""

    def __init__(self, model: CadModel) -> None:
        self.model = model
        self._number = vertex_numbers(model).tolist()
        self._collapsed = collapsed_edges(model)
        self._inside: dict[int, int] = {}

    def of(self, faces: Iterable[int]) -> int:
        """V - E + F, see ``euler_number``."""
        vertices, edges = set(), set()
        inside = 0
        for number in faces:
            for coedge in self.model.faces[number].coedges:
                edge = self.model.edges[coedge.edge]
                vertices |= {self._number[edge.start], self._number[edge.end]}
                if not self._collapsed[coedge.edge]:
                    edges.add(coedge.edge)
            if number not in self._inside:
                self._inside[number] = self._inside_of(self.model.faces[number])
            inside += self._inside[number]
        return len(vertices) - len(edges) + inside

    def _inside_of(self, face: CadFace) -> int:
        if vanishes(self.model, face):
            return 0
        return 2 * _pieces(self.model, face) - _borders(self.model, face, self._number)


def _pieces(model: CadModel, face: CadFace) -> int:
    """How many outer loops it has, those apart from which touch others."""
    if len(face.loops) < 2:
        return 1
    ends = [
        {v for c in loop for v in (model.edges[c.edge].start, model.edges[c.edge].end)}
        for loop in face.loops
    ]
    extent = np.ptp(np.array(face.surface.domain), axis=1)
    uses = Counter(vertex for own in ends for vertex in own)
    return 1 + sum(
        area > 0.0
        and all(uses[vertex] == 1 for vertex in own)
        and max(Counter(c.edge for c in loop).values()) == 1
        and closes(loop, extent)
        for loop, own, area in zip(face.loops[1:], ends[1:], signed_areas(face.loops[1:]))
    )


def _borders(model: CadModel, face: CadFace, number: list[int]) -> int:
    """Number of loops, those that touch in a vertex counted as one."""
    if len(face.loops) < 2:
        return len(face.loops)
    (u0, u1), (v0, v1) = face.surface.domain
    near = SAME_PLACE * np.array([u1 - u0, v1 - v0])
    starts = iter(walked(list(face.coedges), np.zeros(1))[:, 0])
    passed: dict[int, list[tuple[int, np.ndarray]]] = {}
    of = list(range(len(face.loops)))
    for loop, coedges in enumerate(face.loops):
        for coedge, place in zip(coedges, starts):
            edge = model.edges[coedge.edge]
            vertex = number[edge.end if coedge.reversed else edge.start]
            for other, there in passed.setdefault(vertex, []):
                if of[other] != of[loop] and (np.abs(place - there) <= near).all():
                    joined = of[other], of[loop]
                    of = [min(joined) if k in joined else k for k in of]
            passed[vertex].append((loop, place))
    return len(set(of))
