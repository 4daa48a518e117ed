"""A node amid every edge of a mesh, on the true curve or surface, one for all its triangles.

    on a CAD edge      on its curve, as far from one end as from the other
    on the boundary    on the line between its ends in (u, v), as far from one as from the other
    within a face      the point of the surface that is closest to the middle of the chord

A triangle whose Jacobian might not be positive everywhere gets straight edges: within faces
first, and only where that does not do on curves too.
"""

from collections.abc import Callable
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from surfmesh.cad.model.cad_model import CadModel
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.result.quadratic_triangles import edge_rows, least_jacobians, six_nodes
from surfmesh.result.surface_mesh import SurfaceMesh

STEPS = 4  # of the search for the closest point, which starts well
HALVINGS = 30  # of the interval in which the middle of a curved segment lies
LEAST_JACOBIAN = 0.02  # of that of the straight triangle; below, edges are straightened


def of_second_order(mesh: SurfaceMesh, model: CadModel | None = None) -> SurfaceMesh:
    """``mesh`` with ``mid_points``; what had to be straightened is said in its ``warnings``.

    model: what a mesh of a CAD model was made of; without it, no node is put on curves.
    """
    start = perf_counter()
    middles = mesh.points[mesh.edges].mean(axis=1)
    fixed = np.zeros(len(middles), bool)  # on curves
    if mesh.surfaces and mesh.uv_points is not None:
        boundary = mesh.connectivity.uses == 1
        _on_surfaces(mesh, middles, ~boundary)
        _on_boundaries(mesh, middles, boundary)
        fixed |= boundary
    if model is not None and mesh.edge_parameters is not None:
        fixed[_on_curves(mesh, model, middles)] = True
    straight = _straightened(mesh, middles, fixed)
    notes = [f"{straight} edges of order 2 are straight, lest triangles fold"] if straight else []
    return mesh.replaced(
        mid_points=middles,
        warnings=(*mesh.warnings, *notes),
        seconds={**mesh.seconds, "order 2": perf_counter() - start},
    )


def _images(mesh: SurfaceMesh, rows: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """Faces (k,) and the parameters (k, 2) of both ends of edges, in their first triangle."""
    half = mesh.connectivity.half_edges[rows, 0]
    triangle, corner = half // 3, half % 3
    uv = mesh.uv_triangles[triangle]
    at = np.arange(len(rows))
    ends = mesh.uv_points[uv[at, corner]], mesh.uv_points[uv[at, (corner + 1) % 3]]
    return mesh.face_ids[triangle], *ends


def _on_surfaces(mesh: SurfaceMesh, middles: NDArray, wanted: NDArray) -> None:
    rows = np.flatnonzero(wanted)
    faces, first, second = _images(mesh, rows)
    for face in np.unique(faces).tolist():
        own = faces == face
        guess = 0.5 * (first[own] + second[own])
        found = closest_point(mesh.surfaces[face], middles[rows[own]], guess, STEPS)
        middles[rows[own]] = found[2]


def _on_boundaries(mesh: SurfaceMesh, middles: NDArray, wanted: NDArray) -> None:
    rows = np.flatnonzero(wanted)
    faces, first, second = _images(mesh, rows)
    for face in np.unique(faces).tolist():
        own = np.flatnonzero(faces == face)
        a, b, surface = first[own], second[own], mesh.surfaces[face]
        middles[rows[own]] = _halfway(
            lambda share, a=a, b=b, surface=surface: surface.evaluate(
                a + share[:, None] * (b - a), 0
            )[0],
            len(own),
        )


def _on_curves(mesh: SurfaceMesh, model: CadModel, middles: NDArray) -> NDArray:
    """Puts nodes on the curves of CAD edges; returns the rows of ``mesh.edges`` that lie there."""
    rows = edge_rows(mesh.connectivity, mesh.edge_segments)
    for number in np.unique(mesh.edge_ids).tolist():
        own = np.flatnonzero((mesh.edge_ids == number) & (rows >= 0))
        edge = model.edges[number]
        if edge.curve is None or not len(own):
            continue
        start, end = mesh.edge_parameters[own].T
        middles[rows[own]] = _halfway(
            lambda share, start=start, end=end, edge=edge: edge.evaluate(
                start + share * (end - start)
            )[0],
            len(own),
        )
    return rows[rows >= 0]


def _halfway(at: Callable[[NDArray], NDArray], count: int) -> NDArray:
    """Points (count, 3) of curves as far from the one end as from the other.

    at: shares (count,) from 0 to 1 -> points, one on each curve.
    """
    low, high = np.zeros(count), np.ones(count)
    a, b = at(low), at(high)
    for _ in range(HALVINGS):
        share = 0.5 * (low + high)
        point = at(share)
        nearer = np.linalg.norm(point - a, axis=1) < np.linalg.norm(point - b, axis=1)
        low, high = np.where(nearer, share, low), np.where(nearer, high, share)
    return at(0.5 * (low + high))


def _straightened(mesh: SurfaceMesh, middles: NDArray, fixed: NDArray) -> int:
    """Makes every triangle valid; returns how many edges have become straight."""
    elements = six_nodes(mesh.triangles, mesh.connectivity, len(mesh.points))
    of_edges = elements[:, 3:] - len(mesh.points)
    chords = mesh.points[mesh.edges].mean(axis=1)
    straight = np.zeros(len(middles), bool)
    for movable in (~fixed, np.ones(len(middles), bool)):
        while True:
            nodes = np.vstack((mesh.points, middles))
            bad = least_jacobians(nodes, elements) < LEAST_JACOBIAN
            if not bad.any():
                return int(straight.sum())
            turn = np.zeros(len(middles), bool)
            turn[of_edges[bad]] = True
            turn &= movable & ~straight & (middles != chords).any(axis=1)
            if not turn.any():
                break
            middles[turn] = chords[turn]
            straight |= turn
    return int(straight.sum())
