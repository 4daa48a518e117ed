"""Size tensors, their gradation, and the look-up in a background."""

from typing import Annotated

import numpy
from numpy.typing import NDArray


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

    def __reduce__(self) -> tuple:
        """So that it can be copied and sent to other processes."""

    @property
    def is_anisotropic(self) -> bool: ...

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
