"""A face of a CAD model: its boundary in, its triangles out."""

from collections.abc import Sequence
import enum
from typing import Annotated

import numpy
from numpy.typing import NDArray

import surfmesh._core.edges
import surfmesh._core.fields
import surfmesh._core.patch
import surfmesh._core.sizing
import surfmesh._core.surfaces


class FaceBoundary:
    """
    The boundary of a face, cut into nodes: coedge after coedge, each with both its ends, loop after loop.
    """

    def __init__(self, uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], numbers: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], sizes: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], piece_end: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], degenerate: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], tolerance: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], loop_end: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> None: ...

    @property
    def uv(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 2), writable=False)]:
        """(n, 2)"""

    @property
    def numbers(self) -> Annotated[NDArray[numpy.int64], dict(shape=(None,), writable=False)]:
        """(n,) int64 in the whole mesh"""

    @property
    def points(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)]:
        """(n, 3) on the edges' curves"""

    @property
    def sizes(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """(n,) wanted lengths"""

    @property
    def piece_end(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,), writable=False)]:
        """(p,) int32 of the coedges: the row after their last node"""

    @property
    def degenerate(self) -> Annotated[NDArray[numpy.uint8], dict(shape=(None,), writable=False)]:
        """
        (p,) uint8 of the coedges: one point in space, cut when the metric is known
        """

    @property
    def tolerance(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """(p,) of the coedges: so near is the edge to its p-curves, model units"""

    @property
    def loop_end(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,), writable=False)]:
        """(l,) int32 of the loops: the coedge after their last one"""

    @property
    def has_degenerate(self) -> bool: ...

    @property
    def box(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Of all nodes: (u0, u1), (v0, v1)."""

    def __len__(self) -> int: ...

    def __reduce__(self) -> tuple:
        """So that it can be copied and sent to other processes."""

def may_have_tubes(surface: surfmesh._core.surfaces.Surface, boundary: FaceBoundary) -> bool:
    """
    Is there a pole, or a seam so near to itself all round that no ring of wanted edges fits? A cheap look.
    """

def extent_over(surface: surfmesh._core.surfaces.Surface, u: tuple[float, float], v: tuple[float, float]) -> tuple[float, float, float]:
    """
    Width, depth and height of the bounding box of a plane or a cylinder over u (u0, u1) and v (v0, v1), from points of a coarse grid.
    """

FEWEST_STEPS: float = 2.5

APART: float = 0.001

WAY_SAMPLES: int = 33

class BoundaryBuilder:
    """A boundary put together coedge by coedge, as loops are walked."""

    def __init__(self) -> None: ...

    def add(self, uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], numbers: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], sizes: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], is_degenerate: bool, tolerance: float) -> None:
        """A use of an edge: its nodes in walking order."""

    def end_loop(self) -> None: ...

    def boundary(self) -> FaceBoundary: ...

def fewest_triangles(boundaries: Sequence[FaceBoundary]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """Within each of them (f,) when no node lies inside."""

def alike_faces(boundaries: Sequence[FaceBoundary], areas: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], sorts: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.int64], dict(shape=(None,))], Annotated[NDArray[numpy.int64], dict(shape=(None,))]]:
    """
    Faces whose loops have as many segments, as long, with sizes as large, and areas (f,) as large, all to six digits, if their sorts (f,) int64 are the same.

    The fewest triangles (f,), the mean size at the nodes (f,), infinite where there are none, and the number of the class (f,) int64, from 0 on as they come.
    """

def has_crowded_side(triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], shared: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> bool:
    """
    Is a side between two shared vertices used by more than two triangles (m, 3)?

    shared: (n,) uint8, of the vertices.
    """

def triangles_of_shared(triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], shared: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]:
    """Numbers (k,) of the triangles (m, 3) whose corners are all shared."""

class FacePolygons:
    """Loops as closed polygons: each coedge without its last node."""

    def __init__(self, uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], numbers: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], slots: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], lengths: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> None:
        """
        uv (n, 2), numbers (n,), points (n, 3) of the nodes; slots (n,): their rows in the boundary; lengths (l,): nodes of each loop.
        """

    @staticmethod
    def of(boundary: FaceBoundary) -> FacePolygons:
        """Those of a boundary without degenerate coedges."""

class CoedgeTable:
    """The coedges of all faces of a model."""

    def __init__(self, pcurves: surfmesh._core.edges.CurvePieces, edge: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], is_reversed: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], first_of_loop: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], first_loop_of_face: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], tolerance: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], start: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], corners: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)]) -> None:
        """
        edge, is_reversed (c,): of the coedges, loop after loop, face after face. first_of_loop (l + 1,): coedges of the loops; first_loop_of_face (f + 1,): loops of the faces. tolerance, start (e,): of the edges, the vertex of the mesh that they start at; corners (v, 3): points of these.
        """

    def boundaries(self, faces: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], numbers: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], sizes: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> list[FaceBoundary]:
        """
        Of some faces (f,), when their edges have these nodes.

        first (e + 1,): rows of the edges, none of one that is a point in space. t, points (n, 3), numbers, sizes: normalised parameters, places, numbers in the mesh and wanted lengths.
        """

class CoarseSegments:
    """
    Where segments of a boundary are far longer than the sizes inside allow.
    """

    @property
    def points(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)]:
        """(k, 3) on the surface"""

    @property
    def sizes(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """(k,) of the field there"""

    @property
    def along(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), writable=False)]:
        """(k, 3) unit directions of the segments"""

def coarse_segments(surface: surfmesh._core.surfaces.Surface, chart: surfmesh._core.surfaces.Chart, background: surfmesh._core.fields.Background, polygons: FacePolygons, min_size: float, is_anisotropic: bool) -> CoarseSegments:
    """
    Where segments of the loops are more than twice as long as the sizes inside allow.
    """

class FaceEnd(enum.Enum):
    """How the work on a face ended."""

    DONE = 0

    UNPREPARED = 1
    """
    There is no box, no positive sizes, or more cells are needed than are allowed.
    """

    TUBES = 2
    """It may have thin tubes, which are meshed by themselves."""

    RUNS_TWICE = 3
    """A segment runs twice the same way."""

    PATCH_FAILED = 4
    """See ``patch``."""

    NOT_JOINED = 5
    """At the non-manifold points of ``patch``."""

class FaceMesh:
    """What has become of a face."""

    @property
    def end(self) -> FaceEnd: ...

    @property
    def patch(self) -> surfmesh._core.patch.PatchMesh: ...

    @property
    def coarse(self) -> CoarseSegments:
        """Segments that are to be cut; of a first round."""

    @property
    def slots(self) -> Annotated[NDArray[numpy.int64], dict(shape=(None,), writable=False)]:
        """(n,) of the points: row in the boundary, -1 inside"""

    @property
    def uv(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 2), writable=False)]:
        """(k, 2) of the nodes of the loops"""

    @property
    def segments(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 2), writable=False)]:
        """(s, 2) int32 between these"""

class FaceManner:
    """How a face is meshed, whatever its sizes."""

    def __init__(self, chord: float | None, angle: float | None, min_size: float, optimise: bool = True, first: bool = True, is_anisotropic: bool = False, slope: float | None = None, keeps_lowered: bool = False, on_lattice: bool = False, fewest: bool = False, largest: float | None = None) -> None:
        """
        keeps_lowered: nodes of the boundary keep sizes that were lowered there. chord (model units), angle (degrees), min_size: what is asked for, with 0 for no least size. optimise: else only diagonals are chosen. first: the sizes come from no earlier round. is_anisotropic: they depend on the direction. slope: growth per length that such sizes are graded to on the mesh. on_lattice: sizes are for a lattice laid along principal directions. fewest: sizes up to ``largest`` follow the direction of edges, and the chord is used evenly.
        """

class InwardFace:
    """
    A face with constant speeds |r_u|, |r_v|, whose sizes grow inward from those of its edges.
    """

    @property
    def largest(self) -> float: ...

    @property
    def on_lattice(self) -> bool: ...

def inward_face(surface: surfmesh._core.surfaces.Surface, boundary: FaceBoundary, radius: float | None, asked: surfmesh._core.sizing.AskedRules, slope: float, manner: FaceManner, look_for_tubes: bool = False) -> InwardFace | None:
    """
    A plane (radius None) or a cylinder whose sizes grow by ``slope`` per length up to what the rules allow; None where a coedge is degenerate, or the box of the boundary has no area. look_for_tubes: a face that may have thin tubes is not meshed, see FaceEnd.
    """

class GradedFace:
    """A face whose sizes follow from its curvature and its edges."""

    def __init__(self, of_face: surfmesh._core.surfaces.Surface, over_box: surfmesh._core.surfaces.Surface, is_steady: Sequence[bool], pieces: int, boundary: FaceBoundary, asked: surfmesh._core.sizing.AskedRules, slope: float, manner: FaceManner) -> None:
        """
        of_face: the surface over the domain of the face; over_box: over the box of its boundary. is_steady: |r_u| is the same all along u, |r_v| along v. pieces: smooth ones over the box. boundary: without degenerate coedges. slope: growth of the size per length.
        """

class FaceRows:
    """
    Meshes of faces in rows: those of a face go up to its ends, from those of the face before it.
    """

    @property
    def face(self) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]:
        """(k,) int64 numbers in the queue"""

    @property
    def point_end(self) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]:
        """(k,) int64"""

    @property
    def triangle_end(self) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]:
        """(k,) int64"""

    @property
    def corner_end(self) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]:
        """(k,) int64"""

    @property
    def points(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3))]:
        """(n, 3)"""

    @property
    def slots(self) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]:
        """(n,) of the points: row in the boundary, -1 inside"""

    @property
    def sizes(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """(n,) of the points"""

    @property
    def triangles(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 3))]:
        """(m, 3) of the face's own points"""

    @property
    def uv_triangles(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 3))]:
        """(m, 3) of the face's own corners"""

    @property
    def uv(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 2))]:
        """(k, 2) of the corners"""

