"""The distance of points, and of triangles, from the true surface.

It is read in the tangent plane at a foot nearby, r(u, v) of the interpolated parameters, where
that suffices, and to the nearest point of the surface where it does not:

        o p              along the normal n at the foot: the distance,
      n | `.             across: how far the foot is from the nearest point
    ____|___`o foot
"""

import numpy as np
from numpy.typing import NDArray

from surfmesh._core import space
from surfmesh.accuracy.samples import CENTROID, DENSE_INNER, MIDDLES
from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.differential.projection import closest_from_corners, closest_point
from surfmesh.geometry.surface import Surface

NEAR_FOOT = 0.05
"""Of the triangle's size. With d near k h^2 / 8 for the distance to the tangent plane at a foot
that is off by s, the true distance differs by k s^2 / 2 = 4 d (s / h)^2: 1 % of d at this s / h."""

ON_SURFACE = 1e-9
"""Of the triangle's size: a vertex this near to r(u, v) is on it."""

STEPS = 12
"""Of the projection, at most: where the speed along u changes fast, a guess is poor."""

NEAR_LIMIT = 0.75
"""Fraction of ``limit`` from which the first few samples of a triangle do not suffice."""

CHORD_MARGIN = 0.96
"""Fraction of ``limit`` that the mesher aims at: from there a search begins anew from corners."""

FAR_FOOT = 0.2
"""Of the longest side: r(u, v) so far across its tangent plane says nothing of the distance."""

FEW_STEPS = 4
"""Of the projection in the mesher, where triangles are small and guesses near."""


def tangent_plane_offsets(
    surface: Surface, points: NDArray[np.float64], uv: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Points (n, 3) seen from the tangent planes at uv (n, 2) -> (n, 7).

    Unit normal, distance along it and across it, and the step in (u, v) across.
    """
    return space.tangent_plane_offsets(points, *surface.evaluate(uv, 1))


def point_deviations(
    surface: Surface,
    points: NDArray[np.float64],
    uv: NDArray[np.float64],
    size: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Distances (n,) of points (n, 3) from the surface, and its normals (n, 3) near them.

    uv: (n, 2) parameters of a surface point nearby; size: (n,) of the triangle. Read in the
    tangent plane where the foot is near, else in the one a Newton step further, else by
    projection.
    """
    found = tangent_plane_offsets(surface, points, uv)
    distance = found[:, 3].copy()
    far = np.flatnonzero(~(found[:, 4] <= NEAR_FOOT * size))
    if len(far):
        low, high = np.transpose(surface.domain)
        nearer = np.clip(uv[far] + found[far, 5:], low, high)
        again = tangent_plane_offsets(surface, points[far], nearer)
        distance[far] = again[:, 3]
        better = np.hypot(again[:, 3], again[:, 4]) <= np.hypot(found[far, 3], found[far, 4])
        far = far[~((again[:, 4] <= NEAR_FOOT * size[far]) & better)]
    if len(far):
        distance[far] = closest_point(surface, points[far], uv[far], STEPS)[1]
    return distance, found[:, :3]


def vertex_deviations(
    surface: Surface,
    points: NDArray[np.float64],
    uv: NDArray[np.float64],
    size: NDArray[np.float64],
) -> NDArray[np.float64]:
    """The same (n,) of points that should be r(u, v) itself: looked at closely only if not."""
    (image,) = surface.evaluate(uv, 0)
    distance: NDArray[np.float64] = np.sqrt(np.square(points - image).sum(axis=1))
    off = np.flatnonzero(~(distance <= ON_SURFACE * size))
    if len(off):
        distance[off] = point_deviations(surface, points[off], uv[off], size[off])[0]
    return distance


def nearest_deviations(
    surface: Surface,
    points: NDArray[np.float64],
    uv: NDArray[np.float64],
    corners: NDArray[np.float64],
    triangle: NDArray[np.integer],
    limit: float,
    steps: int,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Parameters (n, 2) of the nearest points of the surface, and the distances (n,).

    uv: (n, 2) first guesses. corners: (m, 3, 2) of triangles and ``triangle`` (n,) that of each
    point: the search begins anew from them where a point seems farther away than ``limit``.
    """
    uv, distance, _ = closest_point(surface, points, uv, steps)
    far = np.flatnonzero(distance > limit)
    if len(far):
        uv[far], distance[far] = closest_from_corners(
            surface, points[far], uv[far], distance[far], corners[triangle[far]], steps
        )
    return uv, distance


def triangle_deviations(
    surface: Surface,
    chart: Chart,
    corners: NDArray[np.float64],
    xy: NDArray[np.float64],
    limit: float,
) -> NDArray[np.float64]:
    """Largest distance (n,) from the surface at samples of triangles (n, 3, 3) with corners on it.

    xy: (n, 3, 2) the corners in the plane of ``chart``. Four samples each, read in the tangent
    planes; where these come near to ``limit``, the samples of the report, each with its
    nearest point.
    """
    error, unreliable = np.zeros(len(corners)), np.zeros(len(corners), bool)
    reach = FAR_FOOT * np.linalg.norm(corners - corners[:, [1, 2, 0]], axis=2).max(axis=1)
    for weights in (*MIDDLES, *CENTROID):
        point, uv = interpolated(chart, corners, xy, weights)
        found = tangent_plane_offsets(surface, point, uv)
        error = np.maximum(error, found[:, 3])
        unreliable |= found[:, 4] > reach
    close = np.flatnonzero(unreliable | (error > NEAR_LIMIT * limit))
    if len(close):
        samples = [interpolated(chart, corners[close], xy[close], w) for w in DENSE_INNER]
        points, uv = (np.concatenate(parts) for parts in zip(*samples))
        corner_uv = chart.to_uv(xy[close].reshape(-1, 2)).reshape(-1, 3, 2)
        triangle = np.tile(np.arange(len(close)), len(DENSE_INNER))
        distance = nearest_deviations(
            surface, points, uv, corner_uv, triangle, CHORD_MARGIN * limit, FEW_STEPS
        )[1]
        error[close] = distance.reshape(len(DENSE_INNER), -1).max(axis=0)
    return error


def interpolated(
    chart: Chart,
    corners: NDArray[np.float64],
    xy: NDArray[np.float64],
    weights: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points (n, 3) of triangles (n, 3, 3) at barycentric ``weights`` (3,), parameters (n, 2).

    xy: (n, 3, 2) the corners in the plane of ``chart``, in which parameters are interpolated.
    """
    point = np.einsum("k,nki->ni", weights, corners)
    return point, chart.to_uv(np.einsum("k,nki->ni", weights, xy))
