"""Edges and vertices that are not as the model has them: more triangles, or more fans.

A surface has one or two triangles along each edge and one fan of them at each vertex, unless
its model says otherwise: sheets that meet in a T, boxes that share an edge or a corner.
"""

from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from surfmesh.quality.measures.topology import Topology
from surfmesh.result.mesh_parts import EdgeLinks
from surfmesh.result.model_facts import ModelFacts
from surfmesh.result.surface_mesh import SurfaceMesh


class Unexpected(NamedTuple):
    """Rows of ``mesh.edges``, and vertices."""

    crowded_edges: NDArray[np.intp]  # more triangles than faces use the edge, or than two
    bare_edges: NDArray[np.intp]  # fewer, along edges of the model
    pinched_vertices: NDArray[np.intp]  # more fans than the model has there, or than one
    joined_vertices: NDArray[np.intp]  # fewer
    clashing_edges: NDArray[np.intp]  # both triangles run along them the same way
    sheets_clashing: NDArray[np.intp]  # so they do between faces of no solid, as the model has it
    known: bool  # the model says how many there are


def unexpected(mesh: SurfaceMesh, topo: Topology) -> Unexpected:
    """What of ``topo`` is not as in the model; all of it where no model is known."""
    crowded = topo.crowded_edges.astype(np.intp)
    pinched, clashing = topo.pinched_vertices.astype(np.intp), topo.clashing_edges.astype(np.intp)
    none = np.empty(0, np.intp)
    model = _Model.of(mesh)
    if model is None:
        return Unexpected(crowded, none, pinched, none, clashing, none, False)
    table = mesh.connectivity
    row, used = model.uses(mesh)
    uses = np.bincount(row, used, len(mesh.edges))
    crowded = crowded[table.uses[crowded] > np.where(_often(row, crowded), uses[crowded], 2)]
    bare = np.flatnonzero(table.uses < uses)
    bare = bare[_often(row, bare) == 1]  # not two, where a face between them has vanished
    vertex, of_model = model.fans()
    fans = np.bincount(vertex, of_model, len(mesh.points))
    pinched = pinched[topo.fans[pinched] > fans[pinched]]
    joined = np.flatnonzero(topo.fans < fans)
    joined = joined[_often(vertex, joined) == 1]
    sheets = np.zeros(len(clashing), bool)
    if mesh.solid_ids is not None and len(clashing):
        beside = mesh.solid_ids[table.half_edges[clashing] // 3]
        sheets = (beside < 0).all(axis=(1, 2)) & (_often(row, clashing) > 0)
    return Unexpected(crowded, bare, pinched, joined, clashing[~sheets], clashing[sheets], True)


def _often(places: NDArray[np.integer[Any]], some: NDArray[np.intp]) -> NDArray[np.intp]:
    """(k,) how often each of ``some`` (k,) is among ``places``: 0 where the model has nothing."""
    if not len(some):
        return some
    return np.bincount(places, minlength=int(some.max()) + 1)[some]


class _Model(NamedTuple):
    """Where edges and vertices of the model lie in the mesh, and what they are like."""

    links: EdgeLinks
    facts: ModelFacts
    vertices: NDArray[np.int32]  # (c,) vertex of the mesh at each; -1: none

    @classmethod
    def of(cls, mesh: SurfaceMesh) -> Self | None:
        """None where it is not known."""
        facts, links, vertices = mesh.facts, mesh.edge_links, mesh.vertex_ids
        if facts is None or links is None or vertices is None:
            return None
        if len(vertices) > len(facts.vertex_fans):
            return None
        if int(links.edge_ids.max(initial=-1)) >= len(facts.edge_uses):
            return None
        return cls(links, facts, vertices)

    def uses(self, mesh: SurfaceMesh) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """The rows (k,) of edges of the mesh at each of the model, and how often faces use it."""
        row, edge = mesh.edge_segment_rows, self.links.edge_ids
        if row.min(initial=0) < 0:
            row, edge = row[row >= 0], edge[row >= 0]
        return row, np.array(self.facts.edge_uses, float)[edge]

    def fans(self) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
        """The vertices (k,) of the mesh at each of the model, and the fans that this has: where
        tiny edges have joined some, one stands for all."""
        fans = np.array(self.facts.vertex_fans, float)[: len(self.vertices)]
        kept = (self.vertices >= 0) & (fans > 0)
        return self.vertices[kept], fans[kept]
