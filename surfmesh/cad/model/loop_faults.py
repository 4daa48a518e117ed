r"""What is wrong with the loops of a face however finely they are cut: decided on their curves.

    crosses           lies on another      touches             encloses nothing
      ___                ________            ______                ______
     | __|__            |  ____  |          |  /\  |              |      |
     ||__|__|           |_|____|_|          |_/__\_|              |      |  as a hole in nothing
     |___|              (part of a side)                          |______|

What edges do within their tolerance is no fault: finer cuts or small moves in (u, v) mend it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from weakref import WeakKeyDictionary

import numpy as np

from surfmesh.cad.model.cad_model import CadCoedge, CadEdge, CadFace, CadModel
from surfmesh.cad.model.empty_loops import empty_loop
from surfmesh.cad.model.loop_crossings import crossing_depth
from surfmesh.cad.model.loop_curves import NEAR, FaceLoops, LoopCurves
from surfmesh.cad.model.model_arrays import model_arrays
from surfmesh.geometry.planar.curve_contacts import Contact


@dataclass(frozen=True, eq=False)
class ExactLoops(FaceLoops):
    """The loops of a face as curves in (u, v); what is wrong with them is found when asked for."""

    stated: str = ""
    """What was found wrong with them before."""
    repeats: bool = True
    """May an edge be walked twice the same way?"""

    @property
    def may_be_wrong(self) -> bool:
        """Is ``at_once`` to be asked for?"""
        return bool(self.stated) or self.repeats

    @cached_property
    def at_once(self) -> str:
        """What is wrong with them at a glance: found when read, or an edge twice the same way."""
        return self.stated or (_walked_twice(self) if self.repeats else "")

    @cached_property
    def fault(self) -> str:
        """What no size can mend, with the place; empty when there is nothing."""
        return self.at_once or _fault(LoopCurves(self))

    @cached_property
    def touch(self) -> str:
        """Where loops touch in a point that is no common vertex; moves in (u, v) may mend it."""
        return _touch(LoopCurves(self))


_KNOWN: WeakKeyDictionary[CadModel, list[ExactLoops]] = WeakKeyDictionary()


def exact_loops(model: CadModel) -> list[ExactLoops]:
    """Of all faces of a model; vertices by the numbers that they have in a mesh."""
    if model not in _KNOWN:
        _KNOWN[model] = _exact_loops(model)
    return _KNOWN[model]


def _exact_loops(model: CadModel) -> list[ExactLoops]:
    arrays = model_arrays(model)
    edge, back = arrays.coedge_edge, arrays.coedge_reversed
    ends = np.where(back[:, None], arrays.mesh_ends[edge][:, ::-1], arrays.mesh_ends[edge])
    lowest = np.full(len(model.edges), len(model.faces))
    highest = np.full(len(model.edges), -1)
    np.minimum.at(lowest, edge, arrays.coedge_face)
    np.maximum.at(highest, edge, arrays.coedge_face)
    shared = (lowest < highest)[edge]
    ways = [(start, end) for start, end in ends.tolist()]
    way = 2 * (arrays.coedge_face * len(model.edges) + edge) + back
    _, which, times = np.unique(way, return_inverse=True, return_counts=True)
    repeats = np.zeros(len(model.faces), bool)
    repeats[arrays.coedge_face[times[which.reshape(-1)] > 1]] = True
    tolerances, uses = arrays.tolerance[edge].tolist(), shared.tolist()
    return [
        ExactLoops(
            face.surface, tuple(face.loops), tuple(ways[a:b]), tuple(tolerances[a:b]),
            tuple(uses[a:b]), face.fault, twice,
        )
        for face, twice, (a, b) in zip(
            model.faces, repeats.tolist(), pairwise(arrays.first_of_face.tolist())
        )
    ]  # fmt: skip


def fault_of_pieces(faces: Sequence[CadFace], edges: Sequence[CadEdge], vertices: int) -> str:
    """What is wrong with the loops of several faces that were cut from one, taken together."""
    loops = [loop for face in faces for loop in face.loops]
    shared = [False] * sum(map(len, loops))
    exact = _exact(faces[0], loops, edges, np.arange(vertices), shared)
    face_of = np.repeat(np.arange(len(faces)), [len(face.loops) for face in faces])
    return _fault_between(LoopCurves(exact), face_of)


def _exact(
    face: CadFace, loops: Sequence[tuple[CadCoedge, ...]], edges: Sequence[CadEdge],
    vertex: np.ndarray, shared: Sequence[bool],
) -> ExactLoops:  # fmt: skip
    ends, tolerances = [], []
    for coedge in (coedge for loop in loops for coedge in loop):
        edge = edges[coedge.edge]
        way = int(vertex[edge.start]), int(vertex[edge.end])
        ends.append(way[::-1] if coedge.reversed else way)
        tolerances.append(edge.tolerance)
    return ExactLoops(
        face.surface, tuple(loops), tuple(ends), tuple(tolerances), tuple(shared), face.fault
    )


def _fault(loops: LoopCurves) -> str:
    """In words, with the place, where curves lie on each other or cross, or enclose nothing."""
    for contact in loops.contacts:
        if contact.stretch:
            return f"{_names(loops, contact)} lie on each other near {_place(loops, contact)}"
    for contact in loops.contacts:
        depth = crossing_depth(loops, contact)
        if depth > 0.0:
            return f"{_names(loops, contact)} cross at {_place(loops, contact)}, {depth:.2g} deep"
    return empty_loop(loops)


def _fault_between(loops: LoopCurves, face_of: np.ndarray) -> str:
    """Of pieces of one face, by number (loops,): do their loops cross, or lie in each other?"""
    for contact in loops.contacts:
        one, other = (face_of[loops.loop_of[k]] for k in contact.curves)
        if one != other and crossing_depth(loops, contact) > 0.0:
            return f"{_names(loops, contact)} cross at {_place(loops, contact)}"
    return ""


def _touch(loops: LoopCurves) -> str:
    """In words, where curves without a common vertex touch."""
    for contact in loops.stray_contacts:
        one, other = contact.curves
        if not set(loops.of_face.ends[one]) & set(loops.of_face.ends[other]):
            return (
                f"{_names(loops, contact)} touch at {_place(loops, contact)}, where they have no "
                "common vertex"
            )
    return ""


def _walked_twice(exact: ExactLoops) -> str:
    """In words, when an edge is walked twice the same way and at the same place."""
    seen: dict[tuple[int, bool], CadCoedge] = {}
    for coedge in exact.coedges:
        other = seen.setdefault((coedge.edge, coedge.reversed), coedge)
        if other is not coedge:
            one, two = (c.uv(np.array([0.3])) for c in (other, coedge))
            extent = np.ptp(coedge.uv(np.linspace(0.0, 1.0, 5)), axis=0).max()
            if np.abs(one - two).max() <= NEAR * extent:
                return f"its edge {coedge.edge} is walked twice the same way"
    return ""


def _names(loops: LoopCurves, contact: Contact) -> str:
    one, other = (loops.coedges[k].edge for k in contact.curves)
    return f"its edge {one} and itself" if one == other else f"its edges {one} and {other}"


def _place(loops: LoopCurves, contact: Contact) -> str:
    return loops.point(contact.curves[0], float(np.mean(contact.fractions[0])))
