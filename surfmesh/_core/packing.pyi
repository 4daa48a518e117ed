"""Section 2 of the paper: the front, and circles placed at it."""

from collections.abc import Sequence
import enum
from typing import Annotated

import numpy
from numpy.typing import NDArray

import surfmesh._core.fields
import surfmesh._core.triangulation


class PackingStatus(enum.Enum):
    """How a packing ended."""

    FINISHED = 0
    """
    The front has left the box, or the wanted number of circles is reached.
    """

    BAD_START = 1
    """There are no three circles at the origin."""

    STUCK = 2
    """No edge of the front can be advanced."""

    TOO_MANY = 3
    """More circles than can be numbered."""

    STOPPED = 4
    """Whoever watches wanted no more."""

class EdgeHeap:
    """Directed edges (a, b) with a key, smallest first."""

    def __init__(self) -> None: ...

    def __len__(self) -> int: ...

    def push(self, key: float, a: int, b: int) -> None: ...

    def pop(self) -> tuple[float, int, int]:
        """Remove and return the smallest (key, a, b)."""

class Packing:
    """Circles, their triangulation of the whole plane, and the front."""

    @property
    def t(self) -> surfmesh._core.triangulation.Triangulation:
        """
        Triangulation of the centres: region DONE within the front, TODO outside.
        """

    @property
    def front(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 3))]:
        """
        (vertices, 3) int32: next and previous circle on the front, and the done half-edge from the circle to the next; NIL off the front
        """

    @property
    def radius(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """(vertices,): got over wanted radius"""

    @property
    def drawn(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """
        (at least vertices,) the radius each circle was to have; (0,) where a field says it
        """

    @property
    def status(self) -> PackingStatus:
        """How the packing ended."""

    @property
    def place(self) -> tuple[float, float]:
        """
        Where it ended, if not by its limits: the origin or the middle of an edge of the front.
        """

    @property
    def steps(self) -> int:
        """Iterations of fits to two and three circles."""

    @property
    def fits(self) -> int:
        """Circles fitted to two others."""

    @property
    def tangents(self) -> int:
        """Circles placed that touch three others."""

    @property
    def closed(self) -> int:
        """Corners of the front that were filled."""

    @property
    def forced(self) -> int:
        """Rounds in which all edges waited."""

    @property
    def overlapping(self) -> int:
        """Circles of drawn radius placed although they overlap others."""

    @property
    def halves(self) -> int:
        """2 where a box was packed in halves, else 0."""

def deviation_along(quadric: Sequence[float], way: Sequence[float], is_width: bool = False) -> float:
    """
    How far a unit equilateral triangle with an edge along way (x, y) lies from the quadric 4 (xx x^2 + 2 xy x y + yy y^2), at the middles of its edges and at its centre. is_width: the width of the band that it needs.
    """

def pack(background: surfmesh._core.fields.Background, box: Sequence[float], origin: Sequence[float], expected: int, wanted: int, distance: float, watch: object | None = None) -> Packing:
    """
    Pack circles of the background's sizes from the origin (x, y) until the front has left the box (x0, y0, x1, y1).

    expected: about how many there will be. wanted: how many at most. distance: from the origin, at most. watch: called now and then with the number of circles so far; what it raises ends the packing. Read how it ended in ``status``.
    """

def pack_box(background: surfmesh._core.fields.Background, box: Sequence[float], expected: int, watch: object | None = None) -> Packing:
    """
    The same for all of a box, from its middle; where 50,000 circles or more are expected in two halves from a line of circles, side by side in the threads that are allowed. ``halves`` is 2 then, and there is no front.
    """

def pack_discs(draw: object, box: Sequence[float], origin: Sequence[float], expected: int, wanted: int, distance: float, watch: object | None = None) -> Packing:
    """
    The same for circles of drawn radii: ``draw(n)`` gives the next n of them, (n,).
    """
