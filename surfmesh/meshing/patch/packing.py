"""Circles packed over a rectangle or the plane by one call of the core; what failed is raised."""

from collections.abc import Callable

import numpy as np

from surfmesh._core import packing as core
from surfmesh._core.fields import Background
from surfmesh._core.packing import Packing, PackingStatus
from surfmesh.errors import MeshingError, SizingError
from surfmesh.geometry.differential.chart import Chart
from surfmesh.meshing.progress import Stopwatch
from surfmesh.sizing.field.metric_area import box_area
from surfmesh.sizing.field.size_field import SizeField

NO_LIMIT = 1 << 62

VERTICES = 2.0 / np.sqrt(3.0)
"""Unit circles on a unit of metric area."""


def packed_over(
    field: SizeField,
    chart: Chart,
    box: np.ndarray | None = None,
    watch: Stopwatch | None = None,
) -> Packing:
    """Pack the circles of a size field from the middle of a rectangle until it is covered.

    box: (4,) x0, y0, x1, y1 in the plane of ``chart``; None: the whole domain. watch: is told now
    and then that the stage goes on.
    """
    if box is None:
        width, height = chart.extent.tolist()
        x0, y0, x1, y1 = 0.0, 0.0, width, height
        expected = field.expected_vertices()
    else:
        x0, y0, x1, y1 = box.tolist()
        expected = int(VERTICES * box_area(field, box))
    middle = 0.5 * (x0 + x1), 0.5 * (y0 + y1)
    return packed(field.background, (x0, y0, x1, y1), middle, expected, watch=watch)


def packed_discs(
    draw: Callable[[int], np.ndarray],
    box: tuple[float, float, float, float],
    origin: tuple[float, float],
    expected: int,
    wanted: int = NO_LIMIT,
    distance: float = np.inf,
) -> Packing:
    """Pack circles of random radii over the plane; ``draw(n)`` gives the next n radii.

    Raises ``MeshingError`` when the packing cannot go on, ``SizingError`` for what are no radii.
    """

    def radii(count: int) -> np.ndarray:
        drawn = np.asarray(draw(count))
        if drawn.shape != (count,) or not ((drawn > 0.0) & np.isfinite(drawn)).all():
            raise SizingError(f"the random law must give {count} positive radii ({count},)")
        return drawn

    packing = core.pack_discs(radii, box, origin, expected, wanted, distance)
    return _finished(packing, origin)


def packed(
    background: Background,
    box: tuple[float, float, float, float],
    origin: tuple[float, float],
    expected: int,
    wanted: int = NO_LIMIT,
    distance: float = np.inf,
    watch: Stopwatch | None = None,
) -> Packing:
    """Pack circles over the plane from ``origin`` until the front has left ``box``.

    ``expected``: about how many circles there will be. Raises ``MeshingError`` when no three
    circles can be placed about the origin, and ``Cancelled`` when the one who watches wants that.
    """

    def pulse(circles: int) -> None:
        if watch is not None:
            watch.pulse(min(1.0, circles / max(expected, 1)))

    return _finished(core.pack(background, box, origin, expected, wanted, distance, pulse), origin)


def _finished(packing: Packing, origin: tuple[float, float]) -> Packing:
    if packing.status == PackingStatus.FINISHED:
        return packing
    if packing.status == PackingStatus.BAD_START:
        raise MeshingError(f"no circles can be placed about the origin {origin}")
    if packing.status == PackingStatus.TOO_MANY:
        raise MeshingError(f"{packing.t.vertices:,} circles do not suffice: ask for larger sizes")
    raise MeshingError("the packing cannot go on: please report this")
