"""Where the vertices of a planar triangulation lie in space, and how to measure there.

Sizes and shapes are judged on the true surface: a step between two vertices is their chord in
3D, seen in the tangent plane of one of them in units of the wanted edge length,

    y = B d,   B = I^(-1/2) J^T / h,   J = (r_x, r_y),   I = J^T J,

so that a unit step is a unit edge. The way back is a step H y = h I^(-1/2) y in the plane, and
h^2 B^T y in space.
"""

import math
from typing import NamedTuple

import numpy as np

from surfmesh.kernels.background import scalar_size_at
from surfmesh.kernels.jit import kernel

DEGENERATE = 1e-10  # |r_x x r_y| over |r_x|^2 + |r_y|^2 below which there is no normal


class Embedding(NamedTuple):
    point: np.ndarray  # (vertices, 3) float64: r
    chart: np.ndarray  # (vertices, 2, 3) float64: B
    normal: np.ndarray  # (vertices, 3) float64: unit normal, zero at a degenerate point
    size: np.ndarray  # (vertices,) float64: wanted edge length h
    scale: np.ndarray  # (vertices,) float64: h over that of the size field, at most 1


def empty_embedding(vertices: int) -> Embedding:
    return Embedding(
        point=np.empty((vertices, 3)),
        chart=np.empty((vertices, 2, 3)),
        normal=np.empty((vertices, 3)),
        size=np.empty(vertices),
        scale=np.ones(vertices),
    )


@kernel
def embed(t, s, background, vertices, r, rx, ry, largest):
    """Set the embedding of ``vertices`` (n,) from r, r_x, r_y (n, 3).

    Also sets their size tensors to the exact H = h I^(-1/2). Near a degenerate point the
    eigenvalues of I^(-1/2) are capped at ``largest``.
    """
    for k in range(len(r)):
        v = vertices[k]
        h = s.scale[v] * scalar_size_at(background, t.xy[v, 0], t.xy[v, 1])
        e = f = g = 0.0
        for i in range(3):
            s.point[v, i] = r[k, i]
            e += rx[k, i] * rx[k, i]
            f += rx[k, i] * ry[k, i]
            g += ry[k, i] * ry[k, i]
        nx = rx[k, 1] * ry[k, 2] - rx[k, 2] * ry[k, 1]
        ny = rx[k, 2] * ry[k, 0] - rx[k, 0] * ry[k, 2]
        nz = rx[k, 0] * ry[k, 1] - rx[k, 1] * ry[k, 0]
        area = math.sqrt(nx * nx + ny * ny + nz * nz)
        area = 1.0 / area if area > DEGENERATE * (e + g) else 0.0
        s.normal[v, 0], s.normal[v, 1], s.normal[v, 2] = area * nx, area * ny, area * nz
        floor = (e + g) / (largest * largest) + 1e-300
        e += floor
        g += floor
        # I^(-1/2) = (tr + 2 s)^(-1/2) (Id + s I^-1), s = sqrt(det I)
        det = max(e * g - f * f, floor * floor)
        root = math.sqrt(det)
        scale = 1.0 / math.sqrt(e + g + 2.0 * root)
        m11 = scale * (1.0 + g / root)
        m12 = -scale * f / root
        m22 = scale * (1.0 + e / root)
        s.size[v] = h
        t.size[v, 0] = h * m11
        t.size[v, 1] = h * m12
        t.size[v, 2] = h * m22
        for i in range(3):
            s.chart[v, 0, i] = (m11 * rx[k, i] + m12 * ry[k, i]) / h
            s.chart[v, 1, i] = (m12 * rx[k, i] + m22 * ry[k, i]) / h


@kernel
def chord(s, v, p):
    """The chord from v to p in the unit tangent plane of v."""
    dx = s.point[p, 0] - s.point[v, 0]
    dy = s.point[p, 1] - s.point[v, 1]
    dz = s.point[p, 2] - s.point[v, 2]
    b = s.chart
    return (
        b[v, 0, 0] * dx + b[v, 0, 1] * dy + b[v, 0, 2] * dz,
        b[v, 1, 0] * dx + b[v, 1, 1] * dy + b[v, 1, 2] * dz,
    )


@kernel
def edge_length(s, v, p):
    """Length of the chord in units of the mean wanted size of its ends."""
    dx = s.point[p, 0] - s.point[v, 0]
    dy = s.point[p, 1] - s.point[v, 1]
    dz = s.point[p, 2] - s.point[v, 2]
    return 2.0 * math.sqrt(dx * dx + dy * dy + dz * dz) / (s.size[v] + s.size[p])


@kernel
def rise(s, v, p):
    """Height of p over the tangent plane of v: half the normal curvature times length^2."""
    return (
        s.normal[v, 0] * (s.point[p, 0] - s.point[v, 0])
        + s.normal[v, 1] * (s.point[p, 1] - s.point[v, 1])
        + s.normal[v, 2] * (s.point[p, 2] - s.point[v, 2])
    )


@kernel
def triangle_deviation(s, a, b, c):
    """About how far the triangle abc lies from a surface with these tangent planes.

    For a quadric with rises w along the three edges the error of linear interpolation is
    w / 4 in the middle of an edge and (w1 + w2 + w3) / 9 at the centroid. Where the rises seen
    from the two ends differ, the curvature changes along the edge: the difference is added.
    """
    ab, ba = rise(s, a, b), rise(s, b, a)
    bc, cb = rise(s, b, c), rise(s, c, b)
    ca, ac = rise(s, c, a), rise(s, a, c)
    edges = max(
        abs(ab + ba) + 2.0 * abs(ab - ba),
        abs(bc + cb) + 2.0 * abs(bc - cb),
        abs(ca + ac) + 2.0 * abs(ca - ac),
    )
    unsure = abs(ab - ba) + abs(bc - cb) + abs(ca - ac)
    return max(edges / 8.0, (0.5 * abs(ab + ba + bc + cb + ca + ac) + unsure) / 9.0)


@kernel
def triangle_shape(s, a, b, c):
    """alpha of abc in space, negative when it is turned over against the surface's normals."""
    p = s.point
    ux, uy, uz = p[b, 0] - p[a, 0], p[b, 1] - p[a, 1], p[b, 2] - p[a, 2]
    vx, vy, vz = p[c, 0] - p[a, 0], p[c, 1] - p[a, 1], p[c, 2] - p[a, 2]
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    uu = ux * ux + uy * uy + uz * uz
    uv = ux * vx + uy * vy + uz * vz
    vv = vx * vx + vy * vy + vz * vz
    total = 2.0 * (uu + vv - uv)
    if total == 0.0:
        return 0.0
    alpha = 3.4641016151377544 * math.sqrt(nx * nx + ny * ny + nz * nz) / total
    m = s.normal
    outward = (
        nx * (m[a, 0] + m[b, 0] + m[c, 0])
        + ny * (m[a, 1] + m[b, 1] + m[c, 1])
        + nz * (m[a, 2] + m[b, 2] + m[c, 2])
    )
    return alpha if outward > 0.0 else -alpha
