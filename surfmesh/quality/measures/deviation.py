"""How far the mesh lies from the true surface, and which triangles face the wrong way.

Samples are the vertices, the middles of the edges and the centroids, in one call of the core for
all faces (``src/quality/mesh_deviation.hpp``). At each, the distance is to the nearest point of
the surface, not to the image r(u, v) of the interpolated parameters. The worst triangles are then
sampled densely.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.quality import (
    dense_deviation,
    largest_values,
    mesh_deviation,
)
from surfmesh.accuracy.samples import DENSE
from surfmesh.quality.measures.known_surfaces import KnownSurfaces
from surfmesh.quality.measures.places import Point
from surfmesh.result.surface_mesh import SurfaceMesh

PATIENT_STEPS = 60
"""Of a search for a nearest point: beside elongated poles many lead astray. Most need two."""

SECOND_LOOK, ONE_IN = 400, 250  # so many triangles are sampled densely, or one in so many if that
# is more


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


def deviation(
    mesh: SurfaceMesh, area: NDArray[np.float64], known: KnownSurfaces | None = None
) -> Deviation | None:
    """Distance of ``mesh`` from its surfaces, or None when it carries none, or not for all faces.

    ``area``: (m,) areas of the triangles, the weights of the mean square. Between samples
    the distance is not bounded: it is smooth, and the densest look is where it is largest.
    known: the mesh on its surfaces, where that is at hand.
    """
    known = known or KnownSurfaces.of(mesh)
    if known is None:
        return None
    by_triangle, mean_square, cosine = mesh_deviation(
        *known.prepared_arrays, mesh.connectivity.half_edges, area, known.in_plane
    )
    if mesh.turned_faces is not None:
        cosine[mesh.turned_faces[mesh.face_ids]] *= -1.0
    total = float(area.sum())
    rms = (_dot(area, mean_square) / total) ** 0.5 if total > 0 else float("nan")

    triangle, point, uv = _second_look(known, by_triangle)
    largest = float(by_triangle[triangle])
    return Deviation(by_triangle, mean_square, cosine, largest, rms, triangle, point, uv)


def looked_at_closely(triangles: int) -> int:
    """How many of so many triangles are sampled densely: those that are farthest."""
    return min(triangles, max(SECOND_LOOK, triangles // ONE_IN))


def _dot(a: NDArray, b: NDArray) -> float:
    return float(np.einsum("i,i->", a, b))  # no BLAS, whose threads cost more than they gain


def _second_look(
    known: KnownSurfaces, by_triangle: NDArray[np.float64]
) -> tuple[int, Point, tuple[float, float]]:
    """Sample the worst triangles densely, in place; return the worst place of all."""
    mesh = known.mesh
    worst = largest_values(by_triangle, looked_at_closely(len(by_triangle)))
    in_plane = known.in_plane[worst] != 0
    if in_plane.all():
        in_plane[by_triangle[worst].argmax()] = False
    by_triangle[worst[in_plane]] = 0.0  # what vertices say there is of the faces beside
    worst = worst[~in_plane]
    chord = (mesh.sizing and mesh.sizing.chord) or np.inf
    by_triangle[worst], triangle, point, uv = dense_deviation(
        *known.prepared_arrays, worst, DENSE, chord, PATIENT_STEPS
    )
    for _ in range(len(worst)):  # the largest by searches from its corners too
        own = worst[by_triangle[worst].argmax()][None]
        before = float(by_triangle[own[0]])
        by_triangle[own], triangle, point, uv = dense_deviation(
            *known.prepared_arrays, own, DENSE, 0.0, PATIENT_STEPS
        )
        if not by_triangle[own[0]] < before:
            break
    return triangle, (point[0], point[1], point[2]), (uv[0], uv[1])
