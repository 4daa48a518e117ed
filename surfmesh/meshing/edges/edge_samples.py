"""What is known of the edges of a model before they are cut: samples, narrow faces, mates."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from surfmesh._core.edges import MateRuns, rows_of
from surfmesh.cad.model.cad_model import CadModel
from surfmesh.cad.model.model_arrays import offsets


@dataclass(frozen=True)
class NarrowFace:
    """Coedges by their place in the row of all coedges of the face.

    sides: both in walking order, the second one comes back. ends: from the first side to the
    second, and back; empty for a tip, and where ``closed``: each side is a loop.
    """

    sides: tuple[tuple[int, ...], tuple[int, ...]]
    ends: tuple[tuple[int, ...], tuple[int, ...]] = ((), ())
    closed: bool = False
    width: float = 0.0
    """Largest way across, model units."""


@dataclass(eq=False)
class EdgeSamples:
    """Of all edges in one row; edge k has those from first[k] to first[k + 1], ends included.

    ``sample_edges`` fills them in step by step; nothing changes afterwards."""

    first: np.ndarray
    """(e + 1,) int64. Edges that are one vertex of the mesh have no samples."""
    t: np.ndarray
    """(n,) normalised parameters of the edges, 0 to 1."""
    points: np.ndarray
    """(n, 3)"""
    target_size: np.ndarray
    """(n,) wanted edge lengths, not graded."""
    tangent: np.ndarray
    """(n, 3) unit; empty where sizes do not depend on the direction."""
    total_curvature: np.ndarray
    """(e,) integral of the curvature along each edge, radians."""
    chord: np.ndarray
    """(e,) what a segment of each edge may sag by at most; infinite where nothing is asked for."""
    shortest: np.ndarray
    """(e,) segments no longer than this are not cut for their sag."""
    has_twin: np.ndarray
    """(e,) bool: the edge is curved, and another one joins the same two vertices."""
    vertex: np.ndarray
    """(v,) for each CAD vertex the number that it has in the mesh."""
    first_of_face: np.ndarray
    """(f + 1,) where the edges of each face begin."""
    face_edges: np.ndarray
    """(k,) for each face the edges with samples, each once."""
    narrow_width: np.ndarray
    """(f,) up to where a face is narrow, model units."""
    narrow: dict[int, NarrowFace]
    """By number the faces that are so all along."""
    hidden: np.ndarray
    """(e,) bool: only narrow faces use the edge: its sizes are nobody else's."""
    tiny: np.ndarray
    """(e,) bool: the edge is no longer than the way round a narrow tube."""
    mates: MateRuns
    """Parts of edges that lie within a narrow width of another edge of the same face."""
    gap_size: np.ndarray
    """(n,) what the distance to other edges of a face asks for; infinite for nothing."""

    @property
    def is_anisotropic(self) -> bool:
        """Do sizes depend on the direction?"""
        return len(self.tangent) > 0

    @property
    def is_wide(self) -> np.ndarray:
        """(f,) bool: the faces that are not narrow."""
        found = np.ones(len(self.narrow_width), bool)
        found[list(self.narrow)] = False
        return found

    @cached_property
    def edges_of_wide_faces(self) -> tuple[np.ndarray, np.ndarray]:
        """Those of each face that is not narrow, as ``edges_of_faces``."""
        if not self.narrow:
            return self.first_of_face, self.face_edges
        return self.edges_of_faces(np.flatnonzero(self.is_wide))

    @cached_property
    def is_hidden(self) -> np.ndarray:
        """(n,) bool: the sample is of a hidden edge."""
        return np.repeat(self.hidden, np.diff(self.first))

    def edges_of(self, face: int) -> np.ndarray:
        """The edges of a face."""
        return self.face_edges[self.first_of_face[face] : self.first_of_face[face + 1]]

    def edges_of_faces(self, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(n + 1,) where those of each of n faces begin, and the edges (k,)."""
        count = self.first_of_face[faces + 1] - self.first_of_face[faces]
        return offsets(count), self.face_edges[rows_of(self.first_of_face, faces)]

    def of(self, edge: int) -> slice:
        """The samples of one edge."""
        return slice(self.first[edge], self.first[edge + 1])

    def edge_of(self, sample: int) -> int:
        """The edge that a sample is of."""
        return int(np.searchsorted(self.first, sample, side="right") - 1)

    def is_cut_by_shape(self, model: CadModel, edge: int) -> bool:
        """Is the edge of a narrow tube, where no size tells how it is cut?"""
        return bool(self.tiny[edge] and (self.hidden[edge] or not model.edges[edge].closed))

    def along(self, face: int) -> np.ndarray:
        """The samples of all edges of a face."""
        edges = self.edges_of(face)
        parts = [np.arange(self.first[e], self.first[e + 1]) for e in edges]
        return np.concatenate(parts) if parts else np.empty(0, np.int64)
