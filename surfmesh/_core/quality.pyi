"""
What a report measures of a finished mesh: its distance from its surfaces and back.
"""

from collections.abc import Callable, Sequence
from typing import Annotated

import numpy
from numpy.typing import NDArray

import surfmesh._core.surfaces


def surface_points(surfaces: list, faces: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], order: int) -> tuple:
    """
    Points (n, 3) of the surfaces of faces (n,) at uv (n, 2); at order 1 r_u and r_v too.
    """

def prepared_surfaces(surfaces: list, faces: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> list:
    """
    The surfaces, with their points and first derivatives to rounding, for many places: a spline is made polynomials where the triangles, those of faces (m,), are many enough.
    """

def far_corners(surfaces: list, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], uv_triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], faces: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], left_out: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], limit: float) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
    """
    Corners (k,), 3 t + i for corner i of triangle t, farther than limit from r(u, v): of each row of uv that a triangle uses the last, but of those of which left_out (m,) is 1.

    The mesh is as for ``mesh_deviation``.
    """

def mesh_deviation(surfaces: list, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], uv_triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], faces: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], edges: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], area: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], in_plane: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float32], dict(shape=(None,))]]:
    """
    Of triangles (m, 3) with uv_triangles (m, 3), rows of points (n, 3) and uv (q, 2), on the surfaces of faces (m,): the largest distance (m,) at vertices, middles and centroid, the mean of its square (m,), the cosine (m,) between the normals, 1 where one is missing.

    edges (k, 2): the half-edges of each, -1 where there is one; area (m,); in_plane (m,): as ``plane_triangles`` has it.
    """

def plane_triangles(surfaces: list, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], uv_triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], faces: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.uint8], dict(shape=(None,))]:
    """
    1 for each triangle (m,) of a plane whose corners are r(u, v) to a billionth of its size: over it no point is farther from the plane, nor the plane from it; else 0.

    The mesh is as for ``mesh_deviation``.
    """

def least_triangles(surfaces: list, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], uv_triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], faces: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], edges: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], area: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], chord: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], corner: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], balanced: bool) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """
    The fewest triangles (f,) that the chord (f,) of each face allows, whatever their shape, and the fewest equilateral ones (f,).

    The mesh is as for ``mesh_deviation``; edges (k, 2): both sides of every edge, or -1; area (m,); corner (n,): 1 where the lines around faces end. balanced: vertices may lie off the surface.
    """

