"""Section 2 of the paper alone: circles packed over the unbounded plane, and their triangles."""

from collections.abc import Callable, Sequence
from dataclasses import astuple, dataclass
from time import perf_counter
from typing import Any, Protocol, runtime_checkable

import numpy as np

from surfmesh._core import NIL
from surfmesh._core.fields import Background
from surfmesh._core.packing import Packing
from surfmesh._core.triangulation import DONE, first_not_ccw
from surfmesh.accuracy.shape import mean_ratio
from surfmesh.errors import SizingError
from surfmesh.geometry.number_range import RANGE
from surfmesh.geometry.planar.planar_domain import PlanarRegion
from surfmesh.meshing.patch.packing import NO_LIMIT, packed, packed_discs
from surfmesh.renamed import Renamed
from surfmesh.sizing.field.size_field import plane_field
from surfmesh.sizing.options.radius_laws import (
    TensorField,
    require_computable,
)
from surfmesh.sizing.options.size_laws import as_numbers

EVERYWHERE = 1e150
"""Half the width of the box when none is given."""

FARTHEST = 1e12
"""The origin is no farther from (0, 0) than so many radii: coordinates lose their last places."""

MOST_CIRCLES, DRAWN = 20_000_000, 1000
"""Circles that are placed, which takes 10 GB; random radii that tell how many there will be."""

FREE_GROWTH = 1e6
"""A radius law is followed as it is given: nothing is graded."""

MARGIN, GRID, MOST_RINGS = 1.5, 128, 400
"""A field is laid over so many times the circles that are asked for, judged on rings."""


@dataclass(frozen=True)
class PackingStatistics:
    """The figures of the paper's Table 2; its columns are named in the comments."""

    nodes: int  # N
    elements: int  # M
    size_error_max: float  # Max1: max(rho / r, r / rho) - 1 of the target radius and the reached
    size_error_mean: float  # Avg1
    neighbour_ratio_max: float  # Max2: of neighbouring radii, the larger over the smaller
    neighbour_ratio_mean: float  # Avg2
    alpha_min: float  # Min3: shape of the triangles; for a tensor field in its metric
    alpha_mean: float  # Avg3
    iterations: float  # average number of iterations or trials a circle
    seconds: float

    max1, avg1 = Renamed("size_error_max"), Renamed("size_error_mean")
    max2, avg2 = Renamed("neighbour_ratio_max"), Renamed("neighbour_ratio_mean")
    min3, avg3 = Renamed("alpha_min"), Renamed("alpha_mean")

    def to_dict(self) -> dict[str, float]:
        """By the columns of the paper's table, as JSON has them."""
        columns = ("nodes", "elements", "max1", "avg1", "max2", "avg2", "min3", "avg3")
        return dict(zip((*columns, "iterations", "seconds"), astuple(self), strict=True))


@dataclass(frozen=True, eq=False)
class CirclePacking:
    """Circles and the triangles of their centres; arrays are read-only."""

    centres: np.ndarray
    """(n, 2) float, in the order in which they were placed."""
    radii: np.ndarray
    """(n,) float, as got: sqrt(det H) / 2 of the ellipses of a tensor field."""
    wanted: np.ndarray
    """(n,) float, as the law asked for at the centre, or drew."""
    tensors: np.ndarray
    """(n, 3) float, size tensors: 2 r Id for circles."""
    triangles: np.ndarray
    """(m, 3) int32, counter-clockwise."""
    front: np.ndarray
    """(k,) int32, the circles of the generation front, counter-clockwise."""
    statistics: PackingStatistics

    def broken_invariant(self) -> str | None:
        """The first broken invariant in words, or None.

        Every triangle is positively oriented, exactly; the whole is a topological disc, and
        the front is its border.
        """
        turned = first_not_ccw(self.centres, self.triangles)
        if turned >= 0:
            return f"triangle {turned} = {self.triangles[turned].tolist()} is not positive"
        start = self.triangles.ravel().astype(np.int64)
        end = self.triangles[:, (1, 2, 0)].ravel()
        width = len(self.centres)
        half_edges = start * width + end
        if len(np.unique(half_edges)) != len(half_edges):
            return "two triangles run along one edge in the same direction"
        twins = np.isin(end * np.int64(width) + start, half_edges)
        border = set(zip(start[~twins].tolist(), end[~twins].tolist()))
        loop = list(zip(self.front.tolist(), np.roll(self.front, -1).tolist()))
        if border != set(loop) or len(set(self.front.tolist())) != len(loop):
            return "the front is not the border of the triangles, once round"
        edges = (len(half_edges) + len(border)) // 2
        if len(self.centres) - edges + len(self.triangles) != 1:
            return "the triangles are not a disc"
        return None

    def plot(self, path: Any, show: str = "both") -> Any:
        """Draw to .svg or .png: "circles", "mesh" or "both"; see ``view.draw_packing``."""
        from surfmesh.view.packing_drawing import draw_packing

        return draw_packing(self, path, show)

    def __repr__(self) -> str:
        return f"CirclePacking({len(self.centres)} circles, {len(self.triangles)} triangles)"


