"""What a CAD model knows of itself and its mesh can be held to: areas, volumes, Euler numbers."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from surfmesh.cad.model import CadFace, CadModel
from surfmesh.model_facts import FaceFacts, ModelFacts, SolidFacts

SAME_PLACE = 0.01  # of the (u, v) box: images of one vertex are as near, or a seam apart


def model_facts(model: CadModel) -> ModelFacts:
    """Exact figures of a model, of each face and each solid."""
    solids = []
    for solid in model.solids:
        faces = {face for shell in solid.shells for face, _ in shell}
        area = math.fsum(model.faces[face].area for face in faces)
        euler = euler_number(model, faces)
        solids.append(SolidFacts(solid.name, area, solid.volume, euler, solid.closed))
    return ModelFacts(
        source=model.source,
        sha256=model.sha256 or None,
        unit=model.unit,
        area=model.area,
        volume=model.volume if model.solids else None,
        euler=euler_number(model, range(len(model.faces))),
        faces=tuple(FaceFacts(face.kind, face.area) for face in model.faces),
        solids=tuple(solids),
        healing=model.healing,
    )


def euler_number(model: CadModel, faces: Iterable[int]) -> int:
    """V - E + F of what these faces form, a face with L loops counted as 2 - L.

    A seam is one edge, a degenerate edge only its vertex: so a sphere has two vertices, one
    edge and one face.
    """
    vertices, edges = set(), set()
    inside = 0
    for number in faces:
        face = model.faces[number]
        for coedge in face.coedges:
            edge = model.edges[coedge.edge]
            vertices |= {edge.start, edge.end}
            if not edge.degenerate:
                edges.add(coedge.edge)
        inside += 2 - _borders(model, face)
    return len(vertices) - len(edges) + inside


def _borders(model: CadModel, face: CadFace) -> int:
    """Number of loops, those that touch in a vertex counted as one."""
    if len(face.loops) < 2:
        return len(face.loops)
    (u0, u1), (v0, v1) = face.surface.domain
    near = SAME_PLACE * np.array([u1 - u0, v1 - v0])
    passed: dict[int, list[tuple[int, np.ndarray]]] = {}
    of = list(range(len(face.loops)))
    for loop, coedges in enumerate(face.loops):
        for coedge in coedges:
            edge = model.edges[coedge.edge]
            vertex = edge.end if coedge.reversed else edge.start
            place = coedge.walk(np.zeros(1))[0]
            for other, there in passed.setdefault(vertex, []):
                if of[other] != of[loop] and (np.abs(place - there) <= near).all():
                    joined = of[other], of[loop]
                    of = [min(joined) if k in joined else k for k in of]
            passed[vertex].append((loop, place))
    return len(set(of))