def surface_distances(surfaces: list, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], uv_triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], faces: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], triangle: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], weights: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    How far (k w,) points of the surfaces at barycentric weights (w, 3) over triangles (k,) are from them, triangle after triangle.

    The mesh is as ``mesh_deviation`` takes it.
    """

def sampled_surface(surfaces: list, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], uv_triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], faces: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], triangle: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], rule: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], weights: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 2))], Annotated[NDArray[numpy.float64], dict(shape=(None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """
    Parameters (k, 2) at barycentric weights[rule] (w, 3) of triangles (k,), the points (k, 3) of the surfaces there, and how far (k,) these are from the triangle.

    The mesh is as for ``mesh_deviation``; only the triangles that are asked for are looked at.
    """

def segment_samples(curves: list, limits: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], edges: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], ends: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], segments: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], fractions: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], on_curve: float) -> tuple[Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """
    Which segments (g,) may lie off the curves of their edges, and points (g j, 3) of these at fractions (j,) of the way; and how far (g,) their nodes are from the curve where it is an ellipse and they are at most half a turn apart, else infinity.

    curves: of the edges, None without one, from limits (e, 2) to limits; edges (k,) of the segments (k, 2), rows of points (n, 3), with ends (k, 2), fractions along the edge. Left out: segments on lines, and those whose nodes are farther from the curve than ``on_curve`` of their length.
    """

def dense_deviation(surfaces: list, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], uv_triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], faces: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], triangle: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], weights: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], limit: float, steps: int) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], int, list[float], list[float]]:
    """
    Largest distance (k,) of points of triangles (k,), at barycentric weights (w, 3), from the nearest point of the surface; of the farthest of all its triangle, place and parameters.

    The mesh is as for ``mesh_deviation``; limit, steps: as for ``closest_points_in_triangles``.
    """

def face_creases(surfaces: list, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], uv_triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], faces: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], edges: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], angle: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.uint8], dict(shape=(None,))]:
    """
    Which edges (k,) within faces lie on a crease of their surface, at an apex, or as good as at one: 0 and 1.

    The mesh is as for ``mesh_deviation``; edges (k, 2): the half-edges on both sides; angle (f,): what is asked for of each face, degrees. As good as at an apex: curved so much that this angle would ask for less than the finest size, a fraction of the diagonal of the face's triangles.
    """

class TriangleStars:
    """The triangles at each vertex, and distances of points from them."""

    def __init__(self, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> None:
        """points (n, 3), triangles (m, 3): kept, not copied."""

    def distances(self, places: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangle: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """Distance (k,) of places (k, 3) from one triangle each (k,)."""

    def walk(self, places: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangle: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], distance: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """
        The least of the distances (k,) known of places (k, 3) and those from the triangles that are met from triangle (k,) on, from neighbour to nearer neighbour.
        """

    def distance_from_all(self, place: Sequence[float], distance: float) -> float:
        """The less of the distance known of a place and that from all triangles."""

    def distances_from_stars(self, places: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], vertices: Annotated[NDArray[numpy.int32], dict(shape=(None, None), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """Distance (k,) of places (k, 3) from all triangles at vertices (k, j)."""

class SurfaceSearch:
    """
    How far points of the surfaces lie from a mesh: the largest distance over each triangle, and the farthest point.
    """

    def __init__(self, surfaces: list, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], uv_triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], faces: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], deviation: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], largest: float, chord: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], is_off_face: Callable) -> None:
        """
        The mesh is as for ``mesh_deviation``. deviation (m,): of its triangles from the surfaces; largest: the largest one; chord (f,) of each face, or (1,) of all, up to which it does not matter which triangle is the nearest; is_off_face: does (u, v) over a triangle lie beyond an edge of its face?
        """

    def look_over(self, left_out: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], weights: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> None:
        """
        Look at barycentric weights (w, 3) over the triangles of which left_out (m,) is 0.
        """

    def look_along_rims(self, half_edges: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], fractions: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> None:
        """
        Look along the edges of one triangle only, by half_edges (ne, 2) or -1, at fractions (j,) of their length.
        """

    def look_along_curves(self, curves: list, limits: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], edges: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], ends: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], segments: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], edge_rows: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], half_edges: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], fractions: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], beside_middle: float, on_curve: float) -> int:
        """
        Look at the curves of edges between the ends of their segments, first in the middle and where that does not settle it at all fractions (j,). Returns how many segments that are.

        curves to segments: as for ``segment_samples``, but edges may be out of range: of these nothing is known. edge_rows (k,): rows of half_edges (ne, 2), -1 for no side of a triangle. The middle of an arc settles it where it is as far from the triangle as ``beside_middle`` of its height over the segment.
        """

    def look_closely(self, left_out: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], weights: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], count: int) -> None:
        """
        Look at weights (w, 3) over the ``count`` triangles that are farthest, one way or the other, but those of which left_out (m,) is not 0.
        """

    def farthest(self) -> tuple[float, list[float], list[float], int, bool]:
        """
        The farthest point: its distance, place, (u, v), the triangle that it is over, and whether it was seen along a free rim.
        """

    def largest_over_each(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """
        Over each triangle (m,) the largest distance that was seen; 0 where the triangle itself is too far from the surface. Call it after ``farthest``.
        """

def solid_counts(triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], solid: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], vertices: int, solids: int) -> tuple[Annotated[NDArray[numpy.int64], dict(shape=(None,))], Annotated[NDArray[numpy.int64], dict(shape=(None,))], Annotated[NDArray[numpy.int64], dict(shape=(None,))]]:
    """
    Vertices, edges and open edges (s,) of each of so many solids, by triangles (k, 3) around solid (k,), facing outwards.

    An edge is open where it is not run along as often one way as the other.
    """

def hidden_bounds(surface: surfmesh._core.surfaces.Surface, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], uv_triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangle: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], tolerance: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], seen: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], whole: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], levels: int) -> Annotated[NDArray[numpy.uint8], dict(shape=(None,))]:
    """
    Over which triangles (k,), rows of triangles (m, 3) of points (n, 3) and of uv_triangles (m, 3) of uv (q, 2), the surface surely hides nothing: 1, or 0 where its second derivatives do not say so, over triangles cut in four up to ``levels`` times either.

    tolerance (k,): what may hide; seen (k,): the largest distance at the corners, in the middles of the sides and at the centroid; whole (k,): 1 where all of the box around the triangle in (u, v) counts. Without area it hides nothing.
    """

def enclosed_volumes(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], solid: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], apexes: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    Volumes (s,) that triangles (k, 3) around solid (k,), facing outwards, enclose.

    apexes (s, 3): a point near each solid, which the tetrahedra share that are summed up.
    """

