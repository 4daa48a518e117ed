"""All that is measured of one mesh, each measure once, when it is first asked for.

mesh -> Measurements -> figures of the report      (figures/)
                     -> what is wrong              (verdict/)
"""

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from surfmesh._core.quality import EdgeFigures, JoinedTriangles
from surfmesh.quality.measures.against_model import Unexpected, unexpected
from surfmesh.quality.measures.area_and_volume import explained_areas, is_known
from surfmesh.quality.measures.bodies import Bodies, bodies
from surfmesh.quality.measures.by_solid import SolidFigures, SolidRow, by_solid, volume_of_all
from surfmesh.quality.measures.chord_use import ChordUse, chord_use
from surfmesh.quality.measures.coincident_edges import coincident_edges
from surfmesh.quality.measures.curved import (
    CurvedShapes,
    curved_deviation,
    curved_shapes,
    curved_surface_deviation,
)
from surfmesh.quality.measures.deviation import Deviation, deviation
from surfmesh.quality.measures.dihedral import DihedralAngles, angles_within_faces
from surfmesh.quality.measures.folds import Folds, folds
from surfmesh.quality.measures.joined import NumberedFaces, joined_triangles
from surfmesh.quality.measures.known_surfaces import KnownSurfaces
from surfmesh.quality.measures.least_triangles import LeastTriangles, least_triangles
from surfmesh.quality.measures.lengths import SizeGrowth, edge_figures, size_growth
from surfmesh.quality.measures.loose_edges import LooseEdges, loose_edges
from surfmesh.quality.measures.off_surface import OffSurface, off_surface
from surfmesh.quality.measures.proof import Proof, proof
from surfmesh.quality.measures.proved_isotopy import isotopic
from surfmesh.quality.measures.proved_topology import Answer, homeomorphic
from surfmesh.quality.measures.self_intersection import meeting_pairs
from surfmesh.quality.measures.shape import Shapes, enclosed_volume, metric_alpha, shapes
from surfmesh.quality.measures.spread import Spread
from surfmesh.quality.measures.surface_to_mesh import (
    SurfaceDeviation,
    both_ways,
    surface_deviation,
)
from surfmesh.quality.measures.tolerances import (
    ToleranceCheck,
    Tolerances,
    UnattainableTolerance,
    angle_check,
    chord_check,
    exceeds_chord,
)
from surfmesh.quality.measures.topology import Topology, topology
from surfmesh.quality.measures.torn_edges import torn_edges
from surfmesh.quality.measures.unseen import Unseen, unseen
from surfmesh.result.model_facts import ModelFacts
from surfmesh.result.surface_mesh import SurfaceMesh

LISTED = 20  # places of one kind that a report holds


