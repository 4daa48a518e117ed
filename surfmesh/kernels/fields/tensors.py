"""Algebra of size tensors H = (h11, h12, h22) and metric lengths; see kernels/__init__."""

import math

from surfmesh.kernels.jit import kernel


@kernel
def solve(h11, h12, h22, x, y):
    """H^-1 (x, y)."""
    det = h11 * h22 - h12 * h12
    return (h22 * x - h12 * y) / det, (h11 * y - h12 * x) / det


@kernel
def length(dx, dy, p11, p12, p22, q11, q12, q22):
    """Metric length of the step (dx, dy) between points with tensors p and q."""
    h11 = 0.5 * (p11 + q11)
    h12 = 0.5 * (p12 + q12)
    h22 = 0.5 * (p22 + q22)
    det = h11 * h22 - h12 * h12
    x = (h22 * dx - h12 * dy) / det
    y = (h11 * dy - h12 * dx) / det
    return math.sqrt(x * x + y * y)


@kernel
def edge_length(xy, size, p, q):
    """Metric length of the edge between vertices p and q."""
    return length(
        xy[q, 0] - xy[p, 0],
        xy[q, 1] - xy[p, 1],
        size[p, 0],
        size[p, 1],
        size[p, 2],
        size[q, 0],
        size[q, 1],
        size[q, 2],
    )


@kernel
def shape(ux, uy, vx, vy):
    """alpha = 4 sqrt(3) area / sum of squared edges, of a triangle with edge vectors u, v."""
    wx = ux - vx
    wy = uy - vy
    total = ux * ux + uy * uy + vx * vx + vy * vy + wx * wx + wy * wy
    if total == 0.0:
        return 0.0
    return 3.4641016151377544 * (ux * vy - uy * vx) / total


@kernel
def triangle_shape(xy, size, a, b, c):
    """alpha of abc in the mean metric of its corners."""
    h11 = size[a, 0] + size[b, 0] + size[c, 0]
    h12 = size[a, 1] + size[b, 1] + size[c, 1]
    h22 = size[a, 2] + size[b, 2] + size[c, 2]
    ux, uy = solve(h11, h12, h22, xy[b, 0] - xy[a, 0], xy[b, 1] - xy[a, 1])
    vx, vy = solve(h11, h12, h22, xy[c, 0] - xy[a, 0], xy[c, 1] - xy[a, 1])
    return shape(ux, uy, vx, vy)
