"""The size field of a plane or a cylinder from the sizes at points of its boundary.

The metric is the same everywhere and the curvature too: one size bounds all others, and from
each point of known size the sizes grow with the distance. See src/fields/source_tree.hpp.
"""

import math

import numpy as np

from surfmesh._core.faces import extent_over
from surfmesh._core.fields import MOST_SOURCE_CELLS, Background, grow_sizes
from surfmesh.errors import SizingError
from surfmesh.geometry.cad_surfaces.elementary import Cylinder, Plane
from surfmesh.geometry.core_surface import as_core_surface
from surfmesh.geometry.differential.chart import Chart
from surfmesh.geometry.planar.planar_domain import PlanarDomain
from surfmesh.geometry.small_matrices import norm
from surfmesh.geometry.surface import Domain, Surface
from surfmesh.sizing.field.size_field import SizeField
from surfmesh.sizing.field.size_law import SizeLaw
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.principal_lattice import LEAST_ROWS
from surfmesh.sizing.rules.size_rules import SizeRules

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
    speeds = speeds_of(surface)
    chart = Chart.uniform(surface.domain, speeds)
    sizes = np.ascontiguousarray(sizes, float)
    uv = np.ascontiguousarray(uv, float).reshape(-1, 2)
    if sizes.shape != (len(uv),) or not (sizes > 0.0).all() or not np.isfinite(uv).all():
        raise SizingError(
            f"sizes on {surface.name!r} must be positive numbers, one for each of {len(uv)} "
            f"finite points; they have shape {sizes.shape}"
        )
    if not as_cut:
        sizes = np.maximum(sizes, sizing.min_size or 0.0)
    rules = SizeRules.of(sizing, _diagonal(surface, sizing, surface.domain))
    if isinstance(surface, Cylinder):
        largest = min(_allowed(rules, surface.radius), largest or math.inf)
        on_lattice = rules.on_lattice()
        if on_lattice and has_room_for_lattice(surface, surface.domain, largest):
            larger = _allowed(on_lattice, surface.radius)
            if larger > largest == _allowed(rules, surface.radius):
                rules, largest = on_lattice, larger
    elif largest is None:
        largest = _allowed(rules, None)
    if not 0.0 < largest < math.inf:
        raise SizingError(
            f"the largest size on {surface.name!r} must be a positive number, not {largest:g}"
        )
    width, height = (float(extent) for extent in chart.extent)
    low = [surface.domain[0][0], surface.domain[1][0]]
    place = (uv - low) * speeds
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
    background = grow_sizes(xy, sizes, metric, slope, largest, box)
    if background is None:
        raise SizingError(
            f"the sizes asked for need more than {MOST_SOURCE_CELLS:,} cells to describe: raise "
            "min_size or growth"
        )
    return background


def speeds_of(surface: Surface) -> tuple[float, float]:
    """|r_u| and |r_v| of a plane or a cylinder."""
    return (surface.radius if isinstance(surface, Cylinder) else 1.0), 1.0


def has_room_for_lattice(surface: Surface, domain: Domain, size: float) -> bool:
    """Has a plane or a cylinder over a box of its parameters enough rows of this size?"""
    sides = (speed * (high - low) for speed, (low, high) in zip(speeds_of(surface), domain))
    return min(sides) >= LEAST_ROWS * size


def _allowed(rules: SizeRules, radius: float | None) -> float:
    """The largest size on a plane, or on a cylinder of this radius."""
    if radius is None or not rules.follows_curvature:
        return rules.clamp[1]
    return float(rules.from_curvature(np.array([1.0 / radius]), np.zeros(1))[0])


def _extent(surface: Surface, domain: Domain) -> float:
    """Of the box in the scaled plane."""
    (u0, u1), (v0, v1) = domain
    return math.hypot(speeds_of(surface)[0] * (u1 - u0), v1 - v0)


def _diagonal(surface: Surface, sizing: Sizing, domain: Domain) -> float:
    """What the rules take for the diagonal of a plane or a cylinder over a box."""
    stated = sizing.max_size and (sizing.chord or sizing.angle or sizing.size)
    if stated:  # the finest size alone is left to the diagonal: that of the rectangle will do
        return _extent(surface, domain)
    return norm(extent_over(as_core_surface(surface), *domain))