class EdgeFigures:
    """Lengths of the edges (ne,) of a mesh."""

    @property
    def lengths(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """(ne,) model units"""

    @property
    def metric_lengths(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """(ne,) in target sizes; (0,) without these"""

    @property
    def length(self) -> tuple[float, float, float, float]:
        """
        Least, mean, largest and standard deviation of ``lengths``, NaN where one is, or none.
        """

    @property
    def metric_length(self) -> tuple[float, float, float, float]:
        """The same of ``metric_lengths``."""

    @property
    def ratios(self) -> tuple[float, float]:
        """
        Longest over shortest edge at a vertex: the largest, and what 99 of 100 are below; in target sizes where these depend on the direction. NaN without edges of a length.
        """

    @property
    def changes(self) -> tuple[int, float, int]:
        """
        The first edge, -1 for none, along which the difference of sizes is largest over slope times length, that quotient, and how many quotients are above ``most``.
        """

    @property
    def face_lengths(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """
        (f,) mean of the lengths of the edges of each face, 0 without any; an edge between two faces counts for both
        """

    @property
    def face_sizes(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """(f,) likewise of their target sizes"""

class JoinedTriangles:
    """
    Triangles (m, 3) of points (n, 3) on ``faces_in_all`` faces (m,), with their edge table: edges (ne, 2), half_edges (ne, 2), uses (ne,). Kept, not copied, and looked at once.
    """

    def __init__(self, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], faces: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], faces_in_all: int, edges: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], half_edges: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], uses: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> None: ...

    def topology(self, chains: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> tuple[int, int, int, Annotated[NDArray[numpy.int64], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))]]:
        """
        How many vertices are used, components, and edges of one triangle; fans (n,) of triangles at each vertex, as shared edges join them; vertices (k,) of two fans or more, edges (k,) of three triangles or more, edges (k,) that both triangles run along the same way.

        chains (k, 2): half-edges of edges of three triangles or more that are joined.
        """

    def edge_figures(self, sizes: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)] | None, roots: Annotated[NDArray[numpy.float64], dict(shape=(None, 6), order='C', device='cpu', writable=False)] | None, root_triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)] | None, slope: float, most: float) -> EdgeFigures:
        """
        By target sizes (n,), or where these depend on the direction roots (k, 6) of metrics at the corners root_triangles (m, 3); slope: what they may differ by along an edge, over its length, 0: not asked.
        """

    def angles_within_faces(self, limits: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.int64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.int64], dict(shape=(None,))], int]:
        """
        Of the edges between two triangles of one face those (k,) whose angle is beyond the limit (f,) of that face, degrees, and the angle (k,); of the others the largest (f,) in each face, 0 without any; how many (f,) there are in all; the first edge where the largest of the others is, -1 for none.
        """

    def face_shapes(self, area: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], alpha: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.int64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
        """
        Of each face the triangles, the area, the sum of alpha and the least alpha, (f,) each, infinite without a triangle; by triangles of area (m,), alpha (m,).
        """

    def face_distances(self, distance: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], mean_square: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], area: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], marked: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.int64], dict(shape=(None,))]]:
        """
        Of each face the largest distance, the first triangle where it is, the sum of mean square times area, and how many triangles are marked, not 0, (f,) each; by triangles (m,) all.
        """

    def solid_figures(self, solids: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], area: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], bulge: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)] | None, count: int) -> tuple[Annotated[NDArray[numpy.int64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))], int, int, int]:
        """
        Triangles, area and enclosed volume of so many solids, (count,) each, and how many triangles have a solid behind them, before them, and both; solids (m, 2): behind and before each triangle, below 0 for none; bulge (m,): volume between each triangle, if it is curved, and its straight one.
        """

    def explained_areas(self, area: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], distance: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], bend: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)] | None, slant: float) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """
        Area (f,) that faces lose or win by the distance (m,) of their triangles, of an area (m,), from the surface.

        slant: of (distance / height)^2, what the area may differ by; bend (m,): twice the curvature of the sides of quadratic triangles.
        """

    def rim_losses(self, edge: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], sagitta: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], distance: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], sharpest: float) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
        """
        Area that rims lose: of edges (ne,), 0 where one is none, and of faces (f,), of edges of one or two triangles. It is length times the larger of sagitta and the distance (m,) of their triangles over the sine between these, not below ``sharpest``, at most the length.

        Rims are edges of one triangle, and the rows edge (k,) with sagitta (k,), -1 for none.
        """

