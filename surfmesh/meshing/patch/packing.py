"""Circles packed over a rectangle or the plane by one call of the core; what failed is raised."""

from collections.abc import Callable
from typing import NamedTuple

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


class RoomForPacking(NamedTuple):
    """What circles are packed over."""

    box: tuple[float, float, float, float]  # x0, y0, x1, y1 of the scaled plane
    expected: int  # about how many circles have room

    @property
    def middle(self) -> tuple[float, float]:
        """Where the packing begins."""
        x0, y0, x1, y1 = self.box
        return 0.5 * (x0 + x1), 0.5 * (y0 + y1)

    def told(self, watch: Stopwatch) -> Callable[[int], None]:
        """What the core calls with the number of circles so far."""
        return lambda circles: watch.pulse(min(1.0, circles / max(self.expected, 1)))


def room_for_packing(field: SizeField, chart: Chart, box: np.ndarray | None) -> RoomForPacking:
    """box: (4,) in the plane of ``chart``; None: the whole domain."""
    if box is None:
        width, height = chart.extent.tolist()
        return RoomForPacking((0.0, 0.0, width, height), field.expected_vertices())
    x0, y0, x1, y1 = box.tolist()
    return RoomForPacking((x0, y0, x1, y1), int(VERTICES * box_area(field, box)))


def packed_over(field: SizeField, chart: Chart) -> Packing:
    """Pack the circles of a size field from the middle of its rectangle until it is covered."""
    room = room_for_packing(field, chart, None)
    return packed(field.background, room.box, room.middle, room.expected)


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
) -> Packing:
    """Pack circles over the plane from ``origin`` until the front has left ``box``.

    ``expected``: about how many circles there will be. Raises ``MeshingError`` when no three
    circles can be placed about the origin.
    """
    return _finished(core.pack(background, box, origin, expected, wanted, distance), origin)


def _finished(packing: Packing, origin: tuple[float, float]) -> Packing:
    if packing.status == PackingStatus.FINISHED:
        return packing
    raise packing_error(packing.status, packing.t.vertices, origin)


def packing_error(status: PackingStatus, circles: int, origin: tuple[float, float]) -> MeshingError:
    """What it means that a packing is not finished."""
    if status == PackingStatus.BAD_START:
        return MeshingError(f"no circles can be placed about the origin {origin}")
    if status == PackingStatus.TOO_MANY:
        return MeshingError(f"{circles:,} circles do not suffice: ask for larger sizes")
    return MeshingError("the packing cannot go on: please report this")