class FinishedFaces:
    """Faces that a call of ``FaceQueue.work`` meshed."""

    @property
    def rows(self) -> FaceRows:
        """Those that ask for nothing."""

    @property
    def others(self) -> list[tuple[int, FaceMesh]]:
        """Number and mesh of every other face; they are handed out once."""

    def __bool__(self) -> bool: ...

class FaceQueue:
    """Faces that any threads mesh one after the other, in their order."""

    def __init__(self, faces: Sequence[InwardFace | GradedFace]) -> None: ...

    def work(self, triangles: int) -> FinishedFaces:
        """
        Mesh faces that nobody has begun, without the interpreter, until so many triangles are made; nothing when none is left.
        """

    def stop(self) -> None:
        """Begin no face any more, and finish none."""

class JoinedFaces:
    """Faces as one mesh."""

    @property
    def rank(self) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]:
        """
        (s,) int64 of the shared nodes: their vertices, -1 for those of no triangle
        """

    @property
    def points(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3))]:
        """(n, 3) shared nodes first, then those inside face after face"""

    @property
    def sizes(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """(n,) of the points: the least that is known"""

    @property
    def triangles(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 3))]:
        """(m, 3) of the points, face after face"""

    @property
    def face_ids(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
        """(m,) int32 of the triangles"""

    @property
    def uv(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 2))]:
        """(k, 2) of the corners, face after face"""

    @property
    def uv_triangles(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 3))]:
        """(m, 3) of the corners"""

