"""A node amid every edge of a mesh, on the true curve or surface, one for all its triangles.

    on a CAD edge      on its curve, as far from one end as from the other
    on the boundary    on the line between its ends in (u, v), as far from one as from the other
    within a face      the point of the surface that is closest to the middle of the chord

A triangle whose Jacobian might not be positive everywhere gets straight edges: within faces
first, and only where that does not do on curves too.
"""

from collections.abc import Callable, Iterator
from functools import partial
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from surfmesh.cad.model.cad_model import CadEdge
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.finishing.mid_nodes import slid_nodes
from surfmesh.result.mesh_parts import EdgeLinks, Parametrisation
from surfmesh.result.quadratic_triangles import edge_rows, least_jacobians, six_nodes
from surfmesh.result.surface_mesh import SurfaceMesh

STEPS = 4  # of the search for the closest point, which starts well
HALVINGS = 30  # of the interval in which the middle of a curved segment lies
LEAST_JACOBIAN = 0.02  # of that of the straight triangle; below, edges are straightened


def of_second_order(mesh: SurfaceMesh) -> SurfaceMesh:
    """``mesh`` with ``mid_points``; what had to be straightened is said in its ``warnings``."""
    start = perf_counter()
    middles = mesh.points[mesh.edges].mean(axis=1)
    if mesh.surfaces and mesh.parametrisation is not None:
        within = mesh.connectivity.uses != 1
        for surface, own, first, second in _by_surface(mesh, mesh.parametrisation, within):
            guess = 0.5 * (first + second)
            middles[own] = closest_point(surface, middles[own], guess, STEPS)[2]
    fixed = put_on_curves(mesh, middles)
    if mesh.sizing is not None and mesh.sizing.is_curved and mesh.surfaces:
        middles = slid_nodes(mesh, middles, fixed)
    straight = _straightened(mesh, middles, fixed)
    notes = [f"{straight} edges of order 2 are straight, lest triangles fold"] if straight else []
    return mesh.replaced(
        mid_points=middles,
        warnings=(*mesh.warnings, *notes),
        seconds={**mesh.seconds, "order 2": perf_counter() - start},
    )


def put_on_curves(mesh: SurfaceMesh, middles: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Puts nodes amid edges (ne, 3) on the curves that these stand for, on the boundary and along
    CAD edges; returns which edges (ne,) lie there."""
    fixed = np.zeros(len(middles), bool)
    if mesh.surfaces and mesh.parametrisation is not None:
        fixed |= mesh.connectivity.uses == 1
        for surface, own, first, second in _by_surface(mesh, mesh.parametrisation, fixed):
            middles[own] = _halfway(partial(_on_surface, surface, first, second), len(own))
    if mesh.edge_links is not None:
        fixed[_on_curves(mesh, mesh.edge_links, middles)] = True
    return fixed


def _by_surface(
    mesh: SurfaceMesh, corners: Parametrisation, wanted: NDArray[np.bool_]
) -> Iterator[tuple[Surface, NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]]:
    """For each surface: the rows (k,) of ``mesh.edges`` that are ``wanted``, and the parameters
    (k, 2) of both their ends in the first triangle."""
    rows = np.flatnonzero(wanted)
    half = mesh.connectivity.half_edges[rows, 0]
    triangle, corner = half // 3, half % 3
    uv = corners.uv_triangles[triangle]
    at = np.arange(len(rows))
    first, second = corners.uv_points[uv[at, corner]], corners.uv_points[uv[at, (corner + 1) % 3]]
    faces = mesh.face_ids[triangle]
    for face in np.unique(faces).tolist():
        own = np.flatnonzero(faces == face)
        yield mesh.surfaces[face], rows[own], first[own], second[own]


def _on_surface(surface: Surface, a: NDArray, b: NDArray, t: NDArray) -> NDArray[np.float64]:
    return surface.evaluate(a + t[:, None] * (b - a), 0)[0]


def _on_curve(edge: CadEdge, a: NDArray, b: NDArray, t: NDArray) -> NDArray[np.float64]:
    return edge.evaluate(a + t * (b - a))[0]


def _on_curves(mesh: SurfaceMesh, links: EdgeLinks, middles: NDArray) -> NDArray[np.int64]:
    """Puts nodes on the curves of CAD edges; returns the rows of ``mesh.edges`` that lie there."""
    if links.edge_parameters is None or not links.edge_curves:
        return np.empty(0, np.int64)
    rows = edge_rows(mesh.connectivity, links.edge_segments)
    for number in np.unique(links.edge_ids).tolist():
        own = np.flatnonzero((links.edge_ids == number) & (rows >= 0))
        edge = links.edge_curves[number]
        if edge.curve is None or not len(own):
            continue
        start, end = links.edge_parameters[own].T
        middles[rows[own]] = _halfway(partial(_on_curve, edge, start, end), len(own))
    return rows[rows >= 0]


def _halfway(at: Callable[[NDArray], NDArray], count: int) -> NDArray:
    """Points (count, 3) of curves as far from the one end as from the other.

    at: t (count,) from 0 to 1 -> points, one on each curve.
    """
    low, high = np.zeros(count), np.ones(count)
    a, b = at(low), at(high)
    for _ in range(HALVINGS):
        t = 0.5 * (low + high)
        point = at(t)
        nearer = np.linalg.norm(point - a, axis=1) < np.linalg.norm(point - b, axis=1)
        low, high = np.where(nearer, t, low), np.where(nearer, high, t)
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
            chosen = np.zeros(len(middles), bool)
            chosen[of_edges[bad]] = True
            chosen &= movable & ~straight & (middles != chords).any(axis=1)
            if not chosen.any():
                break
            middles[chosen] = chords[chosen]
            straight |= chosen
    return int(straight.sum())
