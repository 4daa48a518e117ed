"""How much area and volume a mesh loses or wins by its deviation from the surface.

    volume   the sum over triangles of area times distance; facets of a ball lose two thirds of it
    area     of a triangle of height h at the distance d, about (4 d / h)^2 / 2 of its area by its
             slant and as much by its depth; and along rims length times sagitta: all that plane
             faces lose

What is more than that is lost (``verdict/area_and_volume``).
"""

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.quality import JoinedTriangles
from surfmesh.quality.measures.penetration import edge_sagittas
from surfmesh.quality.measures.topology import half_edges_along
from surfmesh.result.surface_mesh import SurfaceMesh

SLANT = 16.0  # of (d / h)^2: what a triangle's area may differ by, of its own
SHARPEST = 0.1  # sine of the least angle between faces that tells where their edge is
CORNER = np.radians(60.0)  # a rim with a larger angle has a corner there


def is_known(mesh: SurfaceMesh) -> bool:
    """Is there an exact area or volume to compare with?"""
    facts = mesh.facts
    return facts is not None and bool(facts.area or facts.faces or facts.solids)


def explained_areas(
    mesh: SurfaceMesh, joined: JoinedTriangles, area: NDArray[np.float64],
    by_triangle: NDArray[np.float64],
) -> NDArray[np.float64]:  # fmt: skip
    """(f,) what distances from the surface explain of the area of each face, and along its rims.

    area: (m,) of the triangles; by_triangle: (m,) their distances from the surface.
    """
    bend = None if mesh.mid_points is None else _bends(mesh, mesh.mid_points)
    of_triangles = joined.explained_areas(area, by_triangle, bend, SLANT)
    return of_triangles + _along_rims(mesh, joined, by_triangle)


def explained_volume(
    area: NDArray[np.float64], by_triangle: NDArray[np.float64], own: NDArray[np.bool_]
) -> float:
    """Likewise of the volume of a solid; own: (m,) which triangles lie around it."""
    return float((area[own] * by_triangle[own]).sum())


def _bends(mesh: SurfaceMesh, mid_points: NDArray[np.float64]) -> NDArray[np.float64]:
    """(m,) twice the largest curvature of the sides of quadratic triangles: a surface at a distance
    has so much more area or less."""
    ends = mesh.points[mesh.edges]
    squared = ((ends[:, 1] - ends[:, 0]) ** 2).sum(axis=1)
    bend = np.linalg.norm(mid_points - ends.mean(axis=1), axis=1)
    bent = 16.0 * bend / np.maximum(squared, np.finfo(float).tiny)
    return bent[mesh.elements[:, 3:] - len(mesh.points)].max(axis=1)


def _along_rims(
    mesh: SurfaceMesh, joined: JoinedTriangles, by_triangle: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(f,) length times sagitta along the rims of each face."""
    table, links = mesh.connectivity, mesh.edge_links
    if links is None or not len(links.edge_segments):
        rows = np.flatnonzero(table.uses == 1)
        sagitta = _rim_sagittas(mesh, rows)
    else:
        rows, sagitta = mesh.edge_segment_rows, edge_sagittas(mesh, links)
    of_edges, of_faces = joined.rim_losses(rows, sagitta, by_triangle, SHARPEST)
    crowded = np.flatnonzero(table.uses > 2)
    if len(crowded):
        half_edge, row = half_edges_along(mesh, mesh.edges[crowded])
        faces = mesh.face_ids[half_edge // 3]
        of_faces += np.bincount(faces, of_edges[crowded[row]], len(of_faces))
    return of_faces


def _rim_sagittas(mesh: SurfaceMesh, rows: NDArray[np.intp]) -> NDArray[np.float64]:
    """(k,) about twice the sagittas of edges that are rims, by the angles at their ends."""
    vertices, ends = np.unique(mesh.edges[rows], return_inverse=True)
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
