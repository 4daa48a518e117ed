"""Where the vertices of a planar triangulation lie in space, and how to measure there.

Sizes and shapes are judged on the true surface: a step between two vertices is their chord in
3D, seen in the tangent plane of one of them in units of the wanted edge length,

    y = B d,   B = I^(-1/2) J^T / h,   J = (r_x, r_y),   I = J^T J,

so that a unit step is a unit edge. The way back is a step H y = h I^(-1/2) y in the plane, and
h^2 B^T y in space.

Where sizes are anisotropic the background gives W, and |W d| is the length of d. In the tangent
plane, with the orthonormal frame Q = J I^(-1/2), it is the 2 x 2 tensor V = Q^T W Q, and

    M = J^T W^2 J = G^T G,   G = V I^(1/2),   H = M^(-1/2),   B = H G^T V Q^T,

so that B J = M^(1/2) is symmetric; the way back in space is J H y = B^T (B B^T)^-1 y.
"""

import math
from typing import NamedTuple

import numpy as np

from surfmesh.kernels.fields.background import metric_root_3d_at, scalar_size_at
from surfmesh.kernels.jit import kernel

DEGENERATE = 1e-10  # |r_x x r_y| over |r_x|^2 + |r_y|^2 below which there is no normal


class SurfaceFrames(NamedTuple):
    point: np.ndarray  # (vertices, 3) float64: r
    tangent_map: np.ndarray  # (vertices, 2, 3) float64: B
    normal: np.ndarray  # (vertices, 3) float64: unit normal, zero at a degenerate point
    size: np.ndarray  # (vertices,) float64: wanted edge length h
    scale: np.ndarray  # (vertices,) float64: h over that of the size field, at most 1
    metric_root_3d: np.ndarray  # (vertices, 6) float64: W; empty where sizes are isotropic


def empty_frames(vertices: int, anisotropic: bool = False) -> SurfaceFrames:
    return SurfaceFrames(
        point=np.empty((vertices, 3)),
        tangent_map=np.empty((vertices, 2, 3)),
        normal=np.empty((vertices, 3)),
        size=np.empty(vertices),
        scale=np.ones(vertices),
        metric_root_3d=np.empty((vertices if anisotropic else 0, 6)),
    )


@kernel
def is_anisotropic(s):
    """Do the sizes depend on the direction?"""
    return len(s.metric_root_3d) > 0


