"""A whole (u, v) domain and its size field become triangles in one call."""

from collections.abc import Sequence
import enum
from typing import Annotated

import numpy
from numpy.typing import NDArray

import surfmesh._core.fields
import surfmesh._core.insertion
import surfmesh._core.optimisation
import surfmesh._core.packing
import surfmesh._core.surfaces
import surfmesh._core.triangulation


SHORTEST: float = 0.66

LONGEST: float = 1.45

LEAST_OF_CHORD: float = 0.5

def dense_samples() -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3))]:
    """
    Barycentric places (25, 3) at which the mesher looks at triangles that are nearly too far: those of the report without the corners, which lie on the surface.
    """

def point_deviations(surface: surfmesh._core.surfaces.Surface, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], size: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None, 3))]]:
    """
    Distances (n,) of points (n, 3) from the surface, and its normals (n, 3) near them.

    uv: (n, 2) parameters of a surface point nearby; size: (n,) of the triangle. Read in the tangent plane where the foot is near, else in the one a Newton step further, else by projection.
    """

def vertex_deviations(surface: surfmesh._core.surfaces.Surface, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], size: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    The same (n,) of points that should be r(u, v) itself: looked at closely only if not.
    """

def triangle_deviations(surface: surfmesh._core.surfaces.Surface, chart: surfmesh._core.surfaces.Chart, corners: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 3), order='C', device='cpu', writable=False)], xy: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 2), order='C', device='cpu', writable=False)], limit: float) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    Largest distance (n,) from the surface at samples of triangles (n, 3, 3) with corners on it.

    xy: (n, 3, 2) the corners in the plane of ``chart``. Four samples each, read in the tangent planes; where these come near to ``limit``, the samples of the report, each with its nearest point.
    """

def cosines_with_surface(surface: surfmesh._core.surfaces.Surface, corners: Annotated[NDArray[numpy.float64], dict(shape=(None, 3, 3), order='C', device='cpu', writable=False)], uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    Of the angles (n,) between triangles (n, 3, 3) and the surface's normals at uv (n, 2).

    NaN where there is no normal.
    """

def identify_seams(tri: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], adj: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], region: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], vertices: int, node: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], segments: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], identity: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int64], dict(shape=(None,))], Annotated[NDArray[numpy.int64], dict(shape=(None,))]]:
    """
    The triangles in space of a domain, whose boundary nodes may be one point there.

    tri, adj (3 m,), region (m,), vertices: of the domain's triangulation. node (k,) int32: the vertex of each
    node of the boundary, or NIL. segments (s, 2) int32: pairs of nodes. identity (k,) int64: the first node
    that is the same point. Returns triangles (3 t,) int32 of points, their corners (3 t,) int32 in the domain,
    the vertex (n,) of each point, and the points (j,) where there is no surface.
    """

class Unmended:
    """What the optimiser has left."""

    @property
    def far(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
        """Triangles (n,) still farther than ``chord`` from the surface."""

    @property
    def folded(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
        """Triangles (n,) turned far from the surface's normals."""

    @property
    def bent(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 2))]:
        """
        Triangles (k, 2) on both sides of edges with more than ``angle`` between them.
        """

    @property
    def angles(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """The angles (k,) there, radians."""

class SizeLimitArrays:
    """At each point the size is at most this."""

    @property
    def points(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3))]:
        """(k, 3) in space"""

    @property
    def sizes(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """(k,) model units"""

    @property
    def uv(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 2))]:
        """(k, 2) parameters of the points; empty where sizes are isotropic"""

    @property
    def metric_root_3d(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 6))]:
        """(k, 6) W; empty where sizes are isotropic"""

class SizeRequests:
    """What a patch asks for, by what is not right there."""

    @property
    def chord(self) -> SizeLimitArrays | None: ...

    @property
    def folds(self) -> SizeLimitArrays | None: ...

    @property
    def angle(self) -> SizeLimitArrays | None: ...