FieldLaw = float | Callable[[np.ndarray], np.ndarray] | TensorField


@runtime_checkable
class RandomLaw(Protocol):
    """Radii in the order in which they are drawn, like ``UniformRadius``."""

    def stream(self) -> Callable[[int], np.ndarray]:
        """A function whose call with n gives the next n radii (n,)."""
        ...


RadiusLaw = FieldLaw | RandomLaw

Box = tuple[float, float, float, float]
"""x0, y0, x1, y1"""


def pack(
    radius: RadiusLaw,
    origin: tuple[float, float] = (0.0, 0.0),
    *,
    count: int | None = None,
    distance: float | None = None,
    box: tuple[float, float, float, float] | None = None,
) -> CirclePacking:
    """Pack circles from ``origin`` outwards until one of the limits is reached (2.4).

    radius: a number; a callable of points (n, 2) -> (n,); a ``TensorField``; or a random law
    such as ``UniformRadius``, whose radii are taken in the order they are drawn, but for one
    that has to wait where a gap is too wide for it. count: number of circles. distance: from
    the origin. box: (x0, y0, x1, y1), passed when no edge of the front meets it.

    Circles of random radius overlap by at most 2 % of the sum of their radii, but for one pair
    in some ten thousand. Raises ``SizingError`` for a law or limits that make no sense, and
    ``MeshingError`` when no circles can be placed about the origin.
    """
    limits = _limits(origin, count, distance, box)
    start = perf_counter()
    x0, y0, x1, y1 = limits.box or (-EVERYWHERE, -EVERYWHERE, EVERYWHERE, EVERYWHERE)
    if isinstance(radius, RandomLaw):
        _require_possible(radius.stream()(DRAWN), limits)
        expected = limits.count if limits.count < NO_LIMIT else 10_000
        packing = packed_discs(
            radius.stream(), (x0, y0, x1, y1), limits.origin, expected, limits.count,
            limits.distance,
        )  # fmt: skip
        shift = np.zeros(2)
    else:
        background, shift, expected = _background(radius, limits)
        dx, dy = shift
        inner, middle = (x0 - dx, y0 - dy, x1 - dx, y1 - dy), np.subtract(limits.origin, shift)
        packing = packed(
            background, inner, (middle[0], middle[1]), expected, limits.count, limits.distance
        )
    return _result(packing, shift, perf_counter() - start, isinstance(radius, TensorField))


@dataclass(frozen=True)
class _Limits:
    """Where the packing starts and where it ends."""

    origin: tuple[float, float]
    count: int
    distance: float
    box: Box | None


def _limits(
    origin: Sequence[float], count: int | None, distance: float | None, box: Sequence[float] | None
) -> _Limits:
    """The same as numbers, ``NO_LIMIT`` and infinity where nothing was said."""
    start = tuple(float(x) for x in origin)
    if len(start) != 2 or not np.isfinite(start).all():
        raise SizingError(f"origin is a point (x, y), not {start!r}")
    if count is None and distance is None and box is None:
        raise SizingError("the plane has no end: give count, distance or box")
    if count is not None and (int(count) != count or count < 3):
        raise SizingError(f"count must be a whole number from 3, not {count!r}")
    if distance is not None and not 0.0 < distance < np.inf:
        raise SizingError(f"distance must be a positive number, not {distance!r}")
    far = max(map(abs, (*start, distance or 0.0, *(box or ()))))
    if RANGE.square <= far < np.inf:
        raise SizingError(f"{far:g} is too far away to compute with; scale what is packed")
    return _Limits(
        (start[0], start[1]),
        NO_LIMIT if count is None else int(count),
        np.inf if distance is None else float(distance),
        None if box is None else _box(box, start),
    )


