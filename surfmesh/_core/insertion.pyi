"""
Section 3 of the paper: boundary nodes and segments by tracing neighbours.
"""

import enum
from typing import Annotated

import numpy
from numpy.typing import NDArray

import surfmesh._core.fields
import surfmesh._core.triangulation


APART: float = 0.65

AROUND: float = 0.6

LOWEST: float = 0.7

CROWDED: float = 0.5

class Recovery(enum.Enum):
    """How the insertion of a boundary ends."""

    FINISHED = 0

    NODE_TAKEN = 1
    """a node lies on an earlier node or segment"""

    CROSSING = 2
    """a segment crosses an earlier one"""

    SEGMENT_ON_NODE = 3
    """a segment runs through a node"""

    NOT_RECOVERED = 4
    """swaps did not end"""

    LOST = 5
    """a segment is no edge any more"""

    LEAK = 6
    """a loop is open or runs the wrong way"""

    DIFFERENT_LOOPS = 7
    """a region lies in different loops by different ways"""

    UNREACHABLE_REGION = 8
    """a region cannot be reached from the infinite one"""

    NOTHING_INSIDE = 9
    """the holes cover all of the domain"""

class BoundaryOutcome:
    """How an insertion ended, and where."""

    @property
    def status(self) -> Recovery: ...

    @property
    def number(self) -> int:
        """Of the node, segment or region reached, or NIL."""

    @property
    def half_edge(self) -> int:
        """The one concerned, or NIL."""

def coincident_nodes(uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], numbers: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], segments: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None,))]]:
    """
    Which nodes of a boundary are one: by number in space, by place in (u, v).

    uv (k, 2), numbers (k,) int64, segments (s, 2) int32: pairs of nodes. Returns the nodes (n,) that are kept,
    rising, and for each node (k,) where its own is among these.
    """

def loop_nodes(uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], numbers: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], lengths: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.int32], dict(shape=(None,))], Annotated[NDArray[numpy.int32], dict(shape=(None, 2))], Annotated[NDArray[numpy.int64], dict(shape=(None,))], bool]:
    """
    The same for closed loops, one after the other, that have ``lengths`` (l,) nodes each.

    Returns the nodes (n,) that are kept, segments (s, 2) int32 between these, for each of these
    (n,) int64 the first with its number, and whether a segment runs twice the same way.
    """

class DomainMesh:
    """A triangulated domain of the scaled plane."""

    @property
    def t(self) -> surfmesh._core.triangulation.Triangulation: ...

    @property
    def node(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
        """
        (k,) int32: the vertex of each boundary node, NIL where no triangle uses it.
        """

    @property
    def same(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
        """
        (k,) int32: the vertex of the node that each coincides with in space, or its own.
        """

    @property
    def on_kinks(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
        """(j,) int32: vertices where the surface has two normals."""

    @property
    def points(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3))]:
        """(k, 3) where the nodes lie in space, or (0, 3): on the surface."""

class RecoveredDomain:
    """What comes of a recovery."""

    @property
    def outcome(self) -> BoundaryOutcome: ...

    @property
    def domain(self) -> DomainMesh:
        """Of meaning where the outcome is FINISHED."""

def recover(t: surfmesh._core.triangulation.Triangulation, background: surfmesh._core.fields.Background, nodes: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], segments: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], inner: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], identity: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)] | None = None) -> RecoveredDomain:
    """
    Section 3 in a row: insert loops into the packing t (which is used up), keep their inside.

    nodes (k, 2) in the scaled plane. segments (s, 2) int32: pairs of nodes, the inside on their left.
    inner (j, 2) int32: segments with the surface on both sides. identity (k,) int64: the first node
    that is the same point in space. points (k, 3): of the nodes in space, left out where they lie
    on the surface.
    """

def inside_regions(sides: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], loop_segments: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], is_hole: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], infinite: int) -> tuple[Recovery, int, Annotated[NDArray[numpy.uint8], dict(shape=(None,))]]:
    """
    Which regions of the plane lie in more outer loops than holes.

    sides (s, 2) int32: the regions left and right of each segment. loop_segments (m, 2) int32: segment
    and loop. is_hole (loops,) uint8. infinite: number of the unbounded region. Returns the status, the
    region that contradicts, and (regions,) uint8.
    """

def label_patches(adj: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], fixed: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], region: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.int32], dict(shape=(None,))], int]:
    """
    Number the patches between segments: (triangles,) int32, NIL for dead slots; and how many.

    adj (3 triangles,), fixed (3 triangles,), region (triangles,): of a triangulation.
    """

def apexes(background: surfmesh._core.fields.Background, nodes: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], segments: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 2))]:
    """
    Apexes (n, 2) of isosceles triangles with unit legs on the left of segments (s, 2).
    """

def insert_row(t: surfmesh._core.triangulation.Triangulation, background: surfmesh._core.fields.Background, apex: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> int:
    """
    Insert apexes (n, 2) into a packing and clear it around them; the first new vertex.
    """

class Insertion:
    """A packing with a boundary in it, step by step."""

    @property
    def vertex(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
        """(k,) of the nodes"""

    @property
    def edge(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,))]:
        """(s,) half-edges of the segments"""

    @property
    def outcome(self) -> BoundaryOutcome: ...

    @property
    def t(self) -> surfmesh._core.triangulation.Triangulation: ...

    @property
    def first_node(self) -> int:
        """Vertices from this one on are nodes."""

    def grow_inside(self) -> Recovery:
        """Step 5: INSIDE is what is connected to the left side of a segment."""

    def clear_boundary(self) -> int:
        """Step 4: remove what crowds the segments; how many vertices."""

    def swap_bad(self) -> int:
        """Step 4: swap edges of bad triangles; how many."""

def insert_boundary(t: surfmesh._core.triangulation.Triangulation, background: surfmesh._core.fields.Background, nodes: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], segments: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)], with_row: Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order='C', device='cpu', writable=False)]) -> Insertion:
    """
    Steps 2 and 3: insert nodes (k, 2) and segments (s, 2) into the packing t, which is used up,
    with a row of vertices to the left of the segments with_row (r, 2).
    """
