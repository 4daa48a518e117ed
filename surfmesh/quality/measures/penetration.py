"""How deep two triangles go into each other, and how deep facets of a contact may.

          \\  tA
      -----\\--------- tB     the part of tA over tB reaches from below to above the plane of tB:
            \\ depth         its depth there is the smaller of the two heights. That of the pair
             \\              is the smaller one of tA over tB and of tB over tA, and no more than
                             the line that they have in common is long.

Where two bodies touch along a curved face, facets of one lie within those of the other by up to
the distances of both from the true face: a pin in its hole.
"""

import math

import numpy as np
from numpy.typing import NDArray

from surfmesh._core import quality
from surfmesh.result.mesh_parts import EdgeLinks
from surfmesh.result.surface_mesh import SurfaceMesh

BORDER = 1e-9  # of a triangle: how far beyond its sides still counts as over it
PARALLEL = 1e-12  # sine of the angle between planes that have no line in common
SMOOTH = math.radians(60.0)  # between triangles of one curved face; more is an edge of the body


def depths(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k,) how deep pairs of triangles, (k, 2, 3, 3), go into each other."""
    first, second = corners[:, 0], corners[:, 1]
    depth = np.minimum(_depth_over(first, second), _depth_over(second, first))
    return np.minimum(depth, _common_length(first, second))


def _common_length(first: NDArray, second: NDArray) -> NDArray:
    """(k,) how long a line triangles (k, 3, 3) have in common; infinite in one plane."""
    normals = [np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]) for t in (first, second)]
    along = np.cross(normals[0], normals[1])
    size = np.linalg.norm(along, axis=1)
    steep = size > PARALLEL * np.prod(np.linalg.norm(normals, axis=2), axis=0)
    along /= np.where(steep, size, 1.0)[:, None]
    low, high = np.full(len(first), -np.inf), np.full(len(first), np.inf)
    for one, other, normal in ((first, second, normals[1]), (second, first, normals[0])):
        least, most = _span(one, other[:, 0], normal, along)
        low, high = np.maximum(low, least), np.minimum(high, most)
    return np.where(steep, np.maximum(high - low, 0.0), np.inf)


def _span(triangle: NDArray, origin: NDArray, normal: NDArray, along: NDArray) -> tuple:
    """From where to where along a line the triangles (k, 3, 3) meet planes."""
    height = np.einsum("ijk,ik->ij", triangle - origin[:, None], normal)
    place = np.einsum("ijk,ik->ij", triangle - origin[:, None], along)
    place += np.einsum("ij,ij->i", origin, along)[:, None]
    least, most = np.full(len(triangle), np.inf), np.full(len(triangle), -np.inf)
    for i, k in ((0, 1), (1, 2), (2, 0)):
        fall = height[:, i] - height[:, k]
        there = (height[:, i] * height[:, k] <= 0.0) & (fall != 0.0)
        t = np.where(there, height[:, i] / np.where(fall != 0.0, fall, 1.0), 0.0)
        at = place[:, i] + t * (place[:, k] - place[:, i])
        least = np.where(there, np.minimum(least, at), least)
        most = np.where(there, np.maximum(most, at), most)
    return least, most


def _depth_over(above: NDArray, base: NDArray) -> NDArray:
    """How far the part of triangles (k, 3, 3) over ``base`` reaches to both sides of its plane."""
    x = base[:, 1] - base[:, 0]
    normal = np.cross(x, base[:, 2] - base[:, 0])
    length, size = np.linalg.norm(x, axis=1), np.linalg.norm(normal, axis=1)
    flat = (length > 0.0) & (size > 0.0)
    x = x / np.where(flat, length, 1.0)[:, None]
    z = normal / np.where(flat, size, 1.0)[:, None]
    frame = np.stack([x, np.cross(z, x), z], axis=2)
    seen = (above - base[:, :1]) @ frame
    under = ((base - base[:, :1]) @ frame)[:, :, :2]
    heights = np.concatenate(
        [_at_corners(seen, under), _under_corners(seen, under), _at_sides(seen, under)], axis=1
    )
    highest, lowest = np.nanmax(heights, axis=1), np.nanmin(heights, axis=1)
    depth = np.fmax(np.fmin(highest, -lowest), 0.0)
    return np.where(flat & np.isfinite(depth), depth, 0.0)


def _at_corners(seen: NDArray, under: NDArray) -> NDArray:
    """(k, 3) heights of corners over the base, nan elsewhere; a 0 that stands for none."""
    weights = np.stack([plane_weights(seen[:, k, :2], under) for k in range(3)], axis=1)
    return np.where((weights >= -BORDER).all(axis=2), seen[:, :, 2], np.nan)


def _under_corners(seen: NDArray, under: NDArray) -> NDArray:
    """(k, 4) heights over corners of the base, nan where there is nothing; the last is 0."""
    found = np.zeros((len(seen), 4))
    for k in range(3):
        weights = plane_weights(under[:, k], seen[:, :, :2])
        height = np.einsum("ij,ij->i", weights, seen[:, :, 2])
        found[:, k] = np.where((weights >= -BORDER).all(axis=1), height, np.nan)
    return found


def _at_sides(seen: NDArray, under: NDArray) -> NDArray:
    """(k, 9) heights where sides cross over those of the base, nan where they do not."""
    found = np.full((len(seen), 9), np.nan)
    for i in range(3):
        a, way = seen[:, i], seen[:, (i + 1) % 3] - seen[:, i]
        for k in range(3):
            c, along = under[:, k], under[:, (k + 1) % 3] - under[:, k]
            area = way[:, 0] * along[:, 1] - way[:, 1] * along[:, 0]
            safe = np.where(area != 0.0, area, 1.0)
            apart = c - a[:, :2]
            with np.errstate(over="ignore"):  # nearly parallel: far away
                t = (apart[:, 0] * along[:, 1] - apart[:, 1] * along[:, 0]) / safe
                s = (apart[:, 0] * way[:, 1] - apart[:, 1] * way[:, 0]) / safe
            there = (area != 0.0) & (t >= 0.0) & (t <= 1.0) & (s >= 0.0) & (s <= 1.0)
            found[there, 3 * i + k] = a[there, 2] + t[there] * way[there, 2]
    return found


def plane_weights(point: NDArray, triangle: NDArray) -> NDArray:
    """(k, 3) barycentric weights of points (k, 2); nan for triangles (k, 3, 2) without area."""
    a, b, c = (triangle - point[:, None]).transpose(1, 0, 2)
    parts = np.stack(
        [
            b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0],
            c[:, 0] * a[:, 1] - c[:, 1] * a[:, 0],
            a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0],
        ],
        axis=1,
    )
    total = parts.sum(axis=1)
    return parts / np.where(total != 0.0, total, np.nan)[:, None]


def distances_allowed(
    mesh: SurfaceMesh, by_triangle: NDArray[np.float64] | None
) -> NDArray[np.float64]:
    """(m,) how far the true surface may lie from each triangle and from those around it.

    by_triangle: (m,) measured distances; None where the surface is not known: from the angles
    between neighbours. Along edges of the model their own bend counts too: of a plane face it
    is all that its triangles miss.
    """
    if by_triangle is None:
        by_triangle = _by_angles(mesh)
    at_vertex = np.zeros(len(mesh.points))
    np.maximum.at(at_vertex, mesh.triangles.ravel(), np.repeat(by_triangle, 3))
    links = mesh.edge_links
    if links is not None and len(links.edge_segments):
        sagitta = edge_sagittas(mesh, links)
        np.maximum.at(at_vertex, links.edge_segments.ravel(), np.repeat(sagitta, 2))
    a, b, c = (at_vertex[corner] for corner in mesh.triangles.T)
    return np.maximum(np.maximum(a, b), c)


def edge_sagittas(mesh: SurfaceMesh, links: EdgeLinks) -> NDArray[np.float64]:
    """(k,) about twice how far segments of edges lie from their curves, by how these turn.

    An arc of length h that turns by a lies h a / 8 from its chord.
    """
    return quality.edge_sagittas(mesh.points, links.edge_segments, links.edge_ids)


def _by_angles(mesh: SurfaceMesh) -> NDArray[np.float64]:
    """(m,) about how far a surface through the corners bends away, where it is smooth."""
    a, b, c = (mesh.points[corner] for corner in mesh.triangles.T)
    normal = np.cross(b - a, c - a)
    size = np.maximum(np.linalg.norm(normal, axis=1), np.finfo(float).tiny)
    normal /= size[:, None]
    table = mesh.connectivity
    two = table.uses == 2
    first, second = (table.half_edges[two] // 3).T
    cosine = np.abs(np.einsum("ij,ij->i", normal[first], normal[second]))
    angle = np.arccos(np.clip(cosine, -1.0, 1.0))
    ends = mesh.points[mesh.edges[two]]
    length = np.maximum(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1), np.finfo(float).tiny)
    found = np.zeros(len(mesh.triangles))
    for one in (first, second):
        np.maximum.at(found, one, np.where(angle < SMOOTH, size[one] / length * angle / 4.0, 0.0))
    return found
