"""How far the mesh lies from the true surface, and which triangles face the wrong way.

Samples are the vertices, the middles of the edges (once each; between two faces once for
either) and the centroids: the seven points of a rule that integrates cubics over a triangle
exactly. At each, the distance is to
the nearest point of the surface, not to the image r(u, v) of the interpolated parameters.
The worst triangles are then sampled densely.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh.accuracy.deviation import (
    STEPS,
    nearest_deviations,
    point_deviations,
    vertex_deviations,
)
from surfmesh.accuracy.folds import cosines, triangle_normals
from surfmesh.accuracy.samples import CENTROID, DENSE, MIDDLES
from surfmesh.quality.measures.known_surfaces import KnownSurfaces
from surfmesh.quality.measures.places import Point, as_point, as_uv
from surfmesh.result.surface_mesh import SurfaceMesh

BLOCK = 1 << 15  # samples looked at together: the temporaries stay within the cache
SECOND_LOOK = 400  # triangles sampled densely, or one in 250 if that is more
# barycentric weights of the seven-point rule (Zienkiewicz & Taylor, The Finite Element Method)
VERTEX_WEIGHT, MIDDLE_WEIGHT, CENTROID_WEIGHT = 1 / 20, 2 / 15, 9 / 20


class Deviation(NamedTuple):
    """Distances in model units."""

    by_triangle: NDArray[np.float64]  # (m,) largest distance seen in each triangle
    mean_square: NDArray[np.float64]  # (m,) mean over each triangle of the squared distance
    cosine: NDArray[np.float32]  # (m,) of the angle between triangle and surface normal
    largest: float
    rms: float  # root of the mean square over the mesh's area
    triangle: int  # where the largest is
    point: Point  # on the mesh
    uv: tuple[float, float]  # parameters of the nearest surface point


def deviation(mesh: SurfaceMesh, area: NDArray[np.float64]) -> Deviation | None:
    """Distance of ``mesh`` from its surfaces, or None when it carries none, or not for all faces.

    ``area``: (m,) areas of the triangles, the weights of the mean square. Between samples
    the distance is not bounded: it is smooth, and the densest look is where it is largest.
    """
    known = KnownSurfaces.of(mesh)
    if known is None:
        return None
    count = len(mesh.triangles)
    by_triangle, mean_square = np.zeros(count), np.zeros(count)
    normals = np.zeros((count, 3))  # of the surfaces, at the triangles' centroids
    corners, uv_corners = mesh.triangles.reshape(-1), known.corners.uv_triangles.reshape(-1)
    corner_of = np.full(len(mesh.points), -1, np.int32)
    corner_of[corners] = np.arange(len(corners), dtype=np.int32)
    at_vertex = np.zeros(len(mesh.points))

    half_edges, twins = _measured_half_edges(mesh)
    for surface, triangles, middles, vertices in _by_face(mesh, half_edges, corner_of):
        for block in _blocks(vertices):
            corner = corner_of[block]
            points, uv = mesh.points[block], known.corners.uv_points[uv_corners[corner]]
            at_vertex[block] = vertex_deviations(surface, points, uv, np.sqrt(area[corner // 3]))
        for block in _blocks(middles):
            triangle, side = np.divmod(half_edges[block], np.int32(3))
            points, uv = known.samples(triangle, side, MIDDLES)
            distance, _ = point_deviations(surface, points, uv, np.sqrt(area[triangle]))
            shared = twins[block] >= 0
            for beside, found in (
                (triangle, distance),
                (twins[block[shared]] // 3, distance[shared]),
            ):
                np.add.at(mean_square, beside, MIDDLE_WEIGHT * found**2)
                np.maximum.at(by_triangle, beside, found)
        for block in _blocks(triangles):
            points, uv = known.samples(block, np.zeros_like(block), CENTROID)
            found, normals[block] = point_deviations(surface, points, uv, np.sqrt(area[block]))
            mean_square[block] += CENTROID_WEIGHT * found**2
            by_triangle[block] = np.maximum(by_triangle[block], found)
    cosine = np.ones(count, np.float32)
    for block in _blocks(_count(count)):
        cosine[block] = _cosines(mesh, block, normals[block], area[block])
    del normals
    if mesh.turned_faces is not None:
        cosine[mesh.turned_faces[mesh.face_ids]] *= -1.0
    for block in _blocks(_count(count)):
        found = at_vertex[mesh.triangles[block]]
        mean_square[block] += VERTEX_WEIGHT * np.square(found).sum(axis=1)
        by_triangle[block] = np.maximum(by_triangle[block], found.max(axis=1))
    total = float(area.sum())
    rms = (_dot(area, mean_square) / total) ** 0.5 if total > 0 else float("nan")

    triangle, point, uv = _second_look(known, by_triangle)
    largest = float(by_triangle[triangle])
    return Deviation(by_triangle, mean_square, cosine, largest, rms, triangle, point, uv)


def _measured_half_edges(mesh: SurfaceMesh) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Half-edges (k,) whose middles are looked at, and those (k,) that share the finding or -1.

    An edge within a face is looked at once, an edge between two faces from both of them.
    """
    first, second = mesh.connectivity.half_edges.T
    if len(mesh.surfaces) == 1:
        return first, second
    between = (second >= 0) & (mesh.face_ids[first // 3] != mesh.face_ids[second // 3])
    again = second[between]
    return (
        np.concatenate([first, again]),
        np.concatenate([np.where(between, -1, second), np.full_like(again, -1)]),
    )


def _by_face(
    mesh: SurfaceMesh, half_edges: NDArray[np.int32], corner_of: NDArray[np.int32]
) -> Iterator[tuple[Any, ...]]:
    """Each surface with its triangles and half-edges, and the vertices first seen from them."""
    edge_face = mesh.face_ids[half_edges // 3]
    used = np.flatnonzero(corner_of >= 0).astype(np.int32)
    vertex_face = mesh.face_ids[corner_of[used] // 3]
    if len(mesh.surfaces) == 1:
        yield mesh.surfaces[0], _count(len(mesh.face_ids)), _count(len(edge_face)), used
        return
    members = []
    for faces in (mesh.face_ids, edge_face, vertex_face):
        order = np.argsort(faces, kind="stable").astype(np.int32)
        members.append(np.split(order, np.searchsorted(faces[order], range(1, len(mesh.surfaces)))))
    for surface, triangles, middles, vertices in zip(mesh.surfaces, *members):
        yield surface, triangles, middles, used[vertices]


def _count(length: int) -> NDArray[np.int32]:
    return np.arange(length, dtype=np.int32)


def _blocks(members: NDArray, length: int = BLOCK) -> Iterator[NDArray]:
    for start in range(0, len(members), length):
        yield members[start : start + length]


def _cosines(mesh: SurfaceMesh, triangle: NDArray, normals: NDArray, area: NDArray) -> NDArray:
    """Cosine between the normals of triangles and of the surface; 1 where either is missing."""
    own = triangle_normals(mesh.points[mesh.triangles[triangle]])
    lengths = np.where(normals.any(axis=1), 2.0 * area, 0.0)
    return np.where(lengths == 0.0, 1.0, cosines(own, normals, lengths))


def _dot(a: NDArray, b: NDArray) -> float:
    return float(np.einsum("i,i->", a, b))  # no BLAS, whose threads cost more than they gain


def _second_look(
    known: KnownSurfaces, by_triangle: NDArray[np.float64]
) -> tuple[int, Point, tuple[float, float]]:
    """Sample the worst triangles densely, in place; return the worst place of all."""
    mesh, count = known.mesh, len(by_triangle)
    chosen = min(count, max(SECOND_LOOK, count // 250))
    worst = np.argpartition(by_triangle, count - chosen)[count - chosen :].astype(np.int32)
    chord = (mesh.sizing and mesh.sizing.chord) or np.inf
    best, found = -1.0, (0, (0.0, 0.0, 0.0), (0.0, 0.0))
    for face in np.unique(mesh.face_ids[worst]):
        for block in _blocks(worst[mesh.face_ids[worst] == face], BLOCK // len(DENSE)):
            triangle = np.repeat(block, len(DENSE))
            rule = np.tile(np.arange(len(DENSE), dtype=np.int32), len(block))
            points, uv = known.samples(triangle, rule, DENSE)
            row = np.repeat(np.arange(len(block)), len(DENSE))
            foot_uv, distance = nearest_deviations(
                mesh.surfaces[face], points, uv, known.uv(block), row, chord, STEPS
            )
            by_triangle[block] = distance.reshape(len(block), -1).max(axis=1)
            top = int(distance.argmax())
            if distance[top] > best:
                best = float(distance[top])
                found = (int(triangle[top]), as_point(points[top]), as_uv(foot_uv[top]))
    return found
