"""Edges so short that the mesh has one vertex in their place, and what becomes of their ends."""

from __future__ import annotations

from weakref import WeakKeyDictionary

import numpy as np

from surfmesh.cad.model.cad_model import CadEdge, CadFace, CadModel
from surfmesh.geometry.cad_surfaces.curves import TURN

COLLAPSED = 2e-6
"""Edges shorter than this fraction of the diagonal are one point: their faces meet in it."""

LOOSE = 20.0
"""And than so many tolerances of the edge and its ends."""

_KNOWN: WeakKeyDictionary[CadModel, tuple[bool, ...]] = WeakKeyDictionary()  # asked for often


def collapses(model: CadModel, edge: CadEdge) -> bool:
    """Is the edge so short that it is one vertex of the mesh?

    A closed one is the rim of a hole or a pin, however small, unless it lies within its vertex.
    """
    if edge.closed and not edge.degenerate and edge.curve is not None:
        vertex = model.vertices[edge.start]
        within = TURN * max(vertex.tolerance, edge.tolerance)
        return edge.length <= min(within, COLLAPSED * model.diagonal)
    loose = max(edge.tolerance, *(model.vertices[v].tolerance for v in (edge.start, edge.end)))
    return edge.degenerate or edge.length <= min(COLLAPSED * model.diagonal, LOOSE * loose)


def collapsed_edges(model: CadModel) -> tuple[bool, ...]:
    """For each edge whether it collapses."""
    if model not in _KNOWN:
        _KNOWN[model] = tuple(collapses(model, edge) for edge in model.edges)
    return _KNOWN[model]


def vertex_numbers(model: CadModel) -> np.ndarray:
    """For each CAD vertex the first one that tiny edges join it to, mostly itself."""
    number = np.arange(len(model.vertices))
    for edge, collapsed in zip(model.edges, collapsed_edges(model)):
        if collapsed and edge.start != edge.end:
            ends = number[edge.start], number[edge.end]
            if ends[0] != ends[1]:
                number[number == max(ends)] = min(ends)
    return number


def vanishes(model: CadModel, face: CadFace) -> bool:
    """Is a face one vertex of the mesh: all of its edges, and what they bound?"""
    tiny = face.area <= (COLLAPSED * model.diagonal) ** 2
    return tiny and all(collapses(model, model.edges[coedge.edge]) for coedge in face.coedges)
