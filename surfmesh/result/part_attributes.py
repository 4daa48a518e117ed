"""What the parts of a mesh hold, as attributes of the mesh."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from surfmesh.result.findings import Finding
from surfmesh.result.mesh_groups import MeshGroups
from surfmesh.result.mesh_part import BoolArray, FloatArray, Int32Array
from surfmesh.result.mesh_parts import EdgeLinks, ModelLinks, Parametrisation, Record

if TYPE_CHECKING:
    from surfmesh.cad.model.cad_model import CadEdge
    from surfmesh.geometry.surface import Surface
    from surfmesh.result.model_facts import ModelFacts
    from surfmesh.sizing.options.sizing import Sizing


class PartAttributes:
    """One property for each field of a part; None where the mesh has no such part."""

    parametrisation: Parametrisation | None
    model_links: ModelLinks
    edge_links: EdgeLinks | None
    record: Record

    @property
    def uv_points(self) -> FloatArray | None:
        """(k, 2) distinct surface parameters of corners; None where no surface is known."""
        return None if self.parametrisation is None else self.parametrisation.uv_points

    @property
    def uv_triangles(self) -> Int32Array | None:
        """(m, 3) rows of ``uv_points`` for the corners of each triangle."""
        return None if self.parametrisation is None else self.parametrisation.uv_triangles

    @property
    def metric_root_3d(self) -> FloatArray | None:
        """(k, 6) root W of the metric, xx, xy, xz, yy, yz, zz, at each of ``uv_points``: |W d| is
        the step d in target sizes; None where sizes do not depend on the direction.
        """
        return None if self.parametrisation is None else self.parametrisation.metric_root_3d

    @property
    def face_ids(self) -> Int32Array:
        """(m,) number of the face that each triangle lies on; 0 for a single surface."""
        return self.model_links.face_ids

    @property
    def surfaces(self) -> tuple[Surface, ...]:
        """The surface of each face; empty when the mesh was read from a file."""
        return self.model_links.surfaces

    @property
    def turned_faces(self) -> BoolArray | None:
        """(f,) whether the triangles of a face run against r_u x r_v; None: none does."""
        return self.model_links.turned_faces

    @property
    def narrow_faces(self) -> BoolArray | None:
        """(f,) faces that were closed between sides within the chord of each other."""
        return self.model_links.narrow_faces

    @property
    def solid_ids(self) -> Int32Array | None:
        """(m, 2) the solid behind each triangle and the one before it; -1: none. Normals point
        from behind to before. None where the model has no solids.
        """
        return self.model_links.solid_ids

    @property
    def vertex_ids(self) -> Int32Array | None:
        """(c,) the vertex of the mesh at each vertex of the CAD model; -1: none."""
        return self.model_links.vertex_ids

    @property
    def groups(self) -> MeshGroups:
        """Names, colours and kinds of faces, names of edges and solids, the unit of length."""
        return self.model_links.groups

    @property
    def edge_segments(self) -> Int32Array | None:
        """(k, 2) vertex numbers of the edges of triangles that lie on edges of the CAD model."""
        return None if self.edge_links is None else self.edge_links.edge_segments

    @property
    def edge_ids(self) -> Int32Array | None:
        """(k,) the CAD edge of each of ``edge_segments``."""
        return None if self.edge_links is None else self.edge_links.edge_ids

    @property
    def edge_parameters(self) -> FloatArray | None:
        """(k, 2) where the ends of ``edge_segments`` lie on their CAD edge: 0 start, 1 end."""
        return None if self.edge_links is None else self.edge_links.edge_parameters

    @property
    def edge_curves(self) -> tuple[CadEdge, ...]:
        """The curves of the CAD edges, by ``edge_ids``; empty when read from a file."""
        return () if self.edge_links is None else self.edge_links.edge_curves

    @property
    def sizing(self) -> Sizing | None:
        """The options that it was made with, those of the whole model."""
        return self.record.sizing

    @property
    def promises(self) -> FloatArray | None:
        """(f, 3) chord, angle in degrees and min_size promised on each face, nan where nothing
        is asked for; one row: of all. None: what ``sizing`` says.
        """
        return self.record.promises

    @property
    def facts(self) -> ModelFacts | None:
        """What was known of the model before it was meshed: areas, volumes, Euler numbers."""
        return self.record.facts

    @property
    def seconds(self) -> Mapping[str, float]:
        """How long each stage took."""
        return self.record.seconds

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the user should know of it, in sentences."""
        return self.record.warnings

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Those of the warnings that are about one face, as records."""
        return self.record.findings