def _box(box: Sequence[float], origin: Sequence[float]) -> Box:
    numbers = tuple(float(x) for x in box)
    ordered = len(numbers) == 4 and numbers[0] < numbers[2] and numbers[1] < numbers[3]
    if not ordered or not np.isfinite(numbers).all():
        raise SizingError(f"box is (x0, y0, x1, y1) with x0 < x1 and y0 < y1, not {numbers!r}")
    x0, y0, x1, y1 = numbers
    if not (x0 <= origin[0] <= x1 and y0 <= origin[1] <= y1):
        raise SizingError(f"the origin {origin} lies outside the box {numbers}")
    return x0, y0, x1, y1


def _require_possible(drawn: np.ndarray, limits: _Limits) -> None:
    """Of random radii (n,), the first that are drawn."""
    area = np.pi * limits.distance**2
    if limits.box is not None:
        x0, y0, x1, y1 = limits.box
        area = min(area, (x1 - x0) * (y1 - y0))
    _require_near(limits.origin, float(drawn.mean()))
    mean_square = float((drawn**2).mean())
    _require_few(min(area / (2.0 * np.sqrt(3.0) * mean_square), float(limits.count)))


def _require_near(origin: tuple[float, float], radius: float) -> None:
    if max(map(abs, origin)) > FARTHEST * radius:
        raise SizingError(
            f"the origin {origin} is so far from (0, 0) that circles of radius {radius:.3g} "
            "cannot be placed exactly"
        )


def _require_few(number: float) -> None:
    if not number <= MOST_CIRCLES:
        raise SizingError(
            f"about {number:.3g} circles are asked for, more than {MOST_CIRCLES:,}: ask for a "
            "smaller count, distance or box, or for larger radii"
        )


def _background(radius: FieldLaw, limits: _Limits) -> tuple[Background, np.ndarray, int]:
    """Size tensors in coordinates from a corner (2,), and about how many circles there will be."""
    origin, count, distance, box = limits.origin, limits.count, limits.distance, limits.box
    tensors = _tensors(radius)
    here = tensors(np.array([origin]))[0]
    step = float(np.sqrt(here[0] * here[2] - here[1] ** 2))
    _require_near(origin, 0.5 * step)
    if box is None:
        if np.isfinite(distance):
            half = 1.05 * distance + 4.0 * step
        else:
            half = _half_width(tensors, origin, count, step)
        box = (origin[0] - half, origin[1] - half, origin[0] + half, origin[1] + half)
    number = min(_number_within(tensors, box), float(count))
    _require_few(number)
    expected = int(number) + 100
    if not callable(radius):
        size = 2.0 * float(radius)
        one = np.array([1.0 / size, 0.0, 1.0 / size, 1.0 / size])
        shape = np.array([0.0, 0.0, 1.0, 1.0, 1e6 * size])
        corner = np.zeros((1, 4), np.int32)
        cell = np.full(1, -1, np.int32)
        return (
            Background(shape, np.ones(2, np.int64), cell, corner, one[None]),
            np.zeros(2),
            expected,
        )
    plane = PlanarRegion("the plane", ((box[0], box[2]), (box[1], box[3])))
    return plane_field(plane, tensors, FREE_GROWTH).background, np.array(box[:2]), expected


def _tensors(radius: FieldLaw) -> Callable[[np.ndarray], np.ndarray]:
    if isinstance(radius, TensorField):
        return radius
    if not callable(radius):
        try:
            number = float(radius)
        except (TypeError, ValueError, OverflowError):
            number = np.nan
        if not 0.0 < number < np.inf:
            raise SizingError(
                f"radius is a positive number, a callable, a TensorField or UniformRadius, "
                f"not {radius!r}"
            )
        require_computable("radius", number)
        return lambda points: np.tile([2.0 * number, 0.0, 2.0 * number], (len(points), 1))

    def law(points: np.ndarray) -> np.ndarray:
        with np.errstate(all="ignore"):
            r = as_numbers(radius(points.copy()))
        if r is None or r.shape != (len(points),) or not ((r > 0.0) & (r < RANGE.square)).all():
            raise SizingError(
                f"the radius law must give positive numbers of shape ({len(points)},) for points "
                f"({len(points)}, 2)"
            )
        return np.stack([2.0 * r, np.zeros(len(r)), 2.0 * r], axis=1)

    return law