class MappedPatch:
    """The triangles of a patch in space."""

    @property
    def uv(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 2))]:
        """(k, 2) parameters of the vertices of the domain"""

    @property
    def points(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3))]:
        """(n, 3)"""

    @property
    def triangles(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 3))]:
        """(m, 3) of the points"""

    @property
    def uv_triangles(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 3))]:
        """(m, 3) of vertices of the domain"""

    @property
    def vertex(self) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]:
        """(n,) vertex of the domain that each point was computed from"""

    @property
    def non_manifold(self) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]:
        """(k,) points where identification has made no surface"""

    @property
    def sizes(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """
        (n,) of the points: what the field asks for, with what the optimiser made smaller
        """

class PatchState:
    """
    A triangulated domain with its surface frames, and the passes of the optimiser on it.
    """

    def __init__(self, t: surfmesh._core.triangulation.Triangulation, node: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], same: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], on_kinks: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)] | None, surface: surfmesh._core.surfaces.Surface, chart: surfmesh._core.surfaces.Chart, background: surfmesh._core.fields.Background, chord: float | None = None, angle: float | None = None, min_size: float = 0.0, slope: float | None = None, before_pass: object | None = None) -> None:
        """
        t: of the domain, changed in place. node, same (k,): vertices of the boundary's nodes, and of those they coincide with in space. on_kinks (j,): vertices where the surface has two normals. points (k, 3): where the nodes lie; None: on the surface.
        chord (model units), angle (degrees): what is asked for. before_pass: called before each pass of smoothing; may raise to stop the work.
        """

    @property
    def t(self) -> surfmesh._core.triangulation.Triangulation:
        """The triangulation of the domain."""

    @property
    def frames(self) -> surfmesh._core.optimisation.SurfaceFrames: ...

    @property
    def stars(self) -> surfmesh._core.optimisation.Stars: ...

    @property
    def marks(self) -> surfmesh._core.optimisation.VertexMarks: ...

    @property
    def shape(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
        """(triangles,) alpha, as swaps have last seen it"""

    @property
    def swaps(self) -> int: ...

    @property
    def collapses(self) -> int: ...

    @property
    def splits(self) -> int: ...

    @property
    def passes(self) -> int: ...

    def find_stars(self) -> None: ...

    def set_frames(self, vertices: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> None:
        """Put vertices (n,) back on the surface, with their exact metric."""

    def smooth(self, stiffness: float = 2.0) -> int:
        """
        Move every active vertex by one Newton step; returns how many have moved.
        """

    def raise_worst(self, least: float) -> None:
        """
        Raise the smallest alpha around triangles below ``least`` by moves of their free corners.
        """

    def swap(self, good: float = 0.82) -> None:
        """
        Swap edges of triangles below the alpha ``good`` while that raises the smaller one.
        """

    def swap_for_degree(self) -> None:
        """
        Swap edges that bring the degrees of their four vertices nearer to six.
        """

    def swap_at_border(self, bad: float) -> int:
        """
        The same at triangles below the alpha ``bad`` on straight borders, where vertices of three triangles are regular. Returns the swaps made.
        """

    def remove_at_border(self, bad: float) -> int:
        """
        Remove vertices beside straight borders, of triangles below the alpha ``bad``, without which degrees are nearer to regular. Returns how many went.
        """

    def collapse(self) -> None:
        """Remove interior vertices with a short edge, or with few triangles."""

    def remove_worst(self, least: float) -> None:
        """
        Remove corners of triangles below ``least`` where that raises the smallest alpha around.
        """

    def insert_at_worst(self, least: float) -> None:
        """
        Add vertices at triangles below ``least`` where that raises the smallest alpha around.
        """

    def split(self, longest: float = 1.45) -> None:
        """Split interior edges of active vertices that are longer."""

    def split_farthest(self, triangles: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> int:
        """
        Split the edge of each of the triangles (n,) that lies farthest from the surface; returns how many were split.
        """

    def mapped(self, node_uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], node: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], segments: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], identity: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> MappedPatch:
        """
        The triangles in space, seams identified; no pass may come after.

        node_uv: (j, 2) of the nodes that have a vertex, to the last bit. node (k,), segments (s, 2), identity (k,): of boundary loops, the vertex of each node or NIL, pairs of nodes, and for each node the first that is the same point in space; empty where nothing is identified.
        """

    def optimise(self, first: bool = True) -> Unmended:
        """
        Optimise in place; what is good already is left alone. Returns what is left.

        first: the sizes come from no earlier round, and one with finer sizes may follow.
        """

    def size_requests(self, left: Unmended, off_surface: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)] | None = None) -> SizeRequests:
        """
        Upper bounds of the size under which what is ``left`` would be right.

        off_surface: (k,) marks of the nodes that lie off the surface themselves: for the triangles at them smaller sizes are no help.
        """

