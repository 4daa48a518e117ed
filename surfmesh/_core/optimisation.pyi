"""Swaps, smoothing and splits, measured on the surface."""

from typing import Annotated

import numpy
from numpy.typing import NDArray

import surfmesh._core.fields
import surfmesh._core.triangulation


class SurfaceFrames:
    """
    Where the vertices lie in space, and how to measure there. Arrays are views: they go stale where vertices are added.
    """

    def __init__(self, vertices: int, anisotropic: bool = False) -> None:
        """Frames of so many vertices, all zero but for ``scale``, which is 1."""

    @property
    def point(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3))]:
        """(vertices, 3): r"""

    @property
    def tangent_map(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 6))]:
        """(vertices, 6): B, its two rows one after the other"""

    @property
    def normal(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3))]:
        """(vertices, 3): unit normal, zero at a degenerate point"""

    @property
    def size(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """(vertices,): wanted edge length h"""

    @property
    def scale(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """(vertices,): h over that of the size field, at most 1"""

    @property
    def metric_root_3d(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 6))]:
        """(vertices, 6): W; empty where sizes are isotropic"""

    @property
    def is_anisotropic(self) -> bool:
        """Do the sizes depend on the direction?"""

    @property
    def most_vertices(self) -> int:
        """No edge is split once there are so many."""

    @most_vertices.setter
    def most_vertices(self, arg: int, /) -> None: ...

    def set(self, t: surfmesh._core.triangulation.Triangulation, background: surfmesh._core.fields.Background, vertices: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], r: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], rx: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], ry: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], largest: float) -> None:
        """
        Set the frames of vertices (n,), and their size tensors, from r, r_x, r_y (n, 3).
        """

def chord(frames: SurfaceFrames, v: int, p: int) -> tuple[float, float]:
    """The chord from v to p in the unit tangent plane of v."""

def edge_length(frames: SurfaceFrames, v: int, p: int) -> float:
    """
    Length of the chord in units of the mean wanted size, in its direction, of its ends.
    """

def lift(frames: SurfaceFrames, v: int, x: float, y: float) -> tuple[float, float, float]:
    """
    The step in space, along the tangent plane of v, that looks like (x, y) there.
    """

def shorten(frames: SurfaceFrames, v: int, factor: float) -> None:
    """Scale the wanted lengths at v."""

def triangle_shape(frames: SurfaceFrames, a: int, b: int, c: int) -> float:
    """
    alpha of abc in space, negative when it is turned over against the normals.
    """

def triangle_deviation(frames: SurfaceFrames, a: int, b: int, c: int) -> float:
    """About how far abc lies from a surface with these tangent planes."""

class Stars:
    """The star of each vertex of a domain."""

    def __init__(self, t: surfmesh._core.triangulation.Triangulation) -> None: ...

    @property
    def start(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
        """(vertices,): a half-edge that leaves it, or NIL"""

    @property
    def frozen(self) -> Annotated[NDArray[numpy.uint8], dict(shape=(None,))]:
        """(vertices,): on the border or a fixed edge"""

    @property
    def degree(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
        """(vertices,): how many triangles it has"""

class VertexMarks:
    """What the passes of the optimiser tell each other."""

    def __init__(self, vertices: int) -> None: ...

    @property
    def active(self) -> Annotated[NDArray[numpy.uint8], dict(shape=(None,))]:
        """(vertices,): smoothing and splits look at it"""

    @property
    def dirty(self) -> Annotated[NDArray[numpy.uint8], dict(shape=(None,))]:
        """
        (vertices,): its triangles have changed since swaps last looked at them
        """

def swap_for_shape(t: surfmesh._core.triangulation.Triangulation, frames: SurfaceFrames, marks: VertexMarks, good: float, sweeps: int) -> tuple[int, Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """
    Swap edges at dirty vertices while that raises the smaller alpha of the pair.

    Only of triangles below ``good``. Returns the swaps made, and alpha (triangles,) of those at dirty vertices, 1 for others.
    """

def swap_for_degree(t: surfmesh._core.triangulation.Triangulation, frames: SurfaceFrames, stars: Stars, marks: VertexMarks, least: float) -> int:
    """
    Swap edges that bring the degrees of their four vertices nearer to six.

    Only where the new triangles are better than ``least``. Returns the swaps made.
    """

def newton_step(t: surfmesh._core.triangulation.Triangulation, frames: SurfaceFrames, stars: Stars, v: int, stiffness: float) -> tuple[float, float, float]:
    """
    The step of v in its unit tangent plane that lowers the energy of its star.

    Returns x, y and the smallest alpha of the star, -1 where a triangle is turned over.
    """

def smooth(t: surfmesh._core.triangulation.Triangulation, frames: SurfaceFrames, stars: Stars, marks: VertexMarks, stiffness: float) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
    """
    Move every active vertex by one Newton step; returns the vertices that moved.
    """

def split_edge(t: surfmesh._core.triangulation.Triangulation, e: int, x: float, y: float) -> int:
    """
    Put a vertex at (x, y), on or near the interior edge e, and join it to four corners.

    Returns the vertex, or NIL when a triangle would not be positive.
    """

def find_folded(t: surfmesh._core.triangulation.Triangulation, frames: SurfaceFrames, least: float, at_apex: float) -> Annotated[NDArray[numpy.uint8], dict(shape=(None,))]:
    """
    Which triangles (triangles,) are turned against the surface at one of their corners.

    ``least``: cosine of the largest angle between the normals; ``at_apex``: the same where a corner has no normal.
    """

def dihedral_angles(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], half_edges: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    Radians (k,) between the normals of the triangles at pairs of half-edges (k, 2).

    points: (n, 3). triangles: (m, 3). -1 in the second column: 0, there is no angle. Where both run the same way, as somewhere on a Moebius strip, one triangle is turned over.
    """