def _number_within(tensors: Callable, box: tuple[float, ...]) -> float:
    """About how many circles have their centre in the box."""
    x = box[0] + (np.arange(GRID) + 0.5) / GRID * (box[2] - box[0])
    y = box[1] + (np.arange(GRID) + 0.5) / GRID * (box[3] - box[1])
    points = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    return _density(tensors, points).mean() * (box[2] - box[0]) * (box[3] - box[1])


def _density(tensors: Callable, points: np.ndarray) -> np.ndarray:
    """Circles per unit of area (n,): a circle's part of the plane is sqrt(3) / 2 det H."""
    h = tensors(points)
    return 2.0 / np.sqrt(3.0) / (h[:, 0] * h[:, 2] - h[:, 1] ** 2)


def _half_width(tensors: Callable, origin: tuple[float, float], count: int, step: float) -> float:
    """Half the side of a square about the origin that holds more than ``count`` circles.

    Rings of geometrically growing radius are summed up, as the field may change on any scale.
    """
    growth = 1.1
    angle = 2.0 * np.pi * np.arange(GRID) / GRID
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    inner, total = 0.0, 0.0
    outer = 0.5 * step
    for _ in range(MOST_RINGS):
        middle = 0.5 * (inner + outer)
        here = _density(tensors, origin + middle * ring).mean()
        total += here * np.pi * (outer**2 - inner**2)
        if total >= MARGIN * count:
            return outer
        inner, outer = outer, growth * outer + 0.25 * step
    raise SizingError(f"the radius grows so fast that the plane does not hold {count:,} circles")


def _result(packing: Packing, shift: np.ndarray, seconds: float, stretched: bool) -> CirclePacking:
    t = packing.t
    n = t.vertices
    is_done = t.region == DONE
    triangles = t.tri.reshape(-1, 3)[is_done]
    h = t.size.copy()
    radii = 0.5 * np.sqrt(h[:, 0] * h[:, 2] - h[:, 1] ** 2)
    if len(packing.drawn):
        wanted = packing.drawn[:n].copy()
        trials = packing.fits / n
    else:
        wanted = radii
        radii = wanted * packing.radius
        trials = packing.steps / max(packing.fits, 1)
    following = packing.front[:, 0]
    front = [int(np.flatnonzero(following != NIL)[0])]
    while (v := int(following[front[-1]])) != front[0]:
        front.append(v)
    centres = t.xy + shift
    done = np.repeat(is_done, 3)
    half_edges = np.flatnonzero(done)
    twins = t.adj[half_edges]
    once = (half_edges < twins) | ~done[twins]
    ends = half_edges + np.where(half_edges % 3 == 2, -2, 1)
    edges = np.stack([t.tri[half_edges], t.tri[ends]], axis=1)[once]
    statistics = PackingStatistics(
        n,
        len(triangles),
        *_extremes(np.maximum(radii / wanted, wanted / radii) - 1.0, np.max),
        *_extremes(_ratio(*radii[edges].T), np.max),
        *_extremes(_alpha(centres, triangles, h if stretched else None), np.min),
        trials,
        seconds,
    )
    arrays = (centres, radii, wanted, h, triangles, np.array(front, np.int32))
    for array in arrays:
        array.setflags(write=False)
    return CirclePacking(*arrays, statistics)


def _extremes(values: np.ndarray, worst: Callable) -> tuple[float, float]:
    return float(worst(values)), float(values.mean())


def _ratio(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.maximum(a / b, b / a)


def _alpha(centres: np.ndarray, triangles: np.ndarray, h: np.ndarray | None) -> np.ndarray:
    """Shape of the triangles (m,); in the mean metric of their corners when ``h`` is given."""
    a, b, c = (centres[corner] for corner in triangles.T)
    u, v = b - a, c - a
    if h is not None:
        h11, h12, h22 = h[triangles].mean(axis=1).T
        det = h11 * h22 - h12 * h12
        u, v = (
            np.stack([h22 * d[:, 0] - h12 * d[:, 1], h11 * d[:, 1] - h12 * d[:, 0]], axis=1)
            / det[:, None]
            for d in (u, v)
        )
    return mean_ratio(u, v)
