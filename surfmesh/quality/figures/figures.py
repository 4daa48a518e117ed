"""Everything that was found of one mesh: the parts, the findings, and how they become JSON.

report.shape.alpha_mean     a figure in its part
report.alpha_mean           the same
{"alpha_mean": ...}         in JSON, all figures side by side
"""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, Generic, Self, TypeVar, overload

from surfmesh.quality.figures.accuracy import (
    BetweenSamples,
    ChordUseFigures,
    DeviationFigures,
    DihedralFigures,
    EfficiencyFigures,
)
from surfmesh.quality.figures.area_and_volume import AreaAndVolume
from surfmesh.quality.figures.counts import Counts
from surfmesh.quality.figures.part import Part
from surfmesh.quality.figures.proof import ProofFigures
from surfmesh.quality.figures.provenance import Provenance, plain
from surfmesh.quality.figures.second_opinion import SecondOpinion
from surfmesh.quality.figures.shape import FoldFigures, ShapeFigures
from surfmesh.quality.figures.sizes import SizeFigures
from surfmesh.quality.figures.topology import ContactFigures, TopologyFigures
from surfmesh.quality.measures.by_solid import SolidRow
from surfmesh.quality.measures.face_rows import FaceRow
from surfmesh.quality.measures.histograms import Histogram
from surfmesh.quality.measures.tolerances import UnattainableTolerance
from surfmesh.quality.verdict.finding import Finding, Problem, Remark
from surfmesh.quality.verdict.worst import WorstTriangle

SCHEMA_VERSION = 4  # of to_dict(): raised when a field changes its meaning or goes away

Held = TypeVar("Held")


class Figure(Generic[Held]):
    """A figure of a part as an attribute of the whole."""

    def __init__(self, read: "Callable[[Figures], Held]") -> None:
        self.read = read

    @overload
    def __get__(self, whole: None, owner: type) -> Self: ...
    @overload
    def __get__(self, whole: "Figures", owner: type) -> Held: ...
    def __get__(self, whole: "Figures | None", owner: type) -> Self | Held:
        return self if whole is None else self.read(whole)


