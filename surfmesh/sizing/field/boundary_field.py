"""The size field of a plane or a cylinder from the sizes at points of its boundary.

The metric is the same everywhere and the curvature too: one size bounds all others, and from
each point of known size the sizes grow with the distance. See src/fields/source_tree.hpp.
"""

import math

import numpy as np

from surfmesh._core.fields import MOST_IN_A_ROW, Background, grow_tree
from surfmesh.errors import SizingError
from surfmesh.geometry.boxes import diagonal
from surfmesh.geometry.cad_surfaces.elementary import Cylinder, Plane
from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.planar.planar_domain import PlanarDomain
from surfmesh.geometry.surface import Surface
from surfmesh.sizing.field.size_field import SizeField
from surfmesh.sizing.field.size_law import SizeLaw
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_rules import SizeRules

FEW_ROOTS, MANY_TESTS = 2, 2e5
"""Sources to a root cell; every root cell looks at all sources, in all no more than so many."""

MOST_CELLS = 1 << 26

_ISOTROPIC = (1.0, 0.0, 1.0)


def has_boundary_field(surface: Surface, sizing: Sizing) -> bool:
    """Can ``boundary_field`` be used: is the metric constant, and no law or source given?

    The metric of a cylinder is constant too where sizes depend on the direction, but they do
    not grow from its edges as they are.
    """
    if sizing.is_anisotropic and isinstance(surface, Cylinder):
        return False
    return isinstance(surface, (Plane, PlanarDomain, Cylinder)) and not sizing.has_law


def boundary_field(
    surface: Surface,
    sizing: Sizing,
    uv: np.ndarray,
    sizes: np.ndarray,
    largest: float | None = None,
    as_cut: bool = False,
) -> SizeField:
    """Sizes that grow by ``sizing.gradient`` from ``sizes`` (n,) at ``uv`` (n, 2).

    ``largest``, model units, bounds them from above; left out, and on a cylinder in any case,
    the rules do so as for any surface, with the diagonal of its box for their defaults.
    None is smaller than ``min_size``, unless the sizes are ``as_cut``: those of edges.
    Raises ``SizingError`` for a surface whose metric changes, for a size law, and for sizes that
    are not positive numbers.
    """
    if not has_boundary_field(surface, sizing):
        raise SizingError(
            f"the metric of {surface.name!r} is not constant, or a size law is given: use "
            "size_field"
        )
    radius = surface.radius if isinstance(surface, Cylinder) else 1.0
    chart = Chart.uniform(surface.domain, (radius, 1.0))
    sizes = np.ascontiguousarray(sizes, float)
    uv = np.ascontiguousarray(uv, float).reshape(-1, 2)
    if sizes.shape != (len(uv),) or not (sizes > 0.0).all() or not np.isfinite(uv).all():
        raise SizingError(
            f"sizes on {surface.name!r} must be positive numbers, one for each of {len(uv)} "
            f"finite points; they have shape {sizes.shape}"
        )
    if not as_cut:
        sizes = np.maximum(sizes, sizing.min_size or 0.0)
    stated = sizing.max_size and (sizing.chord or sizing.angle or sizing.size)
    # the finest size alone is left to the diagonal: that of the rectangle will do
    diagonal = math.hypot(*chart.extent) if stated else _diagonal(surface)
    rules = SizeRules.of(sizing, diagonal)
    allowed = rules.clamp[1]
    if isinstance(surface, Cylinder):
        if rules.follows_curvature:
            allowed = float(rules.from_curvature(np.array([1.0 / radius]), np.zeros(1))[0])
        largest = min(allowed, largest or math.inf)
    elif largest is None:
        largest = allowed
    if not 0.0 < largest < math.inf:
        raise SizingError(
            f"the largest size on {surface.name!r} must be a positive number, not {largest:g}"
        )
    width, height = (float(extent) for extent in chart.extent)
    low = [surface.domain[0][0], surface.domain[1][0]]
    place = (uv - low) * [radius, 1.0]
    box = (0.0, 0.0, width, height)
    background = source_background(place, sizes, largest, sizing.gradient, box)
    return SizeField(chart, background, SizeLaw(surface, chart, rules))


def source_background(
    xy: np.ndarray,
    sizes: np.ndarray,
    largest: float,
    slope: float,
    box: tuple[float, float, float, float],
    metric: tuple[float, float, float] = _ISOTROPIC,
) -> Background:
    """The background over ``box`` (x0, y0, x1, y1) of the size min(largest, h_k + slope d_k).

    ``sizes`` (n,) are the h_k, at ``xy`` (n, 2); d_k is the distance in ``metric``, the constant
    E, F, G. What lies beyond the box's upper and right sides may be covered
    too. Raises ``SizingError`` for a box or a metric without area.
    """
    x0, y0, x1, y1 = box
    E, F, G = metric
    if not (0.0 < x1 - x0 < math.inf and 0.0 < y1 - y0 < math.inf):
        raise SizingError(f"a size field needs a box with width and height, not {box}")
    if not (E > 0.0 and E * G > F * F):
        raise SizingError(f"a metric with E = {E:g}, F = {F:g}, G = {G:g} is not positive")
    wide, high = math.sqrt(E) * (x1 - x0), math.sqrt(G) * (y1 - y0)
    active = int(np.count_nonzero(sizes < largest))
    nx, ny, step = _root_grid(wide, high, active)
    root = (x0, y0, step / math.sqrt(E), step / math.sqrt(G))
    reach = 16.0 * max(x1 - x0, y1 - y0)
    background = grow_tree(
        xy, sizes, (E, F, G), slope, largest, root, (x1, y1), (nx, ny), reach, MOST_CELLS
    )
    if background is None:
        raise SizingError(
            f"the sizes asked for need more than {MOST_CELLS:,} cells to describe: raise "
            "min_size or growth"
        )
    return background


def _root_grid(wide: float, high: float, active: int) -> tuple[int, int, float]:
    """Cells along x and y, and their side: squares, the longer side of the box met exactly."""
    wanted = max(1.0, min(active / FEW_ROOTS, MANY_TESTS / max(active, 1), MOST_IN_A_ROW**2))
    longer, shorter = max(wide, high), min(wide, high)
    side = math.sqrt(longer / wanted) * math.sqrt(shorter)
    if side > shorter:  # one row
        side = max(shorter, longer / wanted)
    step = longer / min(max(int(longer / side), 1), MOST_IN_A_ROW)
    # a box that is a hair too high needs no second row: look-up takes the nearest point
    nx, ny = (max(1, math.ceil(length / step - 1e-9)) for length in (wide, high))
    return nx, ny, step


def _diagonal(surface: Surface) -> float:
    """Of the bounding box in space, from the points of a coarse grid."""
    (u0, u1), (v0, v1) = surface.domain
    u, v = np.linspace(u0, u1, 17), np.array([v0, v1])
    uv = np.stack(np.meshgrid(u, v), axis=-1).reshape(-1, 2)
    (points,) = surface.evaluate(uv, 0)
    return diagonal(points)