class FaceJoiner:
    """Joins meshes of faces, given one after the other."""

    def __init__(self) -> None: ...

    def add(self, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], slots: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], sizes: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], uv_triangles: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C', device='cpu', writable=False)], boundary: FaceBoundary, face: int, is_turned: bool) -> None:
        """
        A face with points (n, 3), their slots (n,) in its boundary, -1 inside, and sizes (n,); with triangles (m, 3) of these, and as many of uv (k, 2). is_turned: its triangles turn over.
        """

    def add_row(self, rows: FaceRows, place: int, boundary: FaceBoundary, face: int, is_turned: bool) -> None:
        """The same of the face at a place among the rows of a queue."""

    def joined(self, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], sizes: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> JoinedFaces:
        """
        All of them; points (s, 3), sizes (s,): of the nodes of boundaries by number.
        """

def mesh_face(surface: surfmesh._core.surfaces.Surface, chart: surfmesh._core.surfaces.Chart, background: surfmesh._core.fields.Background, polygons: FacePolygons, manner: FaceManner) -> FaceMesh:
    """Mesh a face with a given size field, without the interpreter."""

def mesh_inward(face: InwardFace) -> FaceMesh:
    """Mesh a face whose sizes grow inward, without the interpreter."""

def metric_areas_inward(faces: Sequence[InwardFace]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    The metric areas (f,) that such sizes give to what lies within the loops; no numbers where there is no box, no positive sizes, or more cells are needed than are allowed.
    """
