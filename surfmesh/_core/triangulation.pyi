"""The triangulation of the plane, its predicates, and its local changes."""

from collections.abc import Sequence
from typing import Annotated

import numpy
from numpy.typing import NDArray


TODO: int = 0

DONE: int = 1

INSIDE: int = 1

DEAD: int = 255

def orient(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> float:
    """
    Twice the signed area of abc; its sign is exact: > 0 for counter-clockwise.
    """

def exact_sum(mantissas: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], exponents: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> float:
    """
    About the sum of mantissas 2**exponents (n,), at most 255; its sign is exact.
    """

def inside_loops(corners: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], points: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.uint8], dict(shape=(None,))]:
    """
    1 for each of points (n, 2) within an odd number of loops, 0 for others and for those on a loop.

    corners (m, 2), finite, of loop k from first[k] to first[k + 1], not closed.
    """

def first_not_ccw(xy: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int64], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> int:
    """
    The first of the triangles (m, 3) that is not counter-clockwise, or -1; judged exactly.
    """

CROSSING: int = 16

BLOCK: int = 16

def find_meetings(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], segments: Annotated[NDArray[numpy.int64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], pairs: Annotated[NDArray[numpy.int64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], tolerance: float) -> tuple[Annotated[NDArray[numpy.int64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None, 2))]]:
    """
    How the segments of each pair meet: flags (k,), and places (k, 2), nan where they do not cross.

    Flags of a pair ab, cd: 1 a near cd, 2 b near cd, 4 c near ab, 8 d near ab, CROSSING.
    """

def distances(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], segments: Annotated[NDArray[numpy.float64], dict(shape=(None, 6), order='C', device='cpu', writable=False)], boxes: Annotated[NDArray[numpy.float64], dict(shape=(None, 6), order='C', device='cpu', writable=False)], groups: Annotated[NDArray[numpy.float64], dict(shape=(None, 6), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    Distance (n,) of each point (n, 3) to the nearest segment (s, 6), rows (start, end).

    boxes: (ceil(s / BLOCK), 6), rows (low, high) that bound BLOCK segments in a row. groups: the same for BLOCK boxes in a row.
    """

class Triangulation:
    """
    A triangulation in flat arrays. Arrays are views: they go stale where it grows.
    """

    def __init__(self, xy: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], size: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], tri: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], adj: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], region: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], fixed: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> None: ...

    @property
    def xy(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 2))]:
        """(vertices, 2)"""

    @property
    def size(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3))]:
        """(vertices, 3): size tensors H"""

    @property
    def tri(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
        """(3 triangles,) vertices, NIL in a ghost triangle"""

    @property
    def adj(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
        """(3 triangles,) twin half-edges"""

    @property
    def region(self) -> Annotated[NDArray[numpy.uint8], dict(shape=(None,))]:
        """(triangles,)"""

    @property
    def fixed(self) -> Annotated[NDArray[numpy.uint8], dict(shape=(None,))]:
        """(3 triangles,), or (0,) while there are no segments"""

    @property
    def vertices(self) -> int:
        """How many vertices there are."""

    @property
    def triangles(self) -> int:
        """How many triangles there are, dead ones included."""

    def locate(self, start: int, x: float, y: float, stop: bool = False) -> tuple[int, int]:
        """
        Walk from a half-edge to the triangle of (x, y): the triangle, and NIL or, with ``stop``, the barrier that is in the way.
        """

    def insert_vertex(self, start: int, x: float, y: float, size: Sequence[float], wide: bool = True) -> int:
        """
        Insert a vertex at (x, y) with size tensor (h11, h12, h22), found from a half-edge.

        ``wide``: its star takes the triangles whose metric circumcircle holds it. Returns the vertex, or NIL where a barrier is in the way or no valid star can be made.
        """

    def is_convex(self, e: int) -> bool:
        """
        Can e be swapped: is its quadrilateral strictly convex at both ends of e?
        """

    def swap_edge(self, e: int) -> None:
        """Replace the edge a-b by c-d; the two triangles keep their slots."""

    def remove_vertex(self, e: int) -> int:
        """
        Remove the vertex at the start of e: a half-edge of the new triangles, or NIL where it cannot go. Two slots go DEAD.
        """
