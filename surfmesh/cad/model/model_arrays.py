"""A model as arrays over all its vertices, edges and coedges: made once for each model.

edges      0 .. e - 1, as in the model
coedges    0 .. c - 1: face after face, loop after loop, in walking order
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np

from surfmesh._core.edges import CurvePieces
from surfmesh._core.faces import CoedgeTable
from surfmesh.cad.model.cad_model import CadCoedge, CadModel
from surfmesh.cad.model.collapsed_edges import collapsed_edges, vertex_numbers

_KNOWN: WeakKeyDictionary[CadModel, ModelArrays] = WeakKeyDictionary()  # asked for every round


def model_arrays(model: CadModel) -> ModelArrays:
    """The arrays of a model."""
    if model not in _KNOWN:
        _KNOWN[model] = ModelArrays.of(model)
    return _KNOWN[model]


@dataclass(frozen=True, eq=False)
class ModelArrays:
    corners: np.ndarray
    """(v, 3) points of the vertices."""
    vertex: np.ndarray
    """(v,) for each vertex the number that it has in a mesh."""
    ends: np.ndarray
    """(e, 2) int64, vertices where the edges start and end."""
    length: np.ndarray
    """(e,) model units."""
    straight: np.ndarray
    """(e,) bool."""
    collapsed: np.ndarray
    """(e,) bool: the edge is one vertex of a mesh."""
    tolerance: np.ndarray
    """(e,) of the edges, model units."""
    curves: CurvePieces
    """Of the edges in space."""
    coedges: tuple[CadCoedge, ...]
    coedge_edge: np.ndarray
    """(c,) int64."""
    coedge_face: np.ndarray
    """(c,) int64."""
    first_of_face: np.ndarray
    """(f + 1,) int64: coedges of each face."""
    first_of_loop: np.ndarray
    """(l + 1,) int64: coedges of each loop of all faces."""
    first_loop_of_face: np.ndarray
    """(f + 1,) int64: loops of each face."""
    area: np.ndarray
    """(f,) of the faces, model units squared."""

    @cached_property
    def edges_of_faces(self) -> tuple[np.ndarray, np.ndarray]:
        """(f + 1,) where those of each face begin, and (k,) the edges of faces that are not
        collapsed, each once in a face, rising."""
        there = ~self.collapsed[self.coedge_edge]
        count = len(self.collapsed)
        both = np.unique(self.coedge_face[there] * count + self.coedge_edge[there])
        first = np.searchsorted(both, np.arange(len(self.area) + 1) * count)
        return first, both % max(count, 1)

    @cached_property
    def has_coedges(self) -> np.ndarray:
        """(f,) bool: the face has a boundary."""
        return np.diff(self.first_of_face) > 0

    @cached_property
    def around(self) -> np.ndarray:
        """(f,) lengths of the boundaries of the faces, model units."""
        length = np.where(self.collapsed, 0.0, self.length)[self.coedge_edge]
        return np.bincount(self.coedge_face, length, len(self.area))

    @cached_property
    def successions(self) -> tuple[np.ndarray, np.ndarray]:
        """Coedges (k,) of edges that are not collapsed, and those that follow them (k,) in their
        loops, past collapsed ones; not the ones of an edge that follows itself."""
        loop = np.repeat(np.arange(len(self.first_of_loop) - 1), np.diff(self.first_of_loop))
        one = np.flatnonzero(~self.collapsed[self.coedge_edge])
        starts = np.flatnonzero(np.r_[len(one) > 0, np.diff(loop[one]) != 0])
        following = np.arange(1, len(one) + 1)
        following[np.r_[starts[1:], len(one)][: len(starts)] - 1] = starts  # of the last one
        other = one[following]
        apart = self.coedge_edge[one] != self.coedge_edge[other]
        return one[apart], other[apart]

    @classmethod
    def of(cls, model: CadModel) -> ModelArrays:
        edges, faces = model.edges, model.faces
        loops = [loop for face in faces for loop in face.loops]
        coedges = tuple(coedge for loop in loops for coedge in loop)
        of_face = np.array([sum(map(len, face.loops)) for face in faces], np.int64)
        curves = [None if edge.curve is None else edge.curve.core for edge in edges]
        return cls(
            np.array([vertex.point for vertex in model.vertices], float).reshape(-1, 3),
            vertex_numbers(model),
            np.array([(edge.start, edge.end) for edge in edges], np.int64).reshape(-1, 2),
            np.array([edge.length for edge in edges], float),
            np.array([edge.is_straight for edge in edges], bool),
            np.array(collapsed_edges(model), bool),
            np.array([edge.tolerance for edge in edges], float),
            _pieces(curves, [(edge.t0, edge.t1) for edge in edges]),
            coedges,
            np.array([coedge.edge for coedge in coedges], np.int64),
            np.repeat(np.arange(len(faces)), of_face),
            offsets(of_face),
            offsets(np.array([len(loop) for loop in loops], np.int64)),
            offsets(np.array([len(face.loops) for face in faces], np.int64)),
            np.array([face.area for face in faces], float),
        )

    @cached_property
    def mesh_ends(self) -> np.ndarray:
        """(e, 2) int64, the ends of the edges by the numbers that vertices have in a mesh."""
        return self.vertex[self.ends]

    @cached_property
    def bent_edges(self) -> np.ndarray:
        """(k,) edges that are neither straight nor collapsed, rising."""
        return np.flatnonzero(~self.straight & ~self.collapsed)

    @cached_property
    def is_closed(self) -> np.ndarray:
        """(e,) bool: the edge starts and ends at one vertex of a mesh."""
        return self.mesh_ends[:, 0] == self.mesh_ends[:, 1]

    @cached_property
    def has_twin(self) -> np.ndarray:
        """(e,) bool: another edge joins the same two vertices of a mesh."""
        there = ~self.collapsed
        ends = np.sort(self.mesh_ends[there], axis=1)
        code = ends @ np.array([len(self.corners), 1])
        _, group, count = np.unique(code, return_inverse=True, return_counts=True)
        found = np.zeros(len(there), bool)
        found[there] = count[group.reshape(-1)] > 1
        return found

    @cached_property
    def coedges_of_edges(self) -> tuple[np.ndarray, np.ndarray]:
        """(e + 1,) where the coedges of each edge begin, and these (c,), edge after edge."""
        count = np.bincount(self.coedge_edge, minlength=len(self.length))
        return offsets(count), np.argsort(self.coedge_edge, kind="stable")

    @cached_property
    def pcurves(self) -> CurvePieces:
        """Of the coedges, in the (u, v) of their faces; parameters run as those of the edges."""
        curves = [coedge.pcurve.core for coedge in self.coedges]
        return _pieces(curves, [(coedge.p0, coedge.p1) for coedge in self.coedges])

    @cached_property
    def coedge_table(self) -> CoedgeTable:
        """What boundaries of faces are made from, when the edges are cut."""
        return CoedgeTable(
            self.pcurves, self.coedge_edge, self.coedge_reversed.view(np.uint8),
            self.first_of_loop, self.first_loop_of_face, self.tolerance,
            np.ascontiguousarray(self.mesh_ends[:, 0]), self.corners,
        )  # fmt: skip

    @cached_property
    def coedge_reversed(self) -> np.ndarray:
        """(c,) bool."""
        return np.array([coedge.reversed for coedge in self.coedges], bool)


def offsets(counts: np.ndarray) -> np.ndarray:
    """Where rows of so many (n,) begin, and how many there are in all: (n + 1,) int64."""
    found = np.zeros(len(counts) + 1, np.int64)
    counts.cumsum(out=found[1:])
    return found


def counts_of(first: np.ndarray) -> np.ndarray:
    """How many rows there are from each offset to the next: (n,) of (n + 1,)."""
    return first[1:] - first[:-1]


def _pieces(curves: list, limits: list[tuple[float, float]]) -> CurvePieces:
    t0, t1 = np.array(limits, float).reshape(-1, 2).T
    return CurvePieces(curves, np.ascontiguousarray(t0), np.ascontiguousarray(t1))
