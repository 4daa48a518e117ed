"""
What is measured and decided in space: shapes, distances, triangles that meet.
"""

from typing import Annotated

import numpy
from numpy.typing import NDArray


def orient_space(corners: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> float:
    """
    Six times the signed volume of abcd, the rows of (4, 3); its sign is exact: > 0 where abc is seen from d clockwise. nan where a coordinate is not finite.
    """

def triangles_meet(corners: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> bool:
    """
    Do two triangles, the rows of (6, 3), finite, meet where they should not?
    """

def graph_patches(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], half_edges: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None, 6))]]:
    """
    The number (m,) of each triangle's patch that cannot meet itself, -1 where none is proved; the flat patches (k, 6) whose planes each patch is above, across x, y, z, and below, without meeting them, -1: none.

    points (n, 3), finite; triangles (m, 3); half_edges (ne, 2) as of ``edge_table``.
    """

def meeting_triangles(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], most: int, patches: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)] | None = None, support: Annotated[NDArray[numpy.int32], dict(shape=(None, 6), order='C', device='cpu', writable=False)] | None = None) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 2))]:
    """
    Pairs (k, 2) of triangles that meet where they should not, the lower first.

    points (n, 3), finite; triangles (m, 3). The search ends where there are ``most`` pairs or a few more. patches (m,): those of one number that is not -1 do not meet, nor those of a patch those of one in its row of support (k, 6): both of ``graph_patches``.
    """

def edge_table(triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.int32], dict(shape=(None, 2))], Annotated[NDArray[numpy.int32], dict(shape=(None, 2))], Annotated[NDArray[numpy.int32], dict(shape=(None,))]]:
    """
    Edges (ne, 2) of triangles (m, 3), the lower vertex first, in order; the first two half-edges (ne, 2) along each, -1 where there is one; by how many triangles each is used (ne,). Half-edge 3 t + k runs from corner k of triangle t.
    """

def edge_rows(edges: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], pairs: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]:
    """
    Rows (k,) of edges (ne, 2), as of ``edge_table``, of pairs (k, 2) of vertices in either order; -1 where there is none.
    """

def edge_gaps(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], reach: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], ends: Annotated[NDArray[numpy.int64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], edges: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], first_of_face: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None, 6))]]:
    """
    Distance (n,) of each sample from the edges that share a face with its own but no vertex, and boxes (e, 6) around the edges, rows (low, high).

    points (n, 3): samples, of edge e those from first[e] to first[e + 1]; reach (n,): farther than this is not looked at, the distance is infinite. ends (e, 2): vertices; edges, first_of_face: those of each face in one row.
    """

def edge_sags(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    How far (e,) the segments between the samples of each edge lie off its curve, about, at most; points (n, 3), of edge e those from first[e] to first[e + 1].
    """

def triangle_planes(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], chosen: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """
    Unit normals (k, 3), twice the areas (k,) and the longest sides (k,) of some triangles, rows (k,) of (m, 3). A triangle without area has the normal zero.
    """

def triangle_shapes(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """
    Shape of every triangle, measured in 3D, each (m,): area; alpha = 4 sqrt(3) area / sum of squared edges; radius ratio 2 r_in / r_circum; smallest and largest angle in degrees.

    1 is best for alpha and the radius ratio, 0 is a triangle without area.
    """

def interpolate(corner_values: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], corners: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangle: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], rule: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], weights: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None, None))]:
    """
    Values (k, d) at barycentric places in triangles.

    corner_values (n, d); corners (m, 3): rows of them; triangle (k,), rule (k,): the triangle of each sample, and its row of weights (w, 3).
    """

def tangent_plane_offsets(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], feet: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], ru: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], rv: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 7))]:
    """
    Where points (n, 3) lie relative to the tangent planes at feet r(u, v) near them: (n, 7).

    Unit normal along r_u x r_v (zero where there is none); distance along it (the whole distance where there is none); distance within the tangent plane; the step in (u, v) that covers the latter (Gauss-Newton).
    """

def triangle_distances(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], corners: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 3), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    Distance (k,) of points (k, 3), or of one (1, 3), from triangles with corners (k, 3, 3).
    """

def component_labels(count: int, pairs: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
    """
    Label (count,) things 0 .. count - 1 by connected component: the smallest member of each.

    pairs: (k, 2), things that belong together.
    """

class PointTree:
    """The points of a set that are nearest to places."""

    def __init__(self, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> None:
        """points (n, 3), n > 0, finite: copied."""

    def nearest(self, places: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], count: int) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, None))], Annotated[NDArray[numpy.int32], dict(shape=(None, None))]]:
        """
        Distances (p, count) of the nearest points of places (p, 3), and their numbers (p, count); the nearest first, of equally near ones the lower number. Fewer columns where there are fewer points.
        """