def edge_sagittas(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], segments: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], edges: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    About twice the sagittas (k,) of segments (k, 2), rows of points (n, 3), by the angles between those that follow each other on one of the edges (k,); 0 where one is alone.
    """

def unused_vertex(triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], vertices: int) -> int:
    """
    The first of so many vertices that belongs to none of triangles (m, 3), or -1.
    """

def is_sound(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], sizes: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)] | None, mid_points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)] | None, uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)] | None, uv_triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)] | None, faces: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], surfaces: int | None) -> bool:
    """
    Does all hold that ``SurfaceMesh.broken_invariant`` is asked for? Corners of triangles (m, 3) are all of points (n, 3), none twice in a triangle, no three of them twice, and no vertex left out; uv_triangles (m, 3) are rows of uv (k, 2), faces (m,) of so many surfaces; all numbers are finite, sizes (n,) positive.
    """

def has_repeated_triangles(triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], vertices: int) -> bool:
    """Have two triangles (m, 3) the same three corners, in any order?"""

def largest_values(values: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], count: int) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
    """
    Numbers of the ``count`` largest of values (n,), rising, or of all where there are no more; of equal ones those that come first. NaN is as large as infinity.
    """

def least_values(values: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], count: int) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
    """
    Numbers of the ``count`` least of values (n,), the least first; of equal ones those that come first. NaN is not among them.
    """

def spread(values: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[float, float, float, float]:
    """
    Least, mean, largest and standard deviation of values (n,); NaN where one is, or none.
    """

def quantile(values: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], fraction: float) -> float:
    """
    As ``np.quantile`` has it, of values (n,), n > 0: linear between two of them in their order, NaN where one is.
    """

def solid_boxes(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], solids: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], count: int) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None, 3))]]:
    """
    The lowest and the highest coordinates (count, 3) of each solid, infinite without a triangle; solids (m, 2): behind and before each of triangles (m, 3), below 0 for none.
    """

def corner_places(triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], uv_triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], vertices: int, places: int) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
    """
    How many places of (u, v) each vertex (n,) has, by the corners of triangles (m, 3) and those of uv_triangles (m, 3).
    """

def binned_counts(values: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], low: float, high: float, bins: int) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]:
    """
    How many of values (k,) lie in each of ``bins`` equal bins from low to high: others in those at the ends, what is not finite in none.
    """
