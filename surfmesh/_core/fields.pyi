"""Size tensors, their gradation, and the look-up in a background."""

from collections.abc import Sequence
from typing import Annotated

import numpy
from numpy.typing import NDArray


def solve(h: tuple[float, float, float], x: float, y: float) -> tuple[float, float]:
    """H^-1 (x, y)."""

def invert(xx: float, xy: float, yy: float, largest: float) -> tuple[float, float, float]:
    """H = A^-1 with its eigenvalues capped at largest."""

def edge_lengths(xy: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], size: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], edges: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    Metric lengths (n,) of edges (n, 2) between vertices at xy (v, 2) with size tensors (v, 3).
    """

def shape(ux: float, uy: float, vx: float, vy: float) -> float:
    """
    alpha = 4 sqrt(3) area / sum of squared edges, of a triangle with edge vectors u, v.
    """

def triangle_shape(xy: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], size: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> float:
    """
    alpha of the triangle xy (3, 2) in the mean metric of its corners' tensors (3, 3).
    """

class Background:
    """Size tensors on a forest of quadtrees over a box of the scaled plane."""

    def __init__(self, box: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], grid: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], child: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], corner: Annotated[NDArray[numpy.int32], dict(shape=(None, 4), order='C', device='cpu', writable=False)], metric_root: Annotated[NDArray[numpy.float64], dict(shape=(None, 4), order='C', device='cpu', writable=False)], metric_root_3d: Annotated[NDArray[numpy.float64], dict(shape=(None, 6), order='C', device='cpu', writable=False)] | None = None) -> None:
        """
        box (5,): x0, y0, root cells per unit of x and y, largest size. grid (2,): root cells along x and y.
        child (cells,): first of four children, which come after their parent, or -1 for a leaf.
        corner (cells, 4): nodes. metric_root (nodes, 4): A = H^-1, and 1 / h.
        metric_root_3d (nodes, 6): W, xx, xy, xz, yy, yz, zz; left out where sizes are isotropic.
        Raises ValueError for what a look-up could not walk through.
        """

    @property
    def box(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """
        (5,): x0, y0, root cells per unit of x and y, largest size (unit length)
        """

    @property
    def grid(self) -> Annotated[NDArray[numpy.int64], dict(shape=(None,), writable=False)]:
        """(2,): root cells along x and y"""

    @property
    def child(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,), writable=False)]:
        """(cells,): first of four children, or -1 for a leaf"""

    @property
    def corner(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 4), writable=False)]:
        """(cells, 4): nodes; of no meaning but in leaves"""

    @property
    def metric_root(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 4), writable=False)]:
        """(nodes, 4): A = H^-1, and 1 / h"""

    @property
    def metric_root_3d(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 6), writable=False)]:
        """(nodes, 6): W, or (0, 6) where sizes are isotropic"""

    @property
    def is_anisotropic(self) -> bool: ...

    def __reduce__(self) -> tuple:
        """So that it can be copied and sent to other processes."""

    def sizes(self, xy: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3))]:
        """Size tensors H (n, 3) at points (n, 2)."""

    def metric_roots(self, xy: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3))]:
        """A = H^-1 (n, 3) at points (n, 2)."""

    def scalar_sizes(self, xy: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """
        Wanted edge length in space (n,), the shorter of two, at points (n, 2).
        """

    def metric_roots_3d(self, xy: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 6))]:
        """W (n, 6) at points (n, 2): Id / h where sizes are isotropic."""

    def metric_area(self, x1: float, y1: float) -> float:
        """
        Integral of 1 / det H over [x0, x1] x [y0, y1], (x0, y0) the corner of the box.
        """

    def leaf_areas(self, x1: float, y1: float) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 2))], Annotated[NDArray[numpy.float64], dict(shape=(None, 2))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
        """
        Of the leaves in the same rectangle: lower left corners (n, 2), sides (n, 2), metric areas (n,).
        """

    def metric_area_within(self, corners: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> float:
        """
        The same over what lies within an odd number of loops that do not cross.

        corners (m, 2), finite, of loop k from first[k] to first[k + 1], not closed.
        """

    def expected_circles(self, x1: float, y1: float) -> int:
        """About how many circles cover the same rectangle."""

def grow_sizes(place: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], size: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], metric: tuple[float, float, float], slope: float, largest: float, box: tuple[float, float, float, float]) -> Background | None:
    """
    The background of the sizes min(largest, size_k + slope distance_k) of sources at place (n, 2), over box: x0, y0, x1, y1.

    metric: the constant E, F, G. What lies beyond the upper and right sides may be covered too. None where more than MOST_SOURCE_CELLS cells are needed.
    """

MOST_SOURCE_CELLS: int = 67108864

TURN_SLOPE: float = 3.0

def grade(patches: Annotated[NDArray[numpy.int32], dict(shape=(None, 9), order='C', device='cpu', writable=False)], joined: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], point: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], slope: float, size: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')], changed: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu')], number: int, most_visits: int) -> tuple[int, bool]:
    """
    Lower size (nodes,), in place, until no neighbours differ by more than slope allows.

    patches (cells, 9), joined (k, 2): nodes; point (nodes, 3). changed (nodes,): the number of the last gradation that lowered a node; those with the number of this one, and what they lower, are looked at.
    Returns how often a node was visited, and whether most_visits sufficed.
    """

def grade_stretched(patches: Annotated[NDArray[numpy.int32], dict(shape=(None, 9), order='C', device='cpu', writable=False)], joined: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], point: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], slope: float, size: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')], longer: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')], along: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], normal: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], round: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], changed: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu')], number: int, most_visits: int) -> tuple[int, bool]:
    """
    The same of two sizes: longer (nodes,) along the unit tangents along (nodes, 3), size at right angles to them.

    normal (nodes, 3): unit, or zero where there is none. round: (nodes,) where longer stays the longer one, or (0,).
    """

def patch_errors(patches: Annotated[NDArray[numpy.int32], dict(shape=(None, 9), order='C', device='cpu', writable=False)], metric_root: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], step: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], largest: float) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """
    How far the field in each patch (cells, 9) is from bilinear, relative, (cells,); and how many edges wide it is, (cells,).

    metric_root (nodes, 3): A = H^-1. step (cells, 2): width and height. largest: size above which none counts.
    """

def root_cells_of_face(pieces: int) -> int:
    """
    About how many cells the search starts with on a face of so many smooth pieces.
    """

def root_grid(extent: tuple[float, float], cells: int) -> tuple[int, int]:
    """
    How many cells along x and y: about so many, as near to squares as they can be.
    """

def small_sources(places: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], sizes: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], grid: tuple[int, int], extent: tuple[float, float]) -> Annotated[NDArray[numpy.int64], dict(shape=(None, 3))]:
    """
    x, y on the grid of GRID_DEPTH of places (n, 2) in the scaled plane, and how deep the cell there shall be for sizes (n,): (n, 3) int64.
    """

GRID_DEPTH: int = 20

class NodeLaw:
    """What sizes are asked for at the nodes of a field."""

class HiddenFeatures:
    """Where a surface may have features between the nodes of a cell."""

class FieldBuilder:
    """Makes the background of one size field."""

    def __init__(self, grid: tuple[int, int], extent: tuple[float, float], root_step: tuple[float, float], slope: float, largest: float, sides: tuple[Sequence[int], Sequence[bool]], sources: Annotated[NDArray[numpy.int64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], known_sizes: bool, counts_triangles: bool, free_cells: float, most_triangles: float, looks_for_hidden: tuple[bool, bool], coarseness: float = 1.0) -> None:
        """
        grid: root cells along x and y. extent: of the scaled plane. root_step: width and height of a root cell. slope: growth of the size per length. largest: size in the scaled plane above which none counts.
        sides: of each the one that it is joined with, or -1, and whether it runs against it. sources (k, 3): x, y of small sizes on the grid of GRID_DEPTH, and how deep the cell there shall be.
        known_sizes: points of known size have such cells. counts_triangles: beyond free_cells, cells may not be many more than triangles. most_triangles: more are refused, or inf.
        looks_for_hidden: features between the nodes are looked for at all, and in deep cells. coarseness: times the error that a cell may have for a mesh, at least 1.
        """

    def refine(self, law: object, hidden: object) -> tuple[str, tuple[float, float], float]:
        """
        Split cells until the field is accurate: status, place, and number of triangles or cells.

        law, hidden: of the core, or callables: law(xy (n, 2)) -> the twelve arrays of FieldNodes. hidden(deep, low, high (n, 2), normal (n, 3), root (9 n, 3), smallest size (n,)) -> (n,) bool.
        Raises what they raise. The status is done, too_many_triangles, too_many_cells or not_graded.
        """

    def nodes(self) -> tuple:
        """The twelve arrays of FieldNodes, as views; the jacobian (nodes, 6)."""

    def plane(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 2))]:
        """Places (nodes, 2) of the nodes in the scaled plane."""

    def background(self) -> Background:
        """The background; the builder is done with."""
