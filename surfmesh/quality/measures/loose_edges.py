"""Free rims of faces that lie edge to edge and share nothing: faces that were never sewn, to each
other or, as a tube that is cut along its seam, to themselves.

 face 0    |  face 1        Both rims are edges of one triangle each. The middle of an edge
---o-------|-------o--      of one face lies on an edge of the other, as near as gaps of
           |                files and the chords of curved edges let it.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.space import PointTree
from surfmesh.geometry.boxes import diagonal
from surfmesh.quality.measures.penetration import distances_allowed, edge_sagittas
from surfmesh.quality.measures.places import Point, as_point
from surfmesh.result.surface_mesh import SurfaceMesh

GAP = 1e-4  # of the diagonal: rims farther apart are no rims of one edge
OF_EDGE = 0.1  # of an edge's length: nor are those farther apart than that
NEAREST = 16  # places on other rims that are looked at from the middle of an edge
PLACES = np.linspace(0.0, 1.0, 5)  # t along an edge


@dataclass(frozen=True)
class LooseEdges:
    """What lies edge to edge. Edges are those of the model where they are known."""

    edges: int
    faces: int
    gap: float  # the widest between them that their chords do not explain, model units
    point: Point  # where it is


def loose_edges(
    mesh: SurfaceMesh, by_triangle: NDArray[np.float64] | None
) -> tuple[LooseEdges | None, set[tuple[int, int]]]:
    """Rims of different faces, or of one face of a model, that lie along each other, None where
    there are none; and the pairs of these faces, the lower number first.

    by_triangle: (m,) measured distances from the surface.
    """
    table = mesh.connectivity
    free = np.flatnonzero(table.uses == 1)
    triangle = table.half_edges[free, 0] // 3
    face = mesh.face_ids[triangle]
    of_model = mesh.edge_links is not None and mesh.solid_ids is not None
    if len(free) < 2 or ((face == face[0]).all() and not of_model):
        return None, set()
    distance, beside = _nearest(mesh, free, triangle, of_model)
    ends = mesh.points[mesh.edges[free]]
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    model_edges, sagitta = _model_edges(mesh, free, distances_allowed(mesh, by_triangle)[triangle])
    sagitta = np.minimum(sagitta, OF_EDGE * length)
    gap = np.maximum(distance - sagitta - sagitta[beside], 0.0)
    loose = np.flatnonzero(gap <= np.minimum(GAP * diagonal(mesh.points), OF_EDGE * length))
    if not len(loose):
        return None, set()
    worst = loose[int(np.argmax(gap[loose]))]
    found = LooseEdges(
        len(np.unique(model_edges[loose])), len(np.unique(face[loose])), float(gap[worst]),
        as_point(ends[worst].mean(axis=0)),
    )  # fmt: skip
    pairs = np.sort(np.stack([face[loose], face[beside[loose]]], axis=1), axis=1)
    return found, set(map(tuple, np.unique(pairs, axis=0).tolist()))


def _nearest(
    mesh: SurfaceMesh, free: NDArray, triangle: NDArray, of_model: bool
) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """How far the nearest free edge of another face lies from the middle of each (k,), infinite
    where none is near, and which that is (k,).

    triangle: (k,) beside each. of_model: an edge of the same face counts too where these share no
    vertex; those of a narrow face do.
    """
    face = mesh.face_ids[triangle]
    ends = mesh.points[mesh.edges[free]]
    places = ends[:, 0, None] + PLACES[:, None] * (ends[:, 1] - ends[:, 0])[:, None]
    middle = ends.mean(axis=1)
    count = min(NEAREST, places.shape[0] * len(PLACES))
    _, place = PointTree(places.reshape(-1, 3)).nearest(middle, count)
    other = place // len(PLACES)
    a, b = ends[other].transpose(2, 0, 1, 3)
    way = b - a
    size = np.maximum(np.einsum("ijk,ijk->ij", way, way), np.finfo(float).tiny)
    t = np.clip(np.einsum("ijk,ijk->ij", middle[:, None] - a, way) / size, 0.0, 1.0)
    gap = np.linalg.norm(a + t[:, :, None] * way - middle[:, None], axis=2)
    apart = face[other] != face[:, None]
    if of_model:
        one, two = mesh.triangles[triangle][:, None, :, None], mesh.triangles[triangle[other]]
        apart |= ~(one == two[:, :, None, :]).any(axis=(2, 3))
    gap = np.where(apart, gap, np.inf)
    best = gap.argmin(axis=1)
    rows = np.arange(len(free))
    return gap[rows, best], other[rows, best]


def _model_edges(
    mesh: SurfaceMesh, edges: NDArray[np.intp], deviation: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """The edges of the model on which edges of the mesh (k,) lie, or numbers of their own; and
    how far these lie from their curves (k,).

    deviation: (k,) of their triangles from the surface: where a curve is one edge, or unknown.
    """
    links = mesh.edge_links
    if links is None or not len(links.edge_segments):
        return edges.astype(np.int64), deviation
    width = np.array([len(mesh.points), 1], np.int64)
    along = np.sort(links.edge_segments, axis=1) @ width
    order = np.argsort(along, kind="stable")
    keys = mesh.edges[edges] @ width
    row = order[np.minimum(np.searchsorted(along[order], keys), len(along) - 1)]
    known = along[row] == keys
    ids = links.edge_ids
    cut = known & (np.bincount(ids)[ids[row]] > 1)
    names = np.where(known, ids[row], -1 - edges.astype(np.int64))
    return names, np.where(cut, edge_sagittas(mesh, links)[row], deviation)
