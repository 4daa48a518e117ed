"""Drive the packing kernel: room for its arrays, growing them when they are full."""

from collections.abc import Callable

import numpy as np

from surfmesh._core.fields import Background
from surfmesh.errors import MeshingError
from surfmesh.geometry.differential.chart import Chart
from surfmesh.kernels.fields.background import for_kernels
from surfmesh.kernels.packing.disc_packing import LOOK_AHEAD
from surfmesh.kernels.packing.front import Front, empty_front
from surfmesh.kernels.packing.heap import Heap, empty_heap
from surfmesh.kernels.packing.packing import (
    BAD_START,
    FULL,
    STUCK,
    pack,
    pack_discs,
    start_packing,
    start_packing_discs,
)
from surfmesh.kernels.packing.packing_state import Packing
from surfmesh.kernels.triangulation.triangulation import Triangulation, empty_triangulation
from surfmesh.sizing.field.metric_area import box_area
from surfmesh.sizing.field.size_field import SizeField

NO_LIMIT = 1 << 62

VERTICES = 2.0 / np.sqrt(3.0)
"""Unit circles on a unit of metric area."""


def packed_over(field: SizeField, chart: Chart, box: np.ndarray | None = None) -> Packing:
    """Pack the circles of a size field from the middle of a rectangle until it is covered.

    box: (4,) x0, y0, x1, y1 in the plane of ``chart``; None: the whole domain.
    """
    if box is None:
        width, height = chart.extent.tolist()
        x0, y0, x1, y1 = 0.0, 0.0, width, height
        expected = field.expected_vertices()
    else:
        x0, y0, x1, y1 = box.tolist()
        expected = int(VERTICES * box_area(field, box))
    middle = 0.5 * (x0 + x1), 0.5 * (y0 + y1)
    return packed(field.background, (x0, y0, x1, y1), middle, expected)


def packed_discs(
    draw: Callable[[int], np.ndarray],
    box: tuple[float, float, float, float],
    origin: tuple[float, float],
    expected: int,
    wanted: int = NO_LIMIT,
    distance: float = np.inf,
) -> Packing:
    """Pack circles of random radii over the plane; ``draw(n)`` gives the next n radii.

    Raises ``MeshingError`` when the packing cannot go on.
    """
    packing = _room_for(int(1.1 * expected) + 1000, wanted, box, origin, distance)
    packing = packing._replace(drawn=draw(len(packing.t.xy) + LOOK_AHEAD))
    if start_packing_discs(packing) == BAD_START:
        raise MeshingError(f"no circles can be placed about the origin {origin}")
    while (status := pack_discs(packing)) == FULL:
        packing = _grown(packing)
        more = draw(len(packing.t.xy) + LOOK_AHEAD - len(packing.drawn))
        packing = packing._replace(drawn=np.concatenate([packing.drawn, more]))
    return _finished(packing, status)


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
    packing = _room_for(int(1.1 * expected) + 1000, wanted, box, origin, distance)
    arrays = for_kernels(background)
    if start_packing(packing, arrays) == BAD_START:
        raise MeshingError(f"no circles can be placed about the origin {origin}")
    while (status := pack(packing, arrays)) == FULL:
        packing = _grown(packing)
    return _finished(packing, status)


def _finished(packing: Packing, status: int) -> Packing:
    if status == STUCK:
        raise MeshingError("the packing cannot go on: please report this")
    return packing


def _room_for(
    vertices: int,
    wanted: int,
    box: tuple[float, float, float, float],
    origin: tuple[float, float],
    distance: float = np.inf,
) -> Packing:
    count = np.zeros(10, np.int64)
    count[0] = wanted
    edges = vertices // 4 + 5000
    return Packing(
        empty_triangulation(vertices),
        empty_front(vertices),
        empty_heap(edges),
        np.empty((edges, 2), np.int32),
        np.ones(vertices),
        np.empty(0),
        np.array([*origin, *box, 1.0, 0.0, 1.0, distance * distance]),
        count,
    )


def _grown(p: Packing) -> Packing:
    """The same packing with half as much room again."""
    vertices = len(p.t.xy) * 3 // 2
    edges = len(p.heap.key) * 3 // 2
    t = empty_triangulation(vertices)
    return Packing(
        Triangulation(*(_extended(old, len(new)) for old, new in zip(p.t, t))),
        Front(*(_extended(old, vertices, -1) for old in p.front)),
        Heap(_extended(p.heap.key, edges), _extended(p.heap.edge, edges), p.heap.count),
        _extended(p.parked, edges),
        _extended(p.radius, vertices, 1.0),
        p.drawn,
        p.where,
        p.count,
    )


def _extended(array: np.ndarray, length: int, fill: float = 0) -> np.ndarray:
    if len(array) >= length:
        return array
    longer = np.full((length, *array.shape[1:]), fill, array.dtype)
    longer[: len(array)] = array
    return longer
