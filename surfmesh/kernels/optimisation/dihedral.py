"""Angles between the normals of two triangles that share an edge."""

import math

from surfmesh.kernels.jit import kernel
from surfmesh.kernels.optimisation.surface_frames import shorten
from surfmesh.kernels.triangulation.local_operations import DEAD
from surfmesh.kernels.triangulation.triangulation import prev_half_edge

NO_AREA = 1e-24  # squared sine of the angle between two sides, or one at a pole: only rounding


@kernel
def dihedral_angle(p, a, b, c, d):
    """Radians between the normals of a-b-c and b-a-d, points (n, 3); 0 where one has no area."""
    ux, uy, uz = p[b, 0] - p[a, 0], p[b, 1] - p[a, 1], p[b, 2] - p[a, 2]
    vx, vy, vz = p[c, 0] - p[a, 0], p[c, 1] - p[a, 1], p[c, 2] - p[a, 2]
    wx, wy, wz = p[d, 0] - p[a, 0], p[d, 1] - p[a, 1], p[d, 2] - p[a, 2]
    mx, my, mz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    nx, ny, nz = uz * wy - uy * wz, ux * wz - uz * wx, uy * wx - ux * wy
    uu, vv = ux * ux + uy * uy + uz * uz, vx * vx + vy * vy + vz * vz
    ww = wx * wx + wy * wy + wz * wz
    mm, nn = mx * mx + my * my + mz * mz, nx * nx + ny * ny + nz * nz
    if not (mm > NO_AREA * uu * vv and nn > NO_AREA * uu * ww):
        return 0.0
    x, y, z = my * nz - mz * ny, mz * nx - mx * nz, mx * ny - my * nx
    return math.atan2(math.sqrt(x * x + y * y + z * z), mx * nx + my * ny + mz * nz)


@kernel
def find_dihedrals_over(t, point, limit, edges, angles):
    """Half-edges (k,) across which triangles turn by more than ``limit`` (radians), the angles.

    One half-edge of each edge between two triangles; borders, seams among them, have none.
    Fills ``edges`` (n,) and ``angles`` (n,) and returns k, at most n.
    """
    found = 0
    for e in range(3 * t.count[1]):
        f = t.adj[e]
        if f <= e or t.region[e // 3] == DEAD or t.region[f // 3] == DEAD:
            continue
        c, d = t.tri[prev_half_edge(e)], t.tri[prev_half_edge(f)]
        angle = dihedral_angle(point, t.tri[e], t.tri[f], c, d)
        if angle > limit and found < len(edges):
            edges[found], angles[found] = e, angle
            found += 1
    return found


@kernel
def dihedral_angles(points, triangles, half_edges, angles):
    """Angle (k,), radians, across the edges of a finished mesh.

    Parameters
    ----------
    points: (n, 3) float64
    triangles: (m, 3) int32
    half_edges: (k, 2) int32, two that run along each edge; -1 in the second: no angle, 0
    angles: (k,) float64, filled

    Where both run the same way, as somewhere on a Moebius strip, one triangle is turned over.
    """
    for k in range(len(half_edges)):
        e, f = half_edges[k, 0], half_edges[k, 1]
        angles[k] = 0.0
        if f < 0:
            continue
        a, b = triangles[e // 3, e % 3], triangles[e // 3, (e + 1) % 3]
        c, d = triangles[e // 3, (e + 2) % 3], triangles[f // 3, (f + 2) % 3]
        angles[k] = dihedral_angle(points, a, b, c, d)


@kernel
def lower_sizes(s, vertices, factors, smallest, active):
    """Scale the wanted lengths at ``vertices`` (n,), down to ``smallest`` of what they were.

    They become active. Returns how many were scaled.
    """
    count = 0
    for k in range(len(vertices)):
        v = vertices[k]
        active[v] = 1
        factor = max(factors[k], smallest / max(s.scale[v], smallest))
        if factor < 1.0:
            shorten(s, v, factor)
            count += 1
    return count