@kernel
def set_frames(t, s, background, vertices, r, rx, ry, largest):
    """Set the frames of ``vertices`` (n,) from r, r_x, r_y (n, 3).

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
            s.tangent_map[v, 0, i] = (m11 * rx[k, i] + m12 * ry[k, i]) / h
            s.tangent_map[v, 1, i] = (m12 * rx[k, i] + m22 * ry[k, i]) / h
        if is_anisotropic(s):
            w = metric_root_3d_at(background, t.xy[v, 0], t.xy[v, 1])
            for i in range(6):
                s.metric_root_3d[v, i] = w[i] / s.scale[v]
            _stretch(t, s, v, scale * (e + root), scale * f, scale * (g + root))


@kernel
def _stretch(t, s, v, j11, j12, j22):
    """Make H and B of v anisotropic; they are isotropic, and (j11, j12, j22) is I^(1/2)."""
    h = s.size[v]
    w, b = s.metric_root_3d[v], s.tangent_map[v]
    v11 = v12 = v22 = 0.0
    for i in range(3):  # V = Q^T W Q, with Q^T = h B
        p = _row(w, i, b[0, 0], b[0, 1], b[0, 2])
        v11 += b[0, i] * p
        v12 += b[1, i] * p
        v22 += b[1, i] * _row(w, i, b[1, 0], b[1, 1], b[1, 2])
    v11, v12, v22 = h * h * v11, h * h * v12, h * h * v22
    g11, g12 = v11 * j11 + v12 * j12, v11 * j12 + v12 * j22
    g21, g22 = v12 * j11 + v22 * j12, v12 * j12 + v22 * j22
    # M^(1/2) = (M + d Id) / c, d = det M^(1/2); its inverse by Cramer's rule
    d = abs(g11 * g22 - g12 * g21)
    m11, m12, m22 = g11 * g11 + g21 * g21, g11 * g12 + g21 * g22, g12 * g12 + g22 * g22
    c = math.sqrt(m11 + m22 + 2.0 * d)
    if not (d > 0.0 and c > 0.0):
        return
    c = 1.0 / (c * d)
    h11, h12, h22 = c * (m22 + d), -c * m12, c * (m11 + d)
    t.size[v, 0], t.size[v, 1], t.size[v, 2] = h11, h12, h22
    # H G^T V, to be applied to Q^T
    a11, a12 = h11 * g11 + h12 * g12, h11 * g21 + h12 * g22
    a21, a22 = h12 * g11 + h22 * g12, h12 * g21 + h22 * g22
    b11, b12 = a11 * v11 + a12 * v12, a11 * v12 + a12 * v22
    b21, b22 = a21 * v11 + a22 * v12, a21 * v12 + a22 * v22
    for i in range(3):
        x, y = h * b[0, i], h * b[1, i]
        b[0, i], b[1, i] = b11 * x + b12 * y, b21 * x + b22 * y


@kernel
def _row(w, i, x, y, z):
    """Row i of the symmetric W times (x, y, z)."""
    if i == 0:
        return w[0] * x + w[1] * y + w[2] * z
    if i == 1:
        return w[1] * x + w[3] * y + w[4] * z
    return w[2] * x + w[4] * y + w[5] * z


@kernel
def lift(s, v, x, y):
    """The step in space, along the tangent plane of v, that looks like (x, y) there."""
    b = s.tangent_map[v]
    if not is_anisotropic(s):
        square = s.size[v] * s.size[v]
        x, y = square * x, square * y
    else:
        p = q = r = 0.0
        for i in range(3):
            p += b[0, i] * b[0, i]
            q += b[0, i] * b[1, i]
            r += b[1, i] * b[1, i]
        d = p * r - q * q
        if not d > 0.0:
            return 0.0, 0.0, 0.0
        x, y = (r * x - q * y) / d, (p * y - q * x) / d
    return (
        b[0, 0] * x + b[1, 0] * y,
        b[0, 1] * x + b[1, 1] * y,
        b[0, 2] * x + b[1, 2] * y,
    )


@kernel
def shorten(s, v, factor):
    """Scale the wanted lengths at v."""
    s.size[v] *= factor
    s.scale[v] *= factor
    if is_anisotropic(s):
        for i in range(6):
            s.metric_root_3d[v, i] /= factor


@kernel
def _stretched_length(s, v, dx, dy, dz):
    """|W d| in the metric of v."""
    w = s.metric_root_3d[v]
    x, y, z = _row(w, 0, dx, dy, dz), _row(w, 1, dx, dy, dz), _row(w, 2, dx, dy, dz)
    return math.sqrt(x * x + y * y + z * z)


@kernel
def chord(s, v, p):
    """The chord from v to p in the unit tangent plane of v."""
    dx = s.point[p, 0] - s.point[v, 0]
    dy = s.point[p, 1] - s.point[v, 1]
    dz = s.point[p, 2] - s.point[v, 2]
    b = s.tangent_map
    return (
        b[v, 0, 0] * dx + b[v, 0, 1] * dy + b[v, 0, 2] * dz,
        b[v, 1, 0] * dx + b[v, 1, 1] * dy + b[v, 1, 2] * dz,
    )


@kernel
def edge_length(s, v, p):
    """Length of the chord in units of the mean wanted size, in its direction, of its ends."""
    dx = s.point[p, 0] - s.point[v, 0]
    dy = s.point[p, 1] - s.point[v, 1]
    dz = s.point[p, 2] - s.point[v, 2]
    if is_anisotropic(s):
        first = _stretched_length(s, v, dx, dy, dz)
        second = _stretched_length(s, p, dx, dy, dz)
        return 2.0 * first * second / max(first + second, 1e-300)
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
    """alpha of abc in space, negative when it is turned over against the surface's normals.

    Where sizes are anisotropic it is measured in the mean metric of the corners, and of the area
    only what faces as the surface does counts: a triangle on its edge can have a fine shape.
    """
    p = s.point
    ux, uy, uz = p[b, 0] - p[a, 0], p[b, 1] - p[a, 1], p[b, 2] - p[a, 2]
    vx, vy, vz = p[c, 0] - p[a, 0], p[c, 1] - p[a, 1], p[c, 2] - p[a, 2]
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    m = s.normal
    mx = m[a, 0] + m[b, 0] + m[c, 0]
    my = m[a, 1] + m[b, 1] + m[c, 1]
    mz = m[a, 2] + m[b, 2] + m[c, 2]
    outward = nx * mx + ny * my + nz * mz
    if is_anisotropic(s):
        ux, uy, uz = _stretched(s, a, b, c, ux, uy, uz)
        vx, vy, vz = _stretched(s, a, b, c, vx, vy, vz)
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        length = mx * mx + my * my + mz * mz
        if length > 0.0:
            facing = (nx * mx + ny * my + nz * mz) / length
            nx, ny, nz = facing * mx, facing * my, facing * mz
    uu = ux * ux + uy * uy + uz * uz
    uv = ux * vx + uy * vy + uz * vz
    vv = vx * vx + vy * vy + vz * vz
    total = 2.0 * (uu + vv - uv)
    if total == 0.0:
        return 0.0
    alpha = 3.4641016151377544 * math.sqrt(nx * nx + ny * ny + nz * nz) / total
    return alpha if outward > 0.0 else -alpha


@kernel
def _stretched(s, a, b, c, x, y, z):
    """The step (x, y, z) in the sum of the metrics of a, b and c."""
    m = s.metric_root_3d
    xx = m[a, 0] + m[b, 0] + m[c, 0]
    xy = m[a, 1] + m[b, 1] + m[c, 1]
    xz = m[a, 2] + m[b, 2] + m[c, 2]
    yy = m[a, 3] + m[b, 3] + m[c, 3]
    yz = m[a, 4] + m[b, 4] + m[c, 4]
    zz = m[a, 5] + m[b, 5] + m[c, 5]
    return xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z
