"""The edges of a CAD model: samples, gradation along them, nodes."""

from typing import Annotated

import numpy
from numpy.typing import NDArray


class CurvePieces:
    """The curves of all edges, or coedges, of a model between their ends."""

    def __init__(self, curves: list, t0: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], t1: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> None:
        """curves: n of the core, or None; t0, t1 (n,): parameters at the ends."""

    def __len__(self) -> int: ...

    def points(self, which: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], fraction: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3))]:
        """
        Points (n, 3), with z = 0 of curves in the plane, at fractions (n,) of the ranges of pieces which (k,); of row i those from first[i] to first[i + 1].
        """

    def sags(self, which: int, fraction: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
        """
        How far one piece lies from the chords (n,) between fractions (n + 1,) of its range, at a quarter, the middle and three quarters of each, and how long these are.
        """

def edge_courses(pieces: CurvePieces, which: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], fraction: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], straight: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """
    Points and unit tangents (n, 3), curvature (n,) along pieces which (k,) at fractions (n,) of their ranges, and the integral of the curvature (k,), radians.

    straight: (k,) uint8, the piece is of a line.
    """

def curvatures_along(pieces: CurvePieces, which: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], fraction: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], surfaces: list) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.uint8], dict(shape=(None,))]]:
    """
    Principal curvatures k1 >= k2 (n,) of surfaces along their coedges, and where they are degenerate (n,).

    pieces: the coedges; surfaces: k, one for each of which (k,).
    """

def curvatures_at(uv: Annotated[NDArray[numpy.float64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], surfaces: list) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.uint8], dict(shape=(None,))]]:
    """
    The same of k surfaces at uv (n, 2); of surface i those from first[i] to first[i + 1].
    """

def graded_along_edges(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], sizes: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], ends: Annotated[NDArray[numpy.int64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], vertices: int, slope: float, least_step: float) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    Sizes (n,) that grow by no more than slope times the way along edges and through vertices.

    points (n, 3), sizes (n,): samples, of edge e those from first[e] to first[e + 1]; ends (e, 2): vertices; steps between samples count as least_step at least.
    """

def graded_over_faces(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], sizes: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], ends: Annotated[NDArray[numpy.int64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], vertices: int, first_of_face: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], edges_of_face: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], slope: float, least_step: float, before: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)] | None = None) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    The same where sizes grow straight across faces too.

    edges_of_face (k,): each once, those of face f from first_of_face[f] to first_of_face[f + 1]. before: what this has found for sizes none of which was smaller: only what is smaller now grows.
    """

def cut_to_metric_length(curves: CurvePieces, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], fraction: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], sizes: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], ends: Annotated[NDArray[numpy.int64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], corners: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], which: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], fewest: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], first_given: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], given: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], chord: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], shortest: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], most: float) -> tuple[Annotated[NDArray[numpy.int64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None, 3))], Annotated[NDArray[numpy.float64], dict(shape=(None,))], int, float]:
    """
    Nodes of the edges in which (k,): offsets (k + 1,), fractions t (m,), points (m, 3), sizes (m,); and the row of an edge of more than ``most`` pieces with their number, or -1.

    points (n, 3), fraction (n,), sizes (n,): samples, of edge e those from first[e] to first[e + 1]; ends (e, 2): rows of corners (v, 3). fewest (k,): pieces. given: the nodes of row i from first_given[i] to first_given[i + 1], none where they are to be found. chord (k,): what a found piece may sag by at most, infinite for nothing, unless its chord is no longer than shortest (k,).
    """

def rows_of(first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], which: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]:
    """
    The rows first[k] to first[k + 1] of each k in which (n,), one after the other: (m,) int64.
    """

def node_numbers(first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], ends: Annotated[NDArray[numpy.int64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], known: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], following: int) -> Annotated[NDArray[numpy.int64], dict(shape=(None,))]:
    """
    Numbers (n,) int64 of the nodes of edges, of edge k those from first[k] to first[k + 1]: ends (k, 2) are theirs; nodes with one in known (n,), not -1, keep it, and the others count on from ``following``. known (0,): there is none.
    """

ROUND_A_TUBE: float = 3.455751918948773

