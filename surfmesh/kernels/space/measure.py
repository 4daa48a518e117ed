"""Measures of a finished mesh: shapes of triangles, distances to a surface, connected parts."""

import numpy as np

from surfmesh.kernels.jit import kernel


@kernel
def triangle_shapes(points, triangles, shapes):
    """Shape of every triangle, measured in 3D.

    Parameters
    ----------
    points: (n, 3) float64
    triangles: (m, 3) int32
    shapes: (m, 5) float64, filled: area; alpha = 4 sqrt(3) area / sum of squared edges;
        radius ratio 2 r_in / r_circum; smallest and largest angle in radians. 1 is best for
        alpha and the radius ratio, 0 is a triangle without area.
    """
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        abx, acx = points[b, 0] - points[a, 0], points[c, 0] - points[a, 0]
        aby, acy = points[b, 1] - points[a, 1], points[c, 1] - points[a, 1]
        abz, acz = points[b, 2] - points[a, 2], points[c, 2] - points[a, 2]
        bcx, bcy = points[c, 0] - points[b, 0], points[c, 1] - points[b, 1]
        bcz = points[c, 2] - points[b, 2]
        nx, ny, nz = aby * acz - abz * acy, abz * acx - abx * acz, abx * acy - aby * acx
        twice_area = np.sqrt(nx * nx + ny * ny + nz * nz)
        ab2 = abx * abx + aby * aby + abz * abz
        ac2 = acx * acx + acy * acy + acz * acz
        bc2 = bcx * bcx + bcy * bcy + bcz * bcz
        total = ab2 + bc2 + ac2
        shapes[t, :] = 0.0
        if not total > 0.0:
            continue
        shapes[t, 0] = 0.5 * twice_area
        shapes[t, 1] = 2.0 * np.sqrt(3.0) * twice_area / total
        ab, ac, bc = np.sqrt(ab2), np.sqrt(ac2), np.sqrt(bc2)
        product = ab * ac * bc * (ab + ac + bc)
        if product > 0.0:  # r_in = 2 A / perimeter, r_circum = abc / 4 A
            shapes[t, 2] = 4.0 * twice_area * twice_area / product
        # products of edges, not the law of cosines: its squares cancel in needles
        at_a = np.arctan2(twice_area, abx * acx + aby * acy + abz * acz)
        at_b = np.arctan2(twice_area, -(abx * bcx + aby * bcy + abz * bcz))
        at_c = np.arctan2(twice_area, acx * bcx + acy * bcy + acz * bcz)
        shapes[t, 3] = min(at_a, at_b, at_c)
        shapes[t, 4] = max(at_a, at_b, at_c)


@kernel
def interpolate(corner_values, corners, triangle, rule, weights, found):
    """Values at barycentric places in triangles.

    Parameters
    ----------
    corner_values: (n, d) float64
    corners: (m, 3) int32, rows of ``corner_values``
    triangle: (k,) int32, the triangle of each sample
    rule: (k,) int32, the row of ``weights`` of each sample
    weights: (w, 3) float64, barycentric
    found: (k, d) float64, filled
    """
    for i in range(len(triangle)):
        t, w = triangle[i], rule[i]
        a, b, c = corners[t, 0], corners[t, 1], corners[t, 2]
        wa, wb, wc = weights[w, 0], weights[w, 1], weights[w, 2]
        for d in range(found.shape[1]):
            found[i, d] = (
                wa * corner_values[a, d] + wb * corner_values[b, d] + wc * corner_values[c, d]
            )


@kernel
def tangent_plane_distances(points, feet, ru, rv, found):
    """Where points lie relative to the tangent planes at feet near them.

    Parameters
    ----------
    points, feet, ru, rv: (n, 3) float64; ``feet`` = r(u, v), with its two derivatives
    found: (n, 7) float64, filled: unit normal along r_u x r_v (zero where there is none);
        distance along it (the whole distance where there is none); distance within the
        tangent plane; the step in (u, v) that covers the latter (Gauss-Newton).
    """
    for i in range(len(points)):
        nx = ru[i, 1] * rv[i, 2] - ru[i, 2] * rv[i, 1]
        ny = ru[i, 2] * rv[i, 0] - ru[i, 0] * rv[i, 2]
        nz = ru[i, 0] * rv[i, 1] - ru[i, 1] * rv[i, 0]
        length = np.sqrt(nx * nx + ny * ny + nz * nz)
        dx = points[i, 0] - feet[i, 0]
        dy = points[i, 1] - feet[i, 1]
        dz = points[i, 2] - feet[i, 2]
        squared = dx * dx + dy * dy + dz * dz
        if not length > 0.0:
            found[i, :] = 0.0
            found[i, 3] = np.sqrt(squared)
            found[i, 4] = found[i, 3]
            continue
        nx, ny, nz = nx / length, ny / length, nz / length
        along = dx * nx + dy * ny + dz * nz
        found[i, 0], found[i, 1], found[i, 2] = nx, ny, nz
        found[i, 3] = abs(along)
        found[i, 4] = np.sqrt(max(squared - along * along, 0.0))
        # (d x r_v) . n = du |r_u x r_v| for d = du r_u + dv r_v, likewise for dv
        found[i, 5] = (
            (dy * rv[i, 2] - dz * rv[i, 1]) * nx
            + (dz * rv[i, 0] - dx * rv[i, 2]) * ny
            + (dx * rv[i, 1] - dy * rv[i, 0]) * nz
        ) / length
        found[i, 6] = (
            (ru[i, 1] * dz - ru[i, 2] * dy) * nx
            + (ru[i, 2] * dx - ru[i, 0] * dz) * ny
            + (ru[i, 0] * dy - ru[i, 1] * dx) * nz
        ) / length


@kernel
def component_labels(pairs, parent):
    """Label things 0..count-1 by connected component: the smallest member of each.

    Parameters
    ----------
    pairs: (k, 2) int32, things that belong together
    parent: (count,) int32, filled with the labels

    Union-find with path halving, the smaller root wins.
    """
    for i in range(len(parent)):
        parent[i] = i
    for i in range(len(pairs)):
        a, b = pairs[i, 0], pairs[i, 1]
        while parent[a] != a:
            parent[a] = parent[parent[a]]
            a = parent[a]
        while parent[b] != b:
            parent[b] = parent[parent[b]]
            b = parent[b]
        if a < b:
            parent[b] = a
        else:
            parent[a] = b
    for i in range(len(parent)):  # parents are smaller, so theirs are final already
        parent[i] = parent[parent[i]]
