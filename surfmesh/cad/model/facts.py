"""What a CAD model knows of itself and its mesh can be held to: areas, volumes, Euler numbers."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from weakref import WeakKeyDictionary

import numpy as np

from surfmesh.cad.model.cad_model import CadFace, CadModel
from surfmesh.cad.model.collapsed_edges import collapsed_edges, vanishes, vertex_numbers
from surfmesh.cad.model.curve_samples import walked
from surfmesh.cad.model.incidence import SAME_PLACE, edge_uses, vertex_fans
from surfmesh.cad.model.invariants import signed_areas
from surfmesh.cad.model.loops import closes
from surfmesh.geometry.inside_loops import is_inside
from surfmesh.result.model_facts import FaceFacts, ModelFacts, SolidFacts

_KNOWN: WeakKeyDictionary[CadModel, ModelFacts] = WeakKeyDictionary()  # asked for every round

_ALONG = np.linspace(0.0, 1.0, 24, endpoint=False)
"""Of an edge: where its loop has corners as a polygon."""


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

    One with islands, or with outer loops beside each other, has several components: 2 for each.
    Loops of one component that meet in a vertex cut a way between them: 1 for each meeting.

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
        """Of its components without their borders: 2 for each, less one for each border."""
        if vanishes(self.model, face):
            return 0
        if len(face.loops) < 2:
            return 2 - len(face.loops)
        components = _components(face, self._collapsed)
        touches = sum(
            len(loops) - len({components[loop] for loop in loops})
            for loops in _meetings(self.model, face, self._number)
        )
        return 2 * len(set(components)) - len(face.loops) + touches


def _components(face: CadFace, collapsed: Sequence[bool]) -> list[int]:
    """For each loop the outer one of the component of the face that it bounds.

    Of two outer loops around a hole the smaller counts: an island lies within its hole.
    """
    extent = np.ptp(np.array(face.surface.domain), axis=1)
    areas = signed_areas(face.loops)
    outer = [0] + [
        number
        for number, (loop, area) in enumerate(zip(face.loops, areas))
        if number > 0
        and area > 0.0
        and max(Counter(c.edge for c in loop).values()) == 1
        and closes(loop, extent)
        and not all(collapsed[c.edge] for c in loop)
    ]
    components = list(range(len(face.loops)))
    if len(outer) == 1:
        return [0] * len(components)
    polygons = [walked(list(loop), _ALONG).reshape(-1, 2) for loop in face.loops]
    around = sorted(outer[1:], key=lambda number: areas[number])
    for number in set(components) - set(outer):
        holds = (k for k in around if np.mean(is_inside([polygons[k]], polygons[number])) > 0.5)
        components[number] = next(holds, 0)
    return components


def _meetings(model: CadModel, face: CadFace, number: list[int]) -> list[set[int]]:
    """The loops of a face at each place of (u, v) where they pass through a vertex.

    Where two that bound one component do, the way between them is cut.
    """
    (u0, u1), (v0, v1) = face.surface.domain
    near = SAME_PLACE * np.array([u1 - u0, v1 - v0])
    starts = iter(walked(list(face.coedges), np.zeros(1))[:, 0])
    passed: dict[int, list[tuple[np.ndarray, set[int]]]] = {}
    for loop, coedges in enumerate(face.loops):
        for coedge, place in zip(coedges, starts):
            edge = model.edges[coedge.edge]
            places = passed.setdefault(number[edge.end if coedge.reversed else edge.start], [])
            for there, loops in places:
                if (np.abs(place - there) <= near).all():
                    loops.add(loop)
                    break
            else:
                places.append((place, {loop}))
    return [loops for places in passed.values() for _, loops in places]
