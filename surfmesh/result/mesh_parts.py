"""What a mesh holds besides its points and triangles, in four parts.

Parametrisation: where the corners of the triangles lie in (u, v).
ModelLinks: the faces, solids and vertices of the model that triangles and vertices stand for.
EdgeLinks: the edges of the mesh that lie on edges of a CAD model.
Record: what was asked for, what is known of the model, and what came of it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import NDArray

from surfmesh.result.connectivity import Connectivity
from surfmesh.result.mesh_groups import MeshGroups
from surfmesh.result.mesh_part import (
    ANY,
    CAD_VERTEX,
    CORNER,
    FACE,
    SEGMENT,
    TRIANGLE,
    VERTEX,
    BoolArray,
    FloatArray,
    Int32Array,
    MeshPart,
    Renumbering,
    fit,
    rows,
)
from surfmesh.result.quadratic_triangles import edge_rows

if TYPE_CHECKING:
    from surfmesh.cad.model.cad_model import CadEdge
    from surfmesh.geometry.surface import Surface
    from surfmesh.result.findings import Finding
    from surfmesh.result.model_facts import ModelFacts
    from surfmesh.sizing.options.sizing import Sizing


@dataclass(frozen=True, eq=False, kw_only=True)
class Parametrisation(MeshPart):
    """Surface parameters of the corners: a vertex on a seam has several."""

    uv_points: FloatArray = field(
        metadata=rows(np.float64, CORNER, 2)
    )  # (k, 2) distinct corner parameters
    uv_triangles: Int32Array = field(
        metadata=rows(np.int32, TRIANGLE, 3, holds=CORNER)
    )  # (m, 3) rows of them
    # (k, 6) root W of the metric, xx, xy, xz, yy, yz, zz, at each of uv_points: |W d| is the step
    # d in target sizes; None where sizes do not depend on the direction, or are not known:
    # W = Id / sizes
    metric_root_3d: FloatArray | None = field(default=None, metadata=rows(np.float64, CORNER, 6))

    def of_triangles(self, kept: NDArray[np.int64]) -> Self:
        """The triangles ``kept``, on the corners that they use."""
        used = np.unique(self.uv_triangles[kept])
        corners = Renumbering.keeping(used, len(self.uv_points))
        return self.renumbered({TRIANGLE: Renumbering(kept), CORNER: corners})

    def with_corners(self, uv: FloatArray, like: NDArray[Any], uv_triangles: NDArray[Any]) -> Self:
        """With more corners (c, 2), each after one that there is, ``like`` (c,), in all else.

        uv_triangles: (m, 3) rows of all of them.
        """
        count = len(self.uv_points)
        more = self.renumbered({CORNER: Renumbering(np.append(np.arange(count), like))})
        uv_points = np.concatenate([self.uv_points, uv])
        return replace(more, uv_points=uv_points, uv_triangles=uv_triangles)


@dataclass(frozen=True, eq=False, kw_only=True)
class ModelLinks(MeshPart):
    """Faces, solids and vertices of the model. Of a single surface: face 0 and nothing else."""

    face_ids: Int32Array = field(metadata=rows(np.int32, TRIANGLE))  # (m,) face of each triangle
    surfaces: tuple[Surface, ...] = ()  # (f) by face_ids; empty when read from a file
    # (f,) triangles run against r_u x r_v there
    turned_faces: BoolArray | None = field(default=None, metadata=rows(np.bool_, FACE))
    # (f,) closed between sides within the chord
    narrow_faces: BoolArray | None = field(default=None, metadata=rows(np.bool_, FACE))
    # (m, 2) solid behind each triangle and before it; -1: none
    solid_ids: Int32Array | None = field(default=None, metadata=rows(np.int32, TRIANGLE, 2))
    # (c,) vertex of the mesh at each CAD vertex; -1: none
    vertex_ids: Int32Array | None = field(
        default=None, metadata=rows(np.int32, CAD_VERTEX, holds=VERTEX)
    )
    # names, colours, kinds, unit; None: those of the surfaces
    groups: MeshGroups = None  # type: ignore[assignment]  # None only until __post_init__

    def __post_init__(self) -> None:
        object.__setattr__(self, "surfaces", tuple(self.surfaces))
        fit(self, {FACE: len(self.surfaces)})
        if self.groups is None:
            object.__setattr__(self, "groups", MeshGroups.of_surfaces(self.surfaces))

    def flipped(self) -> Self:
        """Of the mesh that is turned over: its triangles face the other side."""
        turned = self.turned_faces
        if self.surfaces:
            turned = np.ones(len(self.surfaces), bool) if turned is None else ~turned
            if self.solid_ids is None and not turned.any():
                turned = None
        solids = None if self.solid_ids is None else self.solid_ids[:, ::-1]
        return replace(self, turned_faces=turned, solid_ids=solids)


@dataclass(frozen=True, eq=False, kw_only=True)
class EdgeLinks(MeshPart):
    """Edges of the mesh that lie on edges of a CAD model: its segments."""

    edge_segments: Int32Array = field(
        metadata=rows(np.int32, SEGMENT, 2, holds=VERTEX)
    )  # (k, 2) their ends
    edge_ids: Int32Array = field(metadata=rows(np.int32, SEGMENT))  # (k,) their CAD edges
    # (k, 2) t of both ends on the CAD edge, 0 at its start and 1 at its end
    edge_parameters: FloatArray | None = field(default=None, metadata=rows(np.float64, SEGMENT, 2))
    edge_curves: tuple[CadEdge, ...] = ()  # by edge_ids; empty when read from a file

    def __post_init__(self) -> None:
        object.__setattr__(self, "edge_curves", tuple(self.edge_curves))
        segments, numbers = (
            0 if held is None else len(held) for held in (self.edge_segments, self.edge_ids)
        )
        if segments != numbers:
            raise ValueError(f"has {segments} segments of edges and {numbers} numbers")
        fit(self, {})

    def on_edges(self, table: Connectivity, vertices: Renumbering) -> Self:
        """Those that are edges of ``table`` still, between vertices numbered anew."""
        moved = self.renumbered({VERTEX: vertices})
        pairs = moved.edge_segments
        there = np.flatnonzero((pairs >= 0).all(axis=1) & (pairs[:, 0] != pairs[:, 1]))
        there = there[edge_rows(table, pairs[there]) >= 0]
        return moved.renumbered({SEGMENT: Renumbering(there)})


@dataclass(frozen=True, eq=False, kw_only=True)
class Record(MeshPart):
    """What was asked for, what is known of the model beforehand, and what came of it."""

    sizing: Sizing | None = None  # the options it was made with, those of the whole model
    # (f, 3) what was promised of each face, options by name among it: chord, angle (degrees) and
    # min_size, nan where nothing is asked for. One row: of all. None: what ``sizing`` says
    promises: FloatArray | None = field(default=None, metadata=rows(np.float64, ANY, 3))
    facts: ModelFacts | None = None  # what is known of the model beforehand
    seconds: Mapping[str, float] = field(default_factory=dict)  # by stage
    warnings: tuple[str, ...] = ()  # what the user should know
    findings: tuple[Finding, ...] = ()  # those of the warnings that are about one face, as records

    def __post_init__(self) -> None:
        fit(self, {})
        for name in ("warnings", "findings"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        object.__setattr__(self, "seconds", dict(self.seconds))