class Measurements:
    """None stands for what cannot be measured: of points that are not finite, without surfaces."""

    def __init__(self, mesh: SurfaceMesh) -> None:
        """Raises ``ValueError`` when indices are out of range."""
        self.mesh = mesh
        self.broken = mesh.broken_invariant()  # the first broken invariant, in words
        if self.broken and not _are_in_range(mesh):
            raise ValueError(f"this is not a mesh: {self.broken}")
        self.finite = not self.broken or bool(np.isfinite(mesh.points).all())
        self.facts = mesh.facts or ModelFacts()
        self.tolerances = Tolerances.of(mesh)
        self.known = KnownSurfaces.of(mesh)

    @cached_property
    def topology(self) -> Topology:
        """Of its triangles."""
        return topology(self.mesh, self.joined)

    @cached_property
    def unexpected(self) -> Unexpected:
        """What of the topology is not as in the model."""
        return unexpected(self.mesh, self.topology)

    @cached_property
    def torn_edges(self) -> NDArray[np.intp]:
        """Rows of free edges within the surfaces; none where these are not known."""
        if self.known is None:
            return np.empty(0, np.intp)
        return torn_edges(self.known, self.unexpected)

    @cached_property
    def coincident_edges(self) -> NDArray[np.intp]:
        """Rows of free edges that lie on each other; none where surfaces say why they are free."""
        if self.mesh.surfaces:
            return np.empty(0, np.intp)
        return coincident_edges(self.mesh)

    @property
    def is_curved(self) -> bool:
        """Are its triangles measured as quadratic ones? ``proof`` sizes straight ones."""
        sizing = self.mesh.sizing
        proves = sizing is not None and sizing.proof
        return self.mesh.order == 2 and self.finite and not self.broken and not proves

    @cached_property
    def curved_shapes(self) -> CurvedShapes | None:
        """Of quadratic triangles."""
        return curved_shapes(self.mesh) if self.is_curved else None

    @cached_property
    def shapes(self) -> Shapes:
        """Of its triangles: alpha and angles of the straight ones between the corners."""
        found, curved = shapes(self.mesh), self.curved_shapes
        return found if curved is None else found._replace(area=curved.area)

    @cached_property
    def alpha_spread(self) -> Spread:
        """Of alpha over its triangles."""
        return Spread.of(self.shapes.alpha)

    @cached_property
    def metric_alpha(self) -> NDArray[np.float64] | None:
        """(m,) alpha in the metric, where sizes depend on the direction."""
        return None if self.mesh.metric_root_3d is None else metric_alpha(self.mesh)

    @cached_property
    def faces(self) -> NumberedFaces:
        """All faces in a row."""
        return NumberedFaces.of(self.mesh)

    @cached_property
    def joined(self) -> JoinedTriangles:
        """The mesh with its edge table, as the core takes it."""
        return joined_triangles(self.mesh, self.faces)

    @cached_property
    def edges(self) -> EdgeFigures:
        """Lengths of its edges."""
        asked = None if self.mesh.sizing is None else self.mesh.sizing.gradient
        slope = asked if asked is not None and self.finite else 0.0
        return edge_figures(self.mesh, self.joined, slope)

    @property
    def metric_lengths(self) -> NDArray[np.float64] | None:
        """(ne,) of its edges over the target sizes."""
        return None if self.mesh.sizes is None else self.edges.metric_lengths

    @cached_property
    def size_growth(self) -> SizeGrowth | None:
        """Of the target sizes."""
        return size_growth(self.mesh, self.edges)

    @cached_property
    def deviation(self) -> Deviation | None:
        """Of the mesh from its surfaces."""
        if self.is_curved and self.known is not None:
            return curved_deviation(self.known, self.shapes.area)
        return deviation(self.mesh, self.shapes.area, self.known) if self.finite else None

    @cached_property
    def surface_deviation(self) -> SurfaceDeviation | None:
        """Of the surfaces from the mesh."""
        if self.known is None or self.deviation is None:
            return None
        if self.is_curved:
            return curved_surface_deviation(self.known, self.deviation)
        return surface_deviation(self.known, self.deviation, self.tolerances)

    @cached_property
    def deviation_both_ways(self) -> Deviation | None:
        """The larger of both."""
        if self.deviation is None:
            return None
        return both_ways(self.deviation, self.surface_deviation)

    @cached_property
    def off_surface(self) -> OffSurface | None:
        """Vertices off their surfaces, where no chord says how far they may be."""
        if self.known is None or self.deviation is None:
            return None
        return off_surface(self.known, self.tolerances)

    @cached_property
    def unseen(self) -> Unseen | None:
        """What may lie between the samples of both; of quadratic triangles nobody knows."""
        if self.is_curved:
            return None
        if self.known is None or self.deviation_both_ways is None:
            return None
        return unseen(self.known, self.deviation_both_ways, self.tolerances, LISTED)

    @cached_property
    def proof(self) -> Proof | None:
        """What bounds say of both, where the report is asked to prove."""
        fit = self.deviation_both_ways
        return (
            None
            if self.known is None or fit is None
            else proof(self.known, fit, self.tolerances, self.is_curved)
        )

    @cached_property
    def homeomorphic(self) -> Answer:
        """Mesh and surface, or model."""
        if self.known is None:
            return Answer(None, "no surface is known")
        return homeomorphic(self.known, self.topology, self.unexpected)

    @cached_property
    def isotopic(self) -> Answer:
        """Likewise, by a deformation of space."""
        meets = None if self.meeting is None else len(self.meeting)
        return isotopic(self.homeomorphic, meets, self.crosses_itself, self.known, self.proof)

    @cached_property
    def chord_check(self) -> ToleranceCheck | None:
        """Does the deviation, both ways, keep to the chord of each face? None: it has none."""
        if self.deviation_both_ways is None or not np.isfinite(self.tolerances.chord).any():
            return None
        by_triangle, seen = self.deviation_both_ways.by_triangle, self.unseen
        if seen is not None and len(seen.forbidden):
            by_triangle = by_triangle.copy()
            np.maximum.at(by_triangle, seen.forbidden, seen.heights)
        return chord_check(self.tolerances, self.mesh, by_triangle)

    @cached_property
    def beyond_chord(self) -> NDArray[np.bool_] | None:
        """(m,) which triangles lie farther from their surface than its chord; None: not known."""
        if self.deviation is None:
            return None
        return exceeds_chord(self.tolerances, self.mesh, self.deviation.by_triangle)

    @cached_property
    def chord_use(self) -> ChordUse | None:
        """How much of the chord is used."""
        if self.known is None or self.deviation is None:
            return None
        return chord_use(self.known, self.deviation, self.tolerances)

    @cached_property
    def least_triangles(self) -> LeastTriangles | None:
        """How many the chord needs at least."""
        if self.known is None or not self.finite:
            return None
        return least_triangles(self.known, self.shapes.area, self.tolerances)

    @cached_property
    def dihedral_angles(self) -> DihedralAngles | None:
        """Within faces."""
        if not self.finite or self.known is None:
            return None
        return angles_within_faces(self.known, self.joined, self.tolerances.angle)

    @cached_property
    def angle_check(self) -> ToleranceCheck | None:
        """Do the dihedral angles keep to the angle of each face? None: it has none."""
        dihedrals = self.dihedral_angles
        if dihedrals is None or dihedrals.worst is None:
            return None
        if not np.isfinite(self.tolerances.angle).any():
            return None
        return angle_check(self.tolerances, self.mesh, dihedrals)

    @cached_property
    def limits(self) -> tuple[UnattainableTolerance, ...]:
        """Where a ``min_size`` of the user's forbids a chord or an angle."""
        checks = (self.chord_check, self.angle_check)
        return tuple(limit for one in checks if one is not None for limit in one.limits)

    @cached_property
    def folds(self) -> Folds | None:
        """Triangles turned far from the surface's normals."""
        if self.known is None or self.deviation is None:
            return None
        return folds(self.known, self.deviation.cosine)

    @cached_property
    def solids(self) -> tuple[SolidRow, ...]:
        """The figures of each solid."""
        if not self.finite:
            return ()
        return by_solid(self.mesh, self.solid_figures, self.topology)

    @cached_property
    def solid_figures(self) -> SolidFigures:
        """What is added up of each solid."""
        curved = self.curved_shapes
        bulges = None if curved is None else curved.volume
        return SolidFigures.of(self.mesh, self.joined, self.shapes.area, bulges)

    @property
    def shares_faces(self) -> bool:
        """Do two solids of the model have a face in common?"""
        return self.solid_figures.both > 0

    @cached_property
    def volume(self) -> float | None:
        """Of what the mesh encloses; where solids share faces, the sum over the solids."""
        if not self.finite or self.broken:
            return None
        if self.shares_faces or self.solid_figures.is_whole(self.mesh):
            return volume_of_all(self.solids)
        if not self.topology.balanced:
            return None
        curved = 0.0 if self.curved_shapes is None else float(self.curved_shapes.volume.sum())
        return enclosed_volume(self.mesh) + curved

    @property
    def has_exact_figures(self) -> bool:
        """Are exact areas or volumes known, and the deviation that explains what is lost?"""
        found = self.deviation
        return (
            found is not None
            and not self.broken
            and bool(np.isfinite(found.largest))
            and is_known(self.mesh)
        )

    @cached_property
    def explained_areas(self) -> NDArray[np.float64] | None:
        """(f,) how much area of each face the deviation explains, where exact ones are known."""
        if self.deviation is None or not self.has_exact_figures:
            return None
        return explained_areas(self.mesh, self.joined, self.shapes.area, self.deviation.by_triangle)

    @cached_property
    def crosses_itself(self) -> bool:
        """Does the surface by its nature? A closed one-sided surface has no room in space."""
        return self.facts.crosses_itself or (self.mesh.one_sided and self.topology.closed)

    @cached_property
    def all_meeting(self) -> NDArray[np.int32] | None:
        """(k, 2) triangles that meet where they share nothing."""
        return meeting_pairs(self.mesh) if self.finite else None

    @cached_property
    def _loose(self) -> tuple[LooseEdges | None, set[tuple[int, int]]]:
        by_triangle = None if self.deviation is None else self.deviation.by_triangle
        return loose_edges(self.mesh, by_triangle)

    @property
    def loose_edges(self) -> LooseEdges | None:
        """Rims of faces that lie along each other and share nothing."""
        return self._loose[0] if self.finite else None

    @cached_property
    def bodies(self) -> Bodies | None:
        """What became of the triangles that meet, and the bodies concerned."""
        if self.all_meeting is None:
            return None
        by_triangle = None if self.deviation is None else self.deviation.by_triangle
        return bodies(self.mesh, self.all_meeting, self.solids, by_triangle, self._loose[1])

    @cached_property
    def meeting(self) -> NDArray[np.int32] | None:
        """(k, 2) those of one body: the mesh intersects itself there."""
        if self.all_meeting is None or self.bodies is None:
            return None
        return self.all_meeting[self.bodies.own]


def _are_in_range(mesh: SurfaceMesh) -> bool:
    """Are all indices those of vertices and of corner parameters?"""
    count = 0 if mesh.uv_points is None else len(mesh.uv_points)
    return all(
        indices is None or not indices.size or 0 <= int(indices.min()) <= int(indices.max()) < limit
        for indices, limit in ((mesh.triangles, len(mesh.points)), (mesh.uv_triangles, count))
    )