class PatchSettings:
    """What a patch is meshed on, and how."""

    def __init__(self, surface: object, chart: object, background: object, chord: float | None = None, angle: float | None = None, min_size: float = 0.0, *, box: Sequence[float], expected: int, optimise: bool = True, first: bool = True, with_roots: bool = False, slope: float | None = None, is_width: bool = False, on_lattice: bool = False, fewest: bool = False, largest: float | None = None, before_stage: object | None = None, while_packing: object | None = None, before_pass: object | None = None) -> None:
        """
        chord (model units), angle (degrees): what is asked for. box: x0, y0, x1, y1 of the plane that is packed, in which about ``expected`` circles have room. optimise: else only diagonals are chosen. first: the sizes come from no earlier round. with_roots: W of the vertices is wanted. slope: growth per length that sizes lowered there are graded to on the mesh. is_width: chord is that of the whole band that a triangle needs. on_lattice: sizes are for a lattice laid along principal directions. fewest: sizes up to ``largest`` follow the direction of edges, and the chord is used evenly.
        before_stage is called with each PatchStage, while_packing now and then with the number of circles, before_pass before each pass of smoothing; what they raise stops the work and comes through.
        """

class PatchStage(enum.Enum):
    """Where the work on a patch is."""

    PACKING = 0

    BOUNDARY = 1

    OPTIMISATION = 2

    MAPPING = 3

class PatchEnd(enum.Enum):
    """How the work on a patch ended."""

    DONE = 0

    PACKING_FAILED = 1
    """see ``packing``"""

    BOUNDARY_FAILED = 2
    """see ``boundary``"""

    SURFACE_FAILED = 3
    """its reason is raised"""

    CANCELLED = 4
    """what the caller raised comes through"""

class PatchMesh:
    """What has become of a patch."""

    @property
    def end(self) -> PatchEnd:
        """All else is there where it is DONE."""

    @property
    def packing(self) -> surfmesh._core.packing.PackingStatus: ...

    @property
    def place(self) -> tuple[float, float]:
        """Where the packing ended, if not by its limits."""

    @property
    def circles(self) -> int:
        """How many were packed."""

    @property
    def boundary(self) -> surfmesh._core.insertion.BoundaryOutcome: ...

    @property
    def domain(self) -> surfmesh._core.insertion.DomainMesh:
        """The triangles in the scaled plane."""

    @property
    def mapped(self) -> MappedPatch:
        """The triangles in space."""

    @property
    def metric_root_3d(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 6))]:
        """(k, 6) W of the domain's vertices, if they are wanted"""

    @property
    def requests(self) -> SizeRequests:
        """Smaller sizes, for another round."""

def mesh_loops(settings: PatchSettings, uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], nodes: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], segments: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], inner: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], identity: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)] | None = None) -> PatchMesh:
    """
    Mesh what is on the left of loops, without the interpreter.

    uv (k, 2), nodes (k, 2): the same in the scaled plane; the others as ``recover`` in the room insertion takes them.
    """

def mesh_regions(settings: PatchSettings, uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], nodes: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], pieces: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], segment: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], loop_segments: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], is_hole: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> PatchMesh:
    """
    The same for a planar domain: keep the regions that lie in more outer loops than holes.

    nodes (k, 2). pieces (p, 2) int32: pairs of nodes. segment (p,) int32: the segment that each is
    part of. loop_segments (m, 2) int32: segment and loop. is_hole: (loops,) uint8.
    """
