"""Random planar domains: pure functions of (seed, number)."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from random import Random

import numpy as np
import shapely
from shapely import affinity

KINDS = ("star", "comb", "circles", "polygon", "collinear", "near holes", "islands", "touching")


@dataclass(frozen=True)
class RandomDomain:
    kind: str
    polygon: shapely.Geometry
    lines: tuple[np.ndarray, ...] = ()
    dots: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))
    size: float = 1.0
    """Wanted edge length."""
    touching: bool = False

    @property
    def loops(self) -> tuple[list[np.ndarray], list[np.ndarray]]:
        """Outer loops and holes, (k, 2) each."""
        parts = list(getattr(self.polygon, "geoms", [self.polygon]))
        outer = [np.array(part.exterior.coords) for part in parts]
        return outer, [np.array(hole.coords) for part in parts for hole in part.interiors]


def domain_of(seed: int, number: int) -> RandomDomain:
    """The domain of this number; of a valid polygon."""
    draw = Random(f"domain {seed} {number}")
    while True:
        kind = draw.choice(KINDS)
        polygon = shapely.normalize(_MAKERS[kind](draw))
        if polygon.is_valid and polygon.area > 0.0 and polygon.geom_type in _POLYGONS:
            break
    polygon = _placed(draw, polygon)
    if not polygon.is_valid:
        return domain_of(seed + 1_000_000, number)
    diagonal = math.dist(polygon.bounds[:2], polygon.bounds[2:])
    dots = _dots(draw, polygon) if draw.random() < 0.4 else np.empty((0, 2))
    lines = _lines(draw, polygon) if draw.random() < 0.5 else ()
    size = diagonal * 10 ** draw.uniform(-1.8, -0.6)
    k = draw.choice((1.0, 1.0, 1e-9, 1e-3, 1e3, 1e9, 1e-25, 1e24))
    scaled = affinity.scale(polygon, k, k, origin=(0, 0))
    lines = tuple(k * line for line in lines)
    return RandomDomain(kind, scaled, lines, k * dots, k * size, kind == "touching")


_POLYGONS = ("Polygon", "MultiPolygon")


def _placed(draw: Random, polygon: shapely.Geometry) -> shapely.Geometry:
    """Turned and moved, often not at all."""
    if draw.random() < 0.6:
        polygon = affinity.rotate(polygon, draw.uniform(0, 360), origin=(0, 0))
    if draw.random() < 0.4:
        away = 10 ** draw.uniform(0, 4)
        polygon = affinity.translate(polygon, draw.uniform(-away, away), draw.uniform(-away, away))
    return polygon


def _lines(draw: Random, polygon: shapely.Geometry) -> tuple[np.ndarray, ...]:
    """Parts of random chords of the box that lie inside, none of which cross."""
    low_x, low_y, high_x, high_y = polygon.bounds
    diagonal, taken = math.hypot(high_x - low_x, high_y - low_y), []
    room = polygon.buffer(-draw.choice((0.0, 1e-3, 2e-2)) * diagonal)
    for _ in range(draw.randint(1, 4)):
        count = draw.randint(2, 4)
        places = [(draw.uniform(low_x, high_x), draw.uniform(low_y, high_y)) for _ in range(count)]
        inside = shapely.intersection(shapely.LineString(places), room)
        for part in getattr(inside, "geoms", [inside]):
            if part.geom_type != "LineString" or part.length < 0.02 * diagonal:
                continue
            if not part.is_simple or any(part.distance(other) < 1e-3 * diagonal for other in taken):
                continue
            if not shapely.contains_properly(polygon, part):
                continue
            taken.append(part)
    return tuple(np.array(line.coords) for line in taken)


def _dots(draw: Random, polygon: shapely.Geometry) -> np.ndarray:
    low_x, low_y, high_x, high_y = polygon.bounds
    places = [(draw.uniform(low_x, high_x), draw.uniform(low_y, high_y)) for _ in range(20)]
    return np.array([p for p in places if polygon.contains(shapely.Point(p))][:5]).reshape(-1, 2)


def _star(draw: Random) -> shapely.Geometry:
    count = draw.randint(3, 40)
    angles = sorted(draw.uniform(0, 2 * math.pi) for _ in range(count))
    return shapely.Polygon([
        (r * math.cos(a), r * math.sin(a)) for a in angles for r in [draw.uniform(0.2, 3)]
    ])  # fmt: skip


def _comb(draw: Random) -> shapely.Geometry:
    teeth, gap = draw.randint(2, 12), 10 ** draw.uniform(-2.5, -0.3)
    points, height = [(0.0, 0.0)], draw.uniform(0.5, 4)
    for k in range(teeth):
        points += [(k, height), (k + 1 - gap, height + draw.choice((0, 0, 0.3)))]
        points += [(k + 1 - gap, 0.3), (k + 1, 0.3)]
    points = points[:-2] + [(teeth - gap, 0.0)]
    return shapely.Polygon(points[1:] + [(0.0, 0.0)])


def _circle(draw: Random, x: float, y: float, r: float) -> shapely.Polygon:
    count, start = draw.choice((3, 5, 12, 48, 200, 720)), draw.uniform(0, 1)
    a = 2 * math.pi * (np.arange(count) + start) / count
    return shapely.Polygon(np.column_stack([x + r * np.cos(a), y + r * np.sin(a)]))


def _circles(draw: Random) -> shapely.Geometry:
    made = _circle(draw, 0, 0, 4)
    for _ in range(draw.randint(0, 5)):
        r = draw.uniform(0.02, 1.5)
        made = made.difference(_circle(draw, draw.uniform(-3, 3), draw.uniform(-3, 3), r))
    return made


def _polygon(draw: Random) -> shapely.Geometry:
    """The hull of random points less other hulls."""

    def hull(size: float, x: float, y: float) -> shapely.Geometry:
        places = [(x + draw.gauss(0, size), y + draw.gauss(0, size)) for _ in range(8)]
        return shapely.convex_hull(shapely.MultiPoint(places))

    made = hull(3, 0, 0)
    for _ in range(draw.randint(0, 4)):
        made = made.difference(hull(draw.uniform(0.1, 0.6), draw.gauss(0, 2), draw.gauss(0, 2)))
    return made


def _collinear(draw: Random) -> shapely.Geometry:
    """A rectangle with many points on its sides, at random and at even places, and steps."""
    width, height, points = draw.uniform(1, 8), draw.uniform(0.3, 4), []
    for a, b in (((0, 0), (1, 0)), ((1, 0), (1, 1)), ((1, 1), (0, 1)), ((0, 1), (0, 0))):
        count = draw.randint(0, 30)
        places = sorted(draw.random() for _ in range(count))
        if draw.random() < 0.5:
            places = [(k + 1) / (count + 1) for k in range(count)]
        for t in (0.0, *places):
            points.append((width * (a[0] + t * (b[0] - a[0])), height * (a[1] + t * (b[1] - a[1]))))
    made = shapely.Polygon(points)
    for _ in range(draw.randint(0, 2)):
        x, y = draw.uniform(0.2, 0.6) * width, draw.uniform(0.2, 0.6) * height
        made = made.difference(shapely.box(x, y, x + 0.2 * width, y + 0.2 * height))
    return made


def _near_holes(draw: Random) -> shapely.Geometry:
    """Two holes, or a hole and the border, with hardly anything between."""
    gap = 10 ** draw.uniform(-5, -1)
    made = shapely.box(-4, -2, 4, 2)
    if draw.random() < 0.5:
        left, right = shapely.box(-2, -1, -gap / 2, 1), shapely.box(gap / 2, -1, 2, 1)
        return made.difference(left).difference(right)
    r = draw.uniform(0.5, 1.5)
    return made.difference(_circle(draw, draw.uniform(-2, 2), 2 - r - gap, r))


def _islands(draw: Random) -> shapely.Geometry:
    made = shapely.Polygon()
    for k in range(draw.randint(2, 6)):
        r = 5.0 - 0.8 * k + draw.uniform(-0.1, 0.1)
        circle = _circle(draw, draw.uniform(-0.05, 0.05), 0, r)
        made = made.symmetric_difference(circle)
    return made if draw.random() < 0.7 else made.union(_circle(draw, 12, 0, 3))


def _touching(draw: Random) -> shapely.Geometry:
    """Holes that touch the border, or each other, in corners."""
    made = shapely.box(-3, -3, 3, 3)
    if draw.random() < 0.5:
        made = made.difference(shapely.Polygon([(0, -3), (1, 0), (-1, 0.5)]))
    for x, y in ((0.0, 0.0), (1.0, 1.0)):
        made = made.difference(shapely.box(x, y, x + 1, y + 1))
    return made


_MAKERS = dict(zip(KINDS, (
    _star, _comb, _circles, _polygon, _collinear, _near_holes, _islands, _touching,
)))  # fmt: skip
