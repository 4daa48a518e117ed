"""A judge of meshes of planar domains: exact signs and areas, and what shapely says of borders."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import shapely
from naive import exact

from judge.index_topology import border_edges, euler_number, faults_of_indices
from judge.verdict import Verdict

NEAR = 1e-8  # of the diagonal: points nearer than 1e-9 of it may have been merged


def judged(
    points: np.ndarray,
    triangles: np.ndarray,
    polygon: shapely.Geometry,
    lines: Sequence[np.ndarray] = (),
    dots: np.ndarray | None = None,
    *,
    touching: bool = False,
) -> Verdict:
    """What is wrong with a mesh of a polygon, in words, and the figures.

    lines (k, 2) and dots (p, 2): what the mesh shall follow, inside the polygon. touching: the
    polygon's borders touch, and its Euler number is not that of its rings.
    """
    faults = faults_of_indices(points, triangles)
    xy = np.ascontiguousarray(points[:, :2])
    if points[:, 2].any():
        faults.append("points off the plane")
    signs = exact.orient_signs(*(xy[corner] for corner in triangles.T))
    if (signs <= 0).any():
        faults.append(f"{int((signs <= 0).sum())} triangles not counter-clockwise")
    low, high = xy.min(axis=0), xy.max(axis=0)
    near = NEAR * float(np.hypot(*(high - low)))
    a, b, c = (xy[corner] for corner in triangles.T)
    (x1, y1), (x2, y2) = (b - a).T, (c - a).T
    area, wanted = float(np.sum(x1 * y2 - y1 * x2)) / 2.0, polygon.area
    if abs(area - wanted) > near * polygon.length + 1e-12 * wanted:
        faults.append(f"area {area:.9g} of {wanted:.9g}")
    faults += _faults_of_border(xy, triangles, polygon, near)
    faults += _faults_of_lines(xy, triangles, lines, dots, near)
    if not touching:
        euler = sum(1 - len(part.interiors) for part in _polygons(polygon))
        if euler_number(triangles) != euler:
            faults.append(f"Euler number {euler_number(triangles)} of {euler}")
    return Verdict(tuple(faults), {"area_error": area / wanted - 1.0})


def _polygons(polygon: shapely.Geometry) -> list[shapely.Polygon]:
    return list(getattr(polygon, "geoms", [polygon]))


def _faults_of_border(
    xy: np.ndarray, triangles: np.ndarray, polygon: shapely.Geometry, near: float
) -> list[str]:
    """The border of the mesh lies on that of the polygon, and is as long."""
    ends = xy[border_edges(triangles)]
    border = shapely.boundary(polygon)
    shapely.prepare(border)
    middles = shapely.points(ends.mean(axis=1))
    faults = []
    off = int((shapely.distance(border, middles) > near).sum())
    off += int((shapely.distance(border, shapely.points(ends.reshape(-1, 2))) > near).sum())
    if off:
        faults.append(f"{off} places of the border off the polygon's")
    length = float(np.hypot(*(ends[:, 1] - ends[:, 0]).T).sum())
    if abs(length - border.length) > 1e-7 * border.length:
        faults.append(f"border of length {length:.9g}, the polygon's is {border.length:.9g}")
    return faults


def _faults_of_lines(
    xy: np.ndarray,
    triangles: np.ndarray,
    lines: Sequence[np.ndarray],
    dots: np.ndarray | None,
    near: float,
) -> list[str]:
    """Edges of the mesh cover each line, a vertex lies at each dot."""
    faults = []
    edges = np.unique(np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)), axis=0)
    ends = xy[edges]
    if lines:
        tree = shapely.STRtree(shapely.linestrings(ends))
        for number, line in enumerate(lines):
            for start, end in pairwise(line):
                if not _covered(start, end, ends, tree, near):
                    faults.append(f"line {number} is not followed from {start} to {end}")
                    break
    if dots is not None and len(dots):
        away = shapely.STRtree(shapely.points(xy)).query_nearest(
            shapely.points(dots), return_distance=True, all_matches=False
        )[1]
        if (away > near).any():
            faults.append(f"{int((away > near).sum())} points are no vertices")
    return faults


def _covered(
    start: np.ndarray, end: np.ndarray, ends: np.ndarray, tree: shapely.STRtree, near: float
) -> bool:
    """Do edges that lie on the segment from start to end cover it without gaps?"""
    segment = shapely.linestrings([start, end])
    found = ends[tree.query(segment, predicate="dwithin", distance=near)]
    flat = shapely.distance(shapely.points(found), segment).max(axis=1) <= near
    length = float(np.hypot(*(end - start)))
    along = np.sort((found[flat] - start) @ (end - start) / length, axis=1)
    reached = 0.0
    for low, high in along[np.argsort(along[:, 0])]:
        if low > reached + 4.0 * near:
            return False
        reached = max(reached, high)
    return reached >= length - 4.0 * near
