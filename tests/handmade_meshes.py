"""Meshes made by hand, with known answers."""

import numpy as np

from surfmesh.result.surface_mesh import SurfaceMesh


class Sphere:
    """Radius 1 in longitude and latitude; the normal along r_u x r_v points outwards."""

    name = "sphere"
    domain = ((-2 * np.pi, 2 * np.pi), (-np.pi / 2, np.pi / 2))  # charts may cross the seam
    loops = ()

    def evaluate(self, uv, order=0):
        (u, v), zero = uv.T, np.zeros(len(uv))
        cu, su, cv, sv = np.cos(u), np.sin(u), np.cos(v), np.sin(v)
        values = [(cu * cv, su * cv, sv)]
        if order > 0:
            values += [(-su * cv, cu * cv, zero), (-cu * sv, -su * sv, cv)]
        if order > 1:
            values += [
                (-cu * cv, -su * cv, zero),
                (su * sv, -cu * sv, zero),
                (-cu * cv, -su * cv, -sv),
            ]
        return tuple(np.stack(value, axis=-1) for value in values)

    def derivative_bounds(self, lo, hi):
        return None


class Saddle:
    """(u, v, u^2 - v^2) on [-1, 1]^2."""

    name = "saddle"
    domain = ((-1.0, 1.0), (-1.0, 1.0))
    loops = ()

    def evaluate(self, uv, order=0):
        (u, v), one, zero = uv.T, np.ones(len(uv)), np.zeros(len(uv))
        values = [(u, v, u * u - v * v)]
        if order > 0:
            values += [(one, zero, 2 * u), (zero, one, -2 * v)]
        if order > 1:
            values += [(zero, zero, 2 * one), (zero, zero, zero), (zero, zero, -2 * one)]
        return tuple(np.stack(value, axis=-1) for value in values)

    def derivative_bounds(self, lo, hi):
        return None


def grid(surface, cells, **fields):
    """The (u, v) rectangle of ``surface`` in cells x cells squares, halved."""
    (u0, u1), (v0, v1) = surface.domain
    u, v = np.meshgrid(
        np.linspace(u0, u1, cells + 1), np.linspace(v0, v1, cells + 1), indexing="ij"
    )
    uv = np.column_stack((u.ravel(), v.ravel()))
    i = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    right, across, up = i + cells + 1, i + cells + 2, i + 1
    triangles = np.vstack((np.column_stack((i, right, across)), np.column_stack((i, across, up))))
    fields = {"points": surface.evaluate(uv)[0], "surfaces": (surface,)} | fields
    return SurfaceMesh(triangles=triangles, uv_points=uv, **fields)


def icosphere(splits):
    """The icosahedron, each triangle split in four ``splits`` times, on the unit sphere.

    Corner parameters lie on one chart of the longitude for each triangle.
    """
    g = (1 + 5**0.5) / 2
    points = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g)]
    points += [(0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    points = np.array(points) / np.hypot(1, g)
    triangles = np.array(
        "0 11 5 0 5 1 0 1 7 0 7 10 0 10 11 1 5 9 5 11 4 11 10 2 10 7 6 7 1 8 "
        "3 9 4 3 4 2 3 2 6 3 6 8 3 8 9 4 9 5 2 4 11 6 2 10 8 6 7 9 8 1".split(),
        int,
    ).reshape(-1, 3)
    for _ in range(splits):
        middle, extra = {}, list(points)
        new = []
        for a, b, c in triangles.tolist():
            m = []
            for p, q in ((a, b), (b, c), (c, a)):
                key = (min(p, q), max(p, q))
                if key not in middle:
                    middle[key] = len(extra)
                    between = extra[p] + extra[q]
                    extra.append(between / np.linalg.norm(between))
                m.append(middle[key])
            new += [(a, m[0], m[2]), (m[0], b, m[1]), (m[2], m[1], c), tuple(m)]
        points, triangles = np.array(extra), np.array(new)
    corners = points[triangles]
    longitude = np.arctan2(corners[..., 1], corners[..., 0])
    at_pole = np.hypot(corners[..., 0], corners[..., 1]) < 1e-12
    beside = np.where(at_pole[:, :1], longitude[:, 1:2], longitude[:, :1])
    longitude -= 2 * np.pi * np.round((longitude - beside) / (2 * np.pi))
    others = np.where(at_pole, 0, longitude).sum(axis=1, keepdims=True) / 2
    longitude = np.where(at_pole, others, longitude)  # the pole has any longitude
    uv = np.stack((longitude, np.arcsin(np.clip(corners[..., 2], -1, 1))), axis=-1).reshape(-1, 2)
    return SurfaceMesh(
        points=points,
        triangles=triangles,
        uv_points=uv,
        uv_triangles=np.arange(len(uv)).reshape(-1, 3),
        surfaces=(Sphere(),),
    )


def changed(mesh, **fields):
    """A copy with some fields other than they were."""
    names = (
        "points triangles uv_points uv_triangles face_ids surfaces sizes sizing seconds "
        "warnings one_sided facts"
    ).split()
    return SurfaceMesh(**({name: getattr(mesh, name) for name in names} | fields))
