"""One judge for all meshers: how far do triangles lie from the faces of a CAD model?

Looked at are the vertices, the middles of the sides and the centroid of each triangle. The
closest point is sought on the faces that have triangles of our own mesh nearby, from the
parameters of their centroids: never those of a pole, from where no search finds away. Faces
are taken whole, beyond their boundaries: a triangle across a narrow gap may look nearer than
it is, for every mesher alike.
"""

from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

import surfmesh as sm
from surfmesh.cad.model.cad_model import CadModel
from surfmesh.geometry.differential.projection import closest_point
from surfmesh.geometry.parameter_grid import parameter_grid

GUIDES = 6  # places nearby that a search starts from
MORE_GUIDES = 40  # for what seems to lie too far away: the other side of a wall may be nearer
STEPS = 12  # of a search, at most
GRID = 12  # samples along u and v of a face that we could not mesh
MOST = 20_000  # triangles that are looked at
SETTLED = 0.25  # of the limit: nearer than this, no other guide is tried


class TrueSurface(NamedTuple):
    """Plain data, no OCP: it can be pickled for the processes of the other meshers."""

    surfaces: tuple[Any, ...]  # by face
    points: np.ndarray  # (k, 3) guides, on the faces
    uv: np.ndarray  # (k, 2) their parameters
    face: np.ndarray  # (k,) their face


def true_surface(model: CadModel) -> TrueSurface:
    """The faces of ``model``, guides from our mesh of default sizes."""
    mesh = sm.mesh(model, strict=False)
    centres = mesh.uv_points[mesh.uv_triangles].mean(axis=1)
    points, uv, faces = [], [], []
    for number in np.unique(mesh.face_ids):
        uv.append(centres[mesh.face_ids == number])
        points.append(model.faces[number].surface.evaluate(uv[-1], 0)[0])
        faces.append(np.full(len(uv[-1]), number))
    for number in set(range(len(model.faces))) - set(np.unique(mesh.face_ids).tolist()):
        grid = parameter_grid(model.faces[number].surface.domain, GRID)
        points.append(model.faces[number].surface.evaluate(grid, 0)[0])
        uv.append(grid)
        faces.append(np.full(len(grid), number))
    surfaces = tuple(face.surface for face in model.faces)
    return TrueSurface(surfaces, *(np.concatenate(part) for part in (points, uv, faces)))


def by_triangle(
    truth: TrueSurface, points: np.ndarray, triangles: np.ndarray, limit: float
) -> np.ndarray:
    """(m,) largest distance seen in each triangle, of a random sample when there are many.

    Exact where it matters, above a quarter of the ``limit``; below, an upper bound.
    """
    if len(triangles) > MOST:
        triangles = triangles[np.random.default_rng(0).permutation(len(triangles))[:MOST]]
    used, corners = np.unique(triangles, return_inverse=True)
    corners = corners.reshape(-1, 3)
    sides = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2), axis=2)
    edges, edge_of = np.unique(sides.reshape(-1, 2), axis=0, return_inverse=True)
    samples = np.concatenate(
        [points[used], points[edges].mean(axis=1), points[triangles].mean(axis=1)]
    )
    found = distances(truth, samples, limit)
    at_vertex, at_edge, at_centroid = np.split(found, np.cumsum([len(used), len(edges)]))
    around = [at_vertex[corners], at_edge[edge_of.reshape(-1, 3)], at_centroid[:, None]]
    return np.concatenate(around, axis=1).max(axis=1)


def distances(truth: TrueSurface, samples: np.ndarray, limit: float = 0.0) -> np.ndarray:
    """(n,) distance of each sample (n, 3) from the nearest face."""
    tree = cKDTree(truth.points)
    best = np.full(len(samples), np.inf)
    _improve(best, truth, tree, samples, GUIDES, SETTLED * limit)
    far = np.flatnonzero(best > limit)
    again = best[far]
    _improve(again, truth, tree, samples[far], MORE_GUIDES, limit)
    best[far] = again
    return best


def _improve(
    best: np.ndarray, truth: TrueSurface, tree: cKDTree, samples: np.ndarray,
    count: int, enough: float,
) -> None:  # fmt: skip
    """Lower ``best`` (n,) by searches from the ``count`` nearest guides, until ``enough``."""
    count = min(count, len(truth.points))
    _, guides = tree.query(samples, count)
    for guide in guides.reshape(len(samples), count).T:
        open_ones = np.flatnonzero(best > enough)
        faces = truth.face[guide[open_ones]]
        for face in np.unique(faces):
            these = open_ones[faces == face]
            _, found, _ = closest_point(
                truth.surfaces[face], samples[these], truth.uv[guide[these]], STEPS
            )
            best[these] = np.minimum(best[these], found)
