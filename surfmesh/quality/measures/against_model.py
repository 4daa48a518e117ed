"""Edges and vertices that are not as the model has them: more triangles, or more fans.

A surface has one or two triangles along each edge and one fan of them at each vertex, unless
its model says otherwise: sheets that meet in a T, boxes that share an edge or a corner.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.quality.measures.topology import Topology
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
    if not _knows_model(mesh):
        return Unexpected(crowded, none, pinched, none, clashing, none, False)
    uses, models = _model_uses(mesh)
    table = mesh.connectivity
    crowded = np.flatnonzero(table.uses > np.where(models > 0, np.maximum(uses, 2), 2))
    bare = np.flatnonzero((models == 1) & (table.uses < uses))
    fans, vertices = _model_fans(mesh)
    pinched = np.flatnonzero(topo.fans > np.maximum(fans, 1))
    joined = np.flatnonzero((vertices == 1) & (topo.fans < fans))
    sheets = np.zeros(len(clashing), bool)
    if mesh.solid_ids is not None:
        beside = mesh.solid_ids[table.half_edges[clashing] // 3]
        sheets = (beside < 0).all(axis=(1, 2)) & (models[clashing] > 0)
    return Unexpected(crowded, bare, pinched, joined, clashing[~sheets], clashing[sheets], True)


def _knows_model(mesh: SurfaceMesh) -> bool:
    facts = mesh.facts
    if facts is None or mesh.edge_segments is None or mesh.edge_ids is None:
        return False
    if mesh.vertex_ids is None or len(mesh.vertex_ids) > len(facts.vertex_fans):
        return False
    return not len(mesh.edge_ids) or int(mesh.edge_ids.max()) < len(facts.edge_uses)


def _model_uses(mesh: SurfaceMesh) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """How often faces of the model use each edge of the mesh (ne,), and how many edges of the
    model lie there (ne,): 0 within a face, two where a face between them has vanished."""
    edges = mesh.connectivity.edges
    width = np.array([len(mesh.points), 1], np.int64)
    keys, wanted = edges @ width, np.sort(mesh.edge_segments, axis=1) @ width
    row = np.minimum(np.searchsorted(keys, wanted), max(len(keys) - 1, 0))
    there = keys[row] == wanted if len(keys) else np.zeros(len(wanted), bool)
    uses = np.array(mesh.facts.edge_uses, np.int64)[mesh.edge_ids[there]]
    total = np.bincount(row[there], uses, len(edges)).astype(np.int64)
    return total, np.bincount(row[there], minlength=len(edges))


def _model_fans(mesh: SurfaceMesh) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Fans of the model at each vertex of the mesh (n,), and how many of its vertices stand
    there (n,): where tiny edges have joined some, one stands for all."""
    fans = np.array(mesh.facts.vertex_fans, np.int64)[: len(mesh.vertex_ids)]
    kept = (mesh.vertex_ids >= 0) & (fans > 0)
    at, count = mesh.vertex_ids[kept], len(mesh.points)
    return (
        np.bincount(at, fans[kept], count).astype(np.int64),
        np.bincount(at, minlength=count),
    )