def narrow_faces(curves: CurvePieces, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], first_of_face: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], first_of_loop: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], edge: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], is_reversed: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], length: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], area: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], diagonal: float, faces: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], width: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], pcurves: CurvePieces, surfaces: list) -> tuple[Annotated[NDArray[numpy.int64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """
    Of faces (k,) that may be narrower than width (k,): (9 k,) int64, for each of them the start and the number of coedges of side 0, side 1, end 0 and end 1, and whether the sides are loops; and their largest ways across (k,), below 0 of those that are not narrow.

    points (n, 3), t (n,): samples, of edge e those from first[e] to first[e + 1]. edge, is_reversed (c,): coedges of all faces, loop after loop; pcurves: of these. length: of the edges. area: of the faces. surfaces: k.
    """

def gap_sizes(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], reach: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], ends: Annotated[NDArray[numpy.int64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], edges: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], first_of_face: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], asked: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], *, along: float, least: float, ignored: float, ignored_of_size: float, longer: float, narrowest: float, least_narrow: float) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """
    Sizes (n,) that the distance of samples from other edges of their faces asks for, infinite for none.

    The samples as ``space.edge_gaps`` has them; asked (n,): the sizes there without gaps. A gap of ``ignored``, or ``ignored_of_size`` of the size there, is the narrowest that asks: for ``along`` times itself, but at least ``least``, and at least ``longer`` times itself up to ``narrowest``; for that where this would be below ``least_narrow``. Lengths in model units.
    """

class MateRuns:
    """Parts of edges that run beside another edge, sample by sample."""

    def __init__(self, edge: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], mate: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], foot: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], gap: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> None:
        """
        edge, mate (k,): numbers. t (n,) rising, foot (n,): fractions of the ranges of both; gap (n,): distances; of run i from first[i] to first[i + 1].
        """

    def __len__(self) -> int: ...

    @property
    def edge(self) -> Annotated[NDArray[numpy.int64], dict(shape=(None,), writable=False)]:
        """(k,) int64"""

    @property
    def mate(self) -> Annotated[NDArray[numpy.int64], dict(shape=(None,), writable=False)]:
        """(k,) int64"""

    @property
    def first(self) -> Annotated[NDArray[numpy.int64], dict(shape=(None,), writable=False)]:
        """(k + 1,) int64"""

    @property
    def t(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """(n,)"""

    @property
    def foot(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """(n,)"""

    @property
    def gap(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), writable=False)]:
        """(n,) model units"""

def edges_beside(points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], ends: Annotated[NDArray[numpy.int64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], first_of_face: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], edges: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], coedge_edge: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], coedge_face: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], is_reversed: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], one: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], other: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], width: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], acute: float) -> Annotated[NDArray[numpy.int64], dict(shape=(None, 3))]:
    """
    Rows (k, 3) of a face and two of its edges, both ways: edges that follow each other and turn back, then those that do not meet and are somewhere narrowly apart.

    points (n, 3): samples, of edge e those from first[e] to first[e + 1]; ends (e, 2): vertices. edges: of face f, each once, from first_of_face[f] to first_of_face[f + 1]. coedge_edge, coedge_face, is_reversed (c,): of all coedges; other (s,) follow one (s,). width (f,): of narrow faces; of a face with 0 nothing is looked at. acute: cosine between edges, above which they turn back.
    """

def mate_runs(curves: CurvePieces, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], uses: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], is_reversed: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order='C', device='cpu', writable=False)], first_use: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], own: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], other: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], width: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], fewest: int) -> MateRuns:
    """
    The runs of chains of edges along others.

    uses, is_reversed (m,): edges of chain c from first_use[c] to first_use[c + 1]. own, other (p,): pairs of chains, mates up to width (p,), in runs of ``fewest`` samples or more.
    """

def lowered_to_mates(runs: MateRuns, t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], sizes: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> Annotated[NDArray[numpy.float64], dict(shape=(None,))]:
    """Sizes (n,) at samples, lowered to those of their mates."""

def mated_cuts(runs: MateRuns, curves: CurvePieces, points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], first: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], ends: Annotated[NDArray[numpy.int64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], vertices: Annotated[NDArray[numpy.int64], dict(shape=(None, 2), order='C', device='cpu', writable=False)], corners: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', device='cpu', writable=False)], length: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], total_curvature: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], fewest: Annotated[NDArray[numpy.int64], dict(shape=(None,), order='C', device='cpu', writable=False)], chord: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], shortest: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], sizes: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], diagonal: float, most: float) -> tuple[Annotated[NDArray[numpy.int64], dict(shape=(None,))], Annotated[NDArray[numpy.int64], dict(shape=(None,))], Annotated[NDArray[numpy.float64], dict(shape=(None,))]]:
    """
    Nodes of edges with mates that face each other: edges (k,), offsets (k + 1,), fractions (m,) of their ranges.

    ends (e, 2): vertices by their numbers in the mesh, vertices (e, 2): rows of corners (v, 3). fewest (e,): segments, which sag by chord (e,) at most, infinite for nothing, unless they are no longer than shortest (e,).
    """
