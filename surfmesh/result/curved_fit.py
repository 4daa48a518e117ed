"""How far the quadratic triangles of a mesh lie from its surfaces, and their arcs from its curves.

Arcs are the sides that lie on CAD edges, or on the rim of a surface of formulas: a straight line of
its (u, v). What is seen there counts for all triangles at the arc.
"""

from collections.abc import Iterator
from functools import partial

import numpy as np
from numpy.typing import NDArray

from surfmesh.accuracy.curved_triangles import (
    CurvedDeviation,
    Curves,
    arc_deviations,
    curved_deviations,
)
from surfmesh.cad.model.cad_model import CadEdge
from surfmesh.geometry.surface import Surface
from surfmesh.result.quadratic_triangles import edge_rows
from surfmesh.result.surface_mesh import SurfaceMesh

ON_CURVE = 1e-3  # of an arc: so far off its curve may its ends be


def curved_fit(
    mesh: SurfaceMesh, limit: float = np.inf, chosen: NDArray[np.bool_] | None = None
) -> CurvedDeviation:
    """Of a mesh of second order with surfaces and parameters.

    limit: farther points are searched for anew. chosen: (m,) which triangles are looked at, all by
    default; of the others arcs alone.
    """
    nodes, uv = mesh.nodes[mesh.elements], mesh.uv
    assert uv is not None  # noqa: S101  for mypy: the caller has looked
    count = len(nodes)
    fit = CurvedDeviation(np.zeros(count), np.zeros(count), nodes[:, 0].copy(), uv[:, 0].copy())
    rows = np.arange(count) if chosen is None else np.flatnonzero(chosen)
    for face in np.unique(mesh.face_ids[rows]).tolist():
        own = rows[mesh.face_ids[rows] == face]
        found = curved_deviations(mesh.surfaces[face], nodes[own], uv[own], limit)
        for column, values in zip(fit, found):
            column[own] = values
    _look_along_arcs(mesh, fit)
    return fit


def _look_along_arcs(mesh: SurfaceMesh, fit: CurvedDeviation) -> None:
    """Raises the distances of triangles to those of their arcs, in place."""
    assert mesh.mid_points is not None  # noqa: S101  for mypy
    pairs = mesh.connectivity.half_edges
    for curves, rows, ends in arcs(mesh):
        first, last = mesh.points[ends.T]
        nodes = np.stack([first, mesh.mid_points[rows], last], axis=1)
        distance, place = arc_deviations(curves, nodes)
        off = np.linalg.norm(curves(np.zeros(len(rows)))[0] - nodes[:, 0], axis=1)
        length = np.linalg.norm(nodes[:, 2] - nodes[:, 0], axis=1)
        distance[off > ON_CURVE * length] = 0.0  # as after ``simplify``: it says nothing
        for half_edge in pairs[rows].T:
            triangle = half_edge // 3
            there = np.flatnonzero(half_edge >= 0)
            there = there[distance[there] > fit.largest[triangle[there]]]
            # two arcs of one triangle: the farther one is written last
            there = there[np.argsort(distance[there], kind="stable")]
            fit.largest[triangle[there]] = distance[there]
            fit.point[triangle[there]] = place[there]


def arcs(
    mesh: SurfaceMesh,
) -> Iterator[tuple[Curves, NDArray[np.int64], NDArray[np.integer]]]:
    """Curves of arcs (k), their rows (k,) of ``mesh.edges`` and ends (k, 2), from t = 0 to 1."""
    links = mesh.edge_links
    if links is None:
        yield from _arcs_of_rims(mesh)
        return
    if links.edge_parameters is None or not links.edge_curves:
        return
    rows = edge_rows(mesh.connectivity, links.edge_segments)
    for number in np.unique(links.edge_ids).tolist():
        own = np.flatnonzero((links.edge_ids == number) & (rows >= 0))
        edge = links.edge_curves[number]
        if edge.curve is None or edge.is_straight or not len(own):
            continue
        start, end = links.edge_parameters[own].T
        yield partial(_on_edge, edge, start, end), rows[own], links.edge_segments[own]


def _arcs_of_rims(
    mesh: SurfaceMesh,
) -> Iterator[tuple[Curves, NDArray[np.int64], NDArray[np.integer]]]:
    corners = mesh.parametrisation
    if corners is None or not mesh.surfaces:
        return
    rows = np.flatnonzero(mesh.connectivity.uses == 1)
    triangle, side = np.divmod(mesh.connectivity.half_edges[rows, 0], 3)
    at, after = np.arange(len(rows)), (side + 1) % 3
    uv = corners.uv_triangles[triangle]
    first, second = corners.uv_points[uv[at, side]], corners.uv_points[uv[at, after]]
    own = mesh.triangles[triangle]
    ends = np.column_stack([own[at, side], own[at, after]])
    faces = mesh.face_ids[triangle]
    for face in np.unique(faces).tolist():
        here = np.flatnonzero(faces == face)
        curves = partial(_on_line, mesh.surfaces[face], first[here], second[here])
        yield curves, rows[here], ends[here]


def _on_edge(
    edge: CadEdge, start: NDArray, end: NDArray, t: NDArray
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    points, slope = edge.evaluate(start + t * (end - start), 1)
    return points, slope * ((edge.t1 - edge.t0) * (end - start))[:, None]


def _on_line(
    surface: Surface, start: NDArray, end: NDArray, t: NDArray
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    step = end - start
    points, ru, rv = surface.evaluate(start + t[:, None] * step, 1)
    return points, step[:, :1] * ru + step[:, 1:] * rv
