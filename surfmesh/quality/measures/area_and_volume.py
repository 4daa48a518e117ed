"""How much area and volume a mesh loses or wins by its deviation from the surface.

    volume   the sum over triangles of area times distance; facets of a ball lose two thirds of it
    area     of a triangle of height h at the distance d, about (4 d / h)^2 / 2 of its area by its
             slant and as much by its depth; and along rims length times sagitta: all that plane
             faces lose

What is more than that is lost (``verdict/area_and_volume``).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core import quality
from surfmesh.quality.measures.penetration import edge_sagittas
from surfmesh.quality.measures.topology import half_edges_along
from surfmesh.result.surface_mesh import SurfaceMesh

SLANT = 16.0  # of (d / h)^2: what a triangle's area may differ by, of its own
SHARPEST = 0.1  # sine of the least angle between faces that tells where their edge is
CORNER = np.radians(60.0)  # a rim with a larger angle has a corner there


class Explained(NamedTuple):
    """What distances from the surface explain, in model units."""

    area: NDArray[np.float64]  # (m,) of each triangle
    rims: NDArray[np.float64]  # (f,) of each face, along its rims
    volume: NDArray[np.float64]  # (m,)


def is_known(mesh: SurfaceMesh) -> bool:
    """Is there an exact area or volume to compare with?"""
    facts = mesh.facts
    return facts is not None and bool(facts.area or facts.faces or facts.solids)


def explained(
    mesh: SurfaceMesh, area: NDArray[np.float64], by_triangle: NDArray[np.float64]
) -> Explained:
    """area: (m,) of the triangles; by_triangle: (m,) their distances from the surface."""
    lost, volume = quality.explained_losses(mesh.points, mesh.triangles, area, by_triangle, SLANT)
    if mesh.mid_points is not None:
        lost = np.minimum(lost + area * by_triangle * _bends(mesh, mesh.mid_points), area)
    return Explained(lost, _along_rims(mesh, by_triangle), volume)


def _bends(mesh: SurfaceMesh, mid_points: NDArray[np.float64]) -> NDArray[np.float64]:
    """(m,) twice the largest curvature of the sides of quadratic triangles: a surface at a distance
    has so much more area or less."""
    ends = mesh.points[mesh.edges]
    squared = ((ends[:, 1] - ends[:, 0]) ** 2).sum(axis=1)
    bend = np.linalg.norm(mid_points - ends.mean(axis=1), axis=1)
    bent = 16.0 * bend / np.maximum(squared, np.finfo(float).tiny)
    return bent[mesh.elements[:, 3:] - len(mesh.points)].max(axis=1)


def _along_rims(mesh: SurfaceMesh, by_triangle: NDArray[np.float64]) -> NDArray[np.float64]:
    """(f,) length times sagitta along the rims of each face."""
    table = mesh.connectivity
    sagitta = np.zeros(len(table.edges))
    rim = table.uses == 1
    links = mesh.edge_links
    if links is None or not len(links.edge_segments):
        sagitta[rim] = _rim_sagittas(mesh, rim)
    else:
        row = mesh.edge_segment_rows
        on = row >= 0
        np.maximum.at(sagitta, row[on], edge_sagittas(mesh, links)[on])
        rim[row[on]] = True
    lost = quality.rim_losses(
        mesh.points, mesh.triangles, table.half_edges[rim], sagitta[rim], by_triangle, SHARPEST
    )
    half_edge, row = _all_half_edges(mesh, np.flatnonzero(rim))
    faces = mesh.face_ids[half_edge // 3]
    return np.bincount(faces, lost[row], int(mesh.face_ids.max(initial=0)) + 1).astype(float)


def _all_half_edges(
    mesh: SurfaceMesh, edges: NDArray[np.intp]
) -> tuple[NDArray[np.int64], NDArray[np.intp]]:
    """All half-edges along some edges, and the places of these in ``edges``."""
    table = mesh.connectivity
    crowded = np.flatnonzero(table.uses[edges] > 2)
    more, row = half_edges_along(mesh, mesh.edges[edges[crowded]])
    pairs = table.half_edges[edges].astype(np.int64)
    pairs[crowded] = -1
    place, side = np.nonzero(pairs >= 0)
    return np.concatenate([pairs[place, side], more]), np.concatenate([place, crowded[row]])


def _rim_sagittas(mesh: SurfaceMesh, rim: NDArray[np.bool_]) -> NDArray[np.float64]:
    """(k,) about twice the sagittas of rims, by the angles at their ends."""
    vertices, ends = np.unique(mesh.edges[rim], return_inverse=True)
    ends = ends.reshape(-1, 2)
    places = mesh.points[vertices]
    way = places[ends[:, 1]] - places[ends[:, 0]]
    length = np.linalg.norm(way, axis=1)
    way /= np.maximum(length, np.finfo(float).tiny)[:, None]
    count = np.bincount(ends.ravel(), minlength=len(vertices))
    total = np.zeros((len(vertices), 3))
    np.add.at(total, ends[:, 0], way)
    np.add.at(total, ends[:, 1], -way)  # of both edges away from the vertex: 2 sin(angle / 2)
    angle = 2.0 * np.arcsin(np.clip(np.linalg.norm(total, axis=1) / 2.0, 0.0, 1.0))
    angle = np.where((count == 2) & (angle < CORNER), angle, 0.0)
    return length * angle[ends].max(axis=1) / 4.0
