"""The fields of a mesh and of its parts by one name each, as keywords."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, TypedDict

from numpy.typing import ArrayLike

from surfmesh.result.findings import Finding
from surfmesh.result.mesh_groups import MeshGroups
from surfmesh.result.mesh_parts import EdgeLinks, ModelLinks, Parametrisation, Record
from surfmesh.result.model_facts import ModelFacts

if TYPE_CHECKING:
    from surfmesh.cad.model.cad_model import CadEdge
    from surfmesh.geometry.surface import Surface
    from surfmesh.sizing.options.sizing import Sizing


class MeshFields(TypedDict, total=False):
    """What a mesh may hold besides points and triangles: whole parts, and fields of parts."""

    sizes: ArrayLike | None
    mid_points: ArrayLike | None
    one_sided: bool
    parametrisation: Parametrisation | None
    model_links: ModelLinks | None
    edge_links: EdgeLinks | None
    record: Record | None
    uv_points: ArrayLike | None
    uv_triangles: ArrayLike | None
    metric_root_3d: ArrayLike | None
    face_ids: ArrayLike | None
    surfaces: Iterable[Surface]
    turned_faces: ArrayLike | None
    narrow_faces: ArrayLike | None
    solid_ids: ArrayLike | None
    vertex_ids: ArrayLike | None
    groups: MeshGroups | None
    edge_segments: ArrayLike | None
    edge_ids: ArrayLike | None
    edge_parameters: ArrayLike | None
    edge_curves: Iterable[CadEdge]
    sizing: Sizing | None
    promises: ArrayLike | None
    facts: ModelFacts | None
    seconds: Mapping[str, float]
    warnings: Iterable[str]
    findings: Iterable[Finding]