@dataclass(frozen=True, kw_only=True)
class Figures:
    """Parts in the order of the JSON. None stands for what cannot be known, such as the volume of
    an open mesh. Lengths, areas and volumes are in model units, angles in degrees.
    """

    counts: Counts
    topology: TopologyFigures
    contact: ContactFigures
    shape: ShapeFigures
    folds: FoldFigures
    worst: tuple[WorstTriangle, ...]  # the twenty of the smallest alpha
    histograms: Mapping[str, Histogram]  # alpha, angles, length / target size, deviation
    sizes: SizeFigures
    accuracy: DeviationFigures
    between_samples: BetweenSamples
    chord_use: ChordUseFigures
    efficiency_of: EfficiencyFigures
    dihedral_angles: DihedralFigures
    limits: tuple[UnattainableTolerance, ...]  # where a min_size of the user's forbids one of both
    area_and_volume: AreaAndVolume
    by_face: Sequence[FaceRow]
    by_solid: tuple[SolidRow, ...]
    proof: ProofFigures | None = None  # distances that are proved; None: not asked
    second_opinion: SecondOpinion | None = None  # of trimesh and PyVista; None: not asked
    provenance: Provenance
    seconds: Mapping[str, float]  # by stage
    findings: tuple[Finding, ...]  # problems, then remarks
    options: Mapping[str, Any]  # the sizing it was made with

    schema_version = SCHEMA_VERSION
    surface = Figure(lambda report: report.counts.surface)
    nodes = Figure(lambda report: report.counts.nodes)
    triangles = Figure(lambda report: report.counts.triangles)
    faces = Figure(lambda report: report.counts.faces)
    euler = Figure(lambda report: report.topology.euler)
    euler_exact = Figure(lambda report: report.topology.euler_exact)
    closed = Figure(lambda report: report.topology.closed)
    manifold = Figure(lambda report: report.topology.manifold)
    oriented = Figure(lambda report: report.topology.oriented)
    one_sided = Figure(lambda report: report.topology.one_sided)
    components = Figure(lambda report: report.topology.components)
    boundary_loops = Figure(lambda report: report.topology.boundary_loops)
    boundary_edges = Figure(lambda report: report.topology.boundary_edges)
    nonmanifold_edges = Figure(lambda report: report.topology.nonmanifold_edges)
    self_intersections = Figure(lambda report: report.contact.self_intersections)
    crosses_itself = Figure(lambda report: report.contact.crosses_itself)
    meeting = Figure(lambda report: report.contact.meeting)
    contacts = Figure(lambda report: report.contact.contacts)
    overlapping_bodies = Figure(lambda report: report.contact.overlapping_bodies)
    touching_bodies = Figure(lambda report: report.contact.touching_bodies)
    bodies = Figure(lambda report: report.contact.bodies)
    loose_edges = Figure(lambda report: report.contact.loose_edges)
    alpha_mean = Figure(lambda report: report.shape.alpha_mean)
    alpha_p01 = Figure(lambda report: report.shape.alpha_p01)
    alpha_min = Figure(lambda report: report.shape.alpha_min)
    narrow_triangles = Figure(lambda report: report.shape.narrow_triangles)
    alpha_mean_elsewhere = Figure(lambda report: report.shape.alpha_mean_elsewhere)
    alpha_min_elsewhere = Figure(lambda report: report.shape.alpha_min_elsewhere)
    alpha_metric_mean = Figure(lambda report: report.shape.alpha_metric_mean)
    alpha_metric_min = Figure(lambda report: report.shape.alpha_metric_min)
    radius_ratio_mean = Figure(lambda report: report.shape.radius_ratio_mean)
    radius_ratio_min = Figure(lambda report: report.shape.radius_ratio_min)
    min_angle_deg = Figure(lambda report: report.shape.min_angle_deg)
    max_angle_deg = Figure(lambda report: report.shape.max_angle_deg)
    degenerate = Figure(lambda report: report.shape.degenerate)
    jacobian_min = Figure(lambda report: report.shape.jacobian_min)
    folded = Figure(lambda report: report.folds.folded)
    inverted = Figure(lambda report: report.folds.inverted)
    folded_by_surface = Figure(lambda report: report.folds.folded_by_surface)
    folded_at = Figure(lambda report: report.folds.folded_at)
    edge_min = Figure(lambda report: report.sizes.edge_min)
    edge_mean = Figure(lambda report: report.sizes.edge_mean)
    edge_max = Figure(lambda report: report.sizes.edge_max)
    quasi_unit_share = Figure(lambda report: report.sizes.quasi_unit_share)
    length_mean = Figure(lambda report: report.sizes.length_mean)
    length_std = Figure(lambda report: report.sizes.length_std)
    length_min = Figure(lambda report: report.sizes.length_min)
    length_max = Figure(lambda report: report.sizes.length_max)
    growth_max = Figure(lambda report: report.sizes.growth_max)
    growth_p99 = Figure(lambda report: report.sizes.growth_p99)
    growth = Figure(lambda report: report.sizes.growth)
    above_growth_share = Figure(lambda report: report.sizes.above_growth_share)
    size_growth_max = Figure(lambda report: report.sizes.size_growth_max)
    size_growth_point = Figure(lambda report: report.sizes.size_growth_point)
    chord = Figure(lambda report: report.accuracy.chord)
    deviation_max = Figure(lambda report: report.accuracy.deviation_max)
    deviation_rms = Figure(lambda report: report.accuracy.deviation_rms)
    deviation_triangle = Figure(lambda report: report.accuracy.deviation_triangle)
    deviation_point = Figure(lambda report: report.accuracy.deviation_point)
    deviation_uv = Figure(lambda report: report.accuracy.deviation_uv)
    surface_deviation_max = Figure(lambda report: report.accuracy.surface_deviation_max)
    surface_deviation_triangle = Figure(lambda report: report.accuracy.surface_deviation_triangle)
    surface_deviation_point = Figure(lambda report: report.accuracy.surface_deviation_point)
    surface_deviation_uv = Figure(lambda report: report.accuracy.surface_deviation_uv)
    surface_deviation_at_rim = Figure(lambda report: report.accuracy.surface_deviation_at_rim)
    deviation_two_sided = Figure(lambda report: report.accuracy.deviation_two_sided)
    above_chord_share = Figure(lambda report: report.accuracy.above_chord_share)
    unseen = Figure(lambda report: report.between_samples.unseen)
    unseen_max = Figure(lambda report: report.between_samples.unseen_max)
    unseen_at = Figure(lambda report: report.between_samples.unseen_at)
    functions = Figure(lambda report: report.between_samples.functions)
    chord_used = Figure(lambda report: report.chord_use.chord_used)
    chord_decided_share = Figure(lambda report: report.chord_use.chord_decided_share)
    least_triangles = Figure(lambda report: report.efficiency_of.least_triangles)
    efficiency = Figure(lambda report: report.efficiency_of.efficiency)
    equilateral_triangles = Figure(lambda report: report.efficiency_of.equilateral_triangles)
    angle = Figure(lambda report: report.dihedral_angles.angle)
    angle_max = Figure(lambda report: report.dihedral_angles.angle_max)
    angle_triangles = Figure(lambda report: report.dihedral_angles.angle_triangles)
    angle_point = Figure(lambda report: report.dihedral_angles.angle_point)
    above_angle_share = Figure(lambda report: report.dihedral_angles.above_angle_share)
    area = Figure(lambda report: report.area_and_volume.area)
    area_exact = Figure(lambda report: report.area_and_volume.area_exact)
    area_error = Figure(lambda report: report.area_and_volume.area_error)
    volume = Figure(lambda report: report.area_and_volume.volume)
    volume_exact = Figure(lambda report: report.area_and_volume.volume_exact)
    volume_error = Figure(lambda report: report.area_and_volume.volume_error)
    unit = Figure(lambda report: report.provenance.unit)
    source = Figure(lambda report: report.provenance.source)
    source_sha256 = Figure(lambda report: report.provenance.source_sha256)
    mesh_sha256 = Figure(lambda report: report.provenance.mesh_sha256)
    versions = Figure(lambda report: report.provenance.versions)
    healing = Figure(lambda report: report.provenance.healing)

    @property
    def clean(self) -> bool:
        """Whether the mesh can be used as it is."""
        return not any(isinstance(finding, Problem) for finding in self.findings)

    @property
    def problems(self) -> tuple[str, ...]:
        """Why it is not clean, one sentence for each."""
        return tuple(found.text for found in self.findings if isinstance(found, Problem))

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is no fault of the mesh and still should be known, one sentence for each."""
        return tuple(found.text for found in self.findings if isinstance(found, Remark))

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers, strings and lists, ``clean`` included; ready for JSON."""
        values: dict[str, Any] = {"schema_version": SCHEMA_VERSION, "clean": self.clean}
        for item in fields(self):
            value = getattr(self, item.name)
            if isinstance(value, Part):
                values |= vars(value)
            elif item.name == "findings":
                values["warnings"] = self.warnings
            else:
                values[item.name] = value
        return plain(values | {"problems": self.problems})

    def to_json(self, indent: int | None = 2) -> str:
        """JSON text; numbers that are not finite become null."""
        return json.dumps(self.to_dict(), indent=indent, ensure_ascii=False, allow_nan=False)
