"""What a face of a CAD model is meshed from, and what becomes of it: plain arrays."""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple, Self

import numpy as np

from surfmesh._core.faces import BoundaryBuilder, FaceBoundary, FaceJoiner
from surfmesh.cad.model.loop_faults import ExactLoops
from surfmesh.geometry.cad_surfaces.face_surface import FaceSurface
from surfmesh.meshing.edges.edge_samples import NarrowFace
from surfmesh.sizing.options.sizing import Sizing
from surfmesh.sizing.rules.size_limits import SizeLimits


@dataclass(frozen=True)
class CoedgeNodes:
    """One coedge in walking order, with both ends.

    A degenerate edge has two nodes of the same number; it is cut when the metric is known.
    """

    uv: np.ndarray
    """(n, 2)"""
    numbers: np.ndarray
    """(n,) int64"""
    points: np.ndarray
    """(n, 3)"""
    sizes: np.ndarray
    """(n,)"""
    degenerate: bool = False
    tolerance: float = 0.0
    """The edge lies this near its p-curves, model units."""

    def part(self, first: int, last: int) -> Self:
        """The nodes from ``first`` to ``last``, both included."""
        return self._rows(slice(first, last + 1))

    def backwards(self) -> Self:
        """The same in the other direction."""
        return self._rows(slice(None, None, -1))

    def _rows(self, rows: slice) -> Self:
        return replace(
            self, uv=self.uv[rows], numbers=self.numbers[rows], points=self.points[rows],
            sizes=self.sizes[rows],
        )  # fmt: skip


class Polygons(NamedTuple):
    """Loops as closed polygons, all in one row: coedge after coedge, each without its last node."""

    uv: np.ndarray  # (n, 2)
    numbers: np.ndarray  # (n,)
    points: np.ndarray  # (n, 3)
    segments: np.ndarray  # (n, 2) rows of the nodes
    loop: np.ndarray  # (n,) of each segment


def boundary_of(loops: Iterable[Iterable[CoedgeNodes]]) -> FaceBoundary:
    """The nodes of all loops in one row each, as the core has them."""
    builder = BoundaryBuilder()
    for loop in loops:
        for piece in loop:
            builder.add(
                piece.uv, piece.numbers, piece.points, piece.sizes, piece.degenerate,
                piece.tolerance,
            )  # fmt: skip
        builder.end_loop()
    return builder.boundary()


@dataclass(frozen=True)
class FaceJob:
    """All that is needed to mesh one face; can be pickled, knows no CAD kernel."""

    surface: FaceSurface
    boundary: FaceBoundary
    """The nodes of its edges, loop after loop: see ``boundary_of``, and ``loops``."""
    sizing: Sizing
    limits: SizeLimits | None = None
    """From earlier rounds."""
    optimise: bool = True
    last: bool = False
    """Finer edges did not help: take a boundary that crosses itself apart, however far, or
    close it without regard for the surface."""
    exact: ExactLoops | None = None
    """The curves that the loops are cut from."""
    narrow: NarrowFace | None = None
    """Its sides and ends, of a face narrower than the chord all along."""

    @cached_property
    def loops(self) -> tuple[tuple[CoedgeNodes, ...], ...]:
        """The boundary coedge by coedge, for what is out of the ordinary."""
        nodes = self.boundary
        uv, numbers, points, sizes = nodes.uv, nodes.numbers, nodes.points, nodes.sizes
        ends, degenerate = [0, *nodes.piece_end.tolist()], nodes.degenerate.tolist()
        pieces = [
            CoedgeNodes(
                uv[first:after], numbers[first:after], points[first:after], sizes[first:after],
                bool(point), tolerance,
            )
            for first, after, point, tolerance in zip(
                ends, ends[1:], degenerate, nodes.tolerance.tolist()
            )
        ]  # fmt: skip
        last = [0, *nodes.loop_end.tolist()]
        return tuple(tuple(pieces[first:after]) for first, after in pairwise(last))

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items() if name != "loops"}

    @property
    def polygons(self) -> Polygons:
        """Its boundary as it is cut."""
        pieces = [piece for loop in self.loops for piece in loop]
        segments, loop_ids, start = [], [], 0
        for number, loop in enumerate(self.loops):
            ring = np.arange(start, start + sum(len(piece.uv) - 1 for piece in loop))
            segments.append(np.stack([ring, np.roll(ring, -1)], axis=1))
            loop_ids.append(np.full(len(ring), number))
            start += len(ring)
        return Polygons(
            np.concatenate([piece.uv[:-1] for piece in pieces]),
            np.concatenate([piece.numbers[:-1] for piece in pieces]),
            np.concatenate([piece.points[:-1] for piece in pieces]),
            np.concatenate(segments),
            np.concatenate(loop_ids),
        )

    @property
    def rings(self) -> list[np.ndarray]:
        """The loops as closed polygons (k, 2) in (u, v)."""
        nodes = self.boundary
        ends, loops = nodes.piece_end, nodes.loop_end
        kept = np.ones(len(nodes), bool)
        kept[ends - 1] = False
        return np.split(nodes.uv[kept], (ends[loops - 1] - loops)[:-1])

    @property
    def nodes(self) -> int:
        """How many nodes its boundary has."""
        return len(self.boundary)

    def __post_init__(self) -> None:
        if self.limits is not None and self.limits.essential and self.sizing.min_size:
            least = min(self.sizing.min_size, float(self.limits.sizes.min()))
            object.__setattr__(self, "sizing", self.sizing.replaced(min_size=least))


@dataclass(frozen=True)
class FaceMesh:
    """Triangles along r_u x r_v, or a reason."""

    points: np.ndarray = field(default_factory=lambda: np.empty((0, 3)))
    """(n, 3)"""
    slots: np.ndarray = field(default_factory=lambda: np.empty(0, np.int64))
    """(n,) where the point stands among the job's boundary nodes, loop after loop; -1 inside."""
    triangles: np.ndarray = field(default_factory=lambda: np.empty((0, 3), np.int32))
    uv_points: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))
    uv_triangles: np.ndarray = field(default_factory=lambda: np.empty((0, 3), np.int32))
    sizes: np.ndarray = field(default_factory=lambda: np.empty(0))
    inverse_sizes: np.ndarray | None = None
    """Of ``uv_points``, where sizes depend on the direction: see ``SurfaceMesh``."""
    refinement: SizeLimits | None = None
    """Smaller sizes that the face needs."""
    failure: str = ""
    place: tuple[float, float, float] | None = None
    """Where it failed, if that is known."""
    unmeshable: bool = False
    """No sizes can mend what has failed."""
    remark: str = ""
    """What was done to it out of the ordinary."""
    narrow: bool = False
    """It was closed between its sides: good shape is not owed there."""

    @property
    def count(self) -> int:
        """How many triangles the face has, wherever they are."""
        return len(self.triangles)

    @property
    def is_empty(self) -> bool:
        """Has it no triangles?"""
        return not len(self.triangles)

    def whole(self) -> "FaceMesh":
        """With all of its arrays, by itself: see ``partitions`` and ``face_in_rows``."""
        return self

    def add_to(
        self, joiner: FaceJoiner, boundary: FaceBoundary, face: int, is_turned: bool
    ) -> None:
        """Hand it over to be joined with others; boundary: of its job, face: its number."""
        joiner.add(
            self.points, self.slots, self.sizes, self.triangles, self.uv_points,
            self.uv_triangles, boundary, face, is_turned,
        )  # fmt: skip
