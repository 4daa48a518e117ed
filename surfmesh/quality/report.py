"""The report: one object with every figure, a verdict, and sentences for what is wrong."""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfmesh.geometry.functions.numeric import NumericSurface
from surfmesh.quality.measures.against_model import unexpected
from surfmesh.quality.measures.bodies import BodyPair, bodies
from surfmesh.quality.measures.by_face import FaceRow, by_face
from surfmesh.quality.measures.by_solid import SolidRow, by_solid, relative_error, volume_of_all
from surfmesh.quality.measures.chord_use import chord_use
from surfmesh.quality.measures.deviation import deviation
from surfmesh.quality.measures.dihedral import angles_within_faces, largest_angle
from surfmesh.quality.measures.folds import FoldedTriangle, folded_surfaces, folds, most_folded
from surfmesh.quality.measures.histograms import Histogram, histograms
from surfmesh.quality.measures.inward import turned_inward
from surfmesh.quality.measures.kept_volumes import volumes_not_kept
from surfmesh.quality.measures.lengths import (
    QUASI_UNIT,
    edge_lengths,
    growth,
    metric_lengths,
    size_growth,
)
from surfmesh.quality.measures.loose_edges import LooseEdges, loose_edges
from surfmesh.quality.measures.lost import explained, is_known, lost
from surfmesh.quality.measures.narrow import DEGENERATE, narrow_triangles
from surfmesh.quality.measures.self_intersection import MeetingPair, located, meeting_pairs
from surfmesh.quality.measures.shape import enclosed_volume, metric_alpha, shapes
from surfmesh.quality.measures.solids import shares_faces
from surfmesh.quality.measures.surface_to_mesh import both_ways, surface_deviation, surface_too_far
from surfmesh.quality.measures.tolerances import (
    Tolerances,
    UnattainableTolerance,
    angle_violation,
    chord_violation,
    exceeds_angle,
    exceeds_chord,
    stated,
)
from surfmesh.quality.measures.topology import topology
from surfmesh.quality.measures.unseen import UnseenPlace, unseen, unseen_problems
from surfmesh.quality.opinion.second_opinion import (
    SecondOpinion,
    disagreements,
    second_opinion,
    unanswered,
)
from surfmesh.quality.verdict.problems import (
    intersections,
    overlaps,
    problems,
    turned_too_far,
)
from surfmesh.quality.verdict.provenance import mesh_sha256, options_of, plain, versions
from surfmesh.quality.verdict.remarks import loose_faces, sheets_facing_apart, touching_bodies
from surfmesh.quality.verdict.worst import WorstTriangle, worst_triangles
from surfmesh.result.model_facts import ModelFacts
from surfmesh.result.surface_mesh import SurfaceMesh

SCHEMA_VERSION = 4  # of to_dict(): raised when a field changes its meaning or goes away
LISTED = 20  # places of one kind that a report holds


@dataclass(frozen=True, kw_only=True)
class Report:
    """What ``check`` found. None stands for what cannot be known, such as the volume of an
    open mesh. Lengths, areas and volumes are in model units, angles in degrees. As JSON it is
    described by docs/report-schema.json.
    """

    schema_version: int
    surface: str  # names of the surfaces
    nodes: int
    triangles: int
    faces: int

    euler: int  # V - E + F
    euler_exact: int | None  # of the model
    closed: bool  # no boundary edge
    manifold: bool  # every edge in one or two triangles, every vertex in one fan of them
    oriented: bool  # neighbours run along their common edge in opposite directions
    one_sided: bool  # by nature of the surface: no orientation is demanded
    components: int
    boundary_loops: int
    boundary_edges: int  # of one triangle
    nonmanifold_edges: int  # of three triangles or more
    self_intersections: int | None  # pairs of triangles that meet where they share nothing
    crosses_itself: bool  # by nature of the surface: self-intersections are no fault
    meeting: tuple[MeetingPair, ...]  # the first twenty of them
    contacts: int | None  # pairs that meet between two bodies of a CAD model that only touch
    overlapping_bodies: int | None  # pairs of solids that share volume
    touching_bodies: int | None  # pairs of bodies that touch without a common face
    bodies: tuple[BodyPair, ...]  # the first twenty of both, and of those whose facets meet
    loose_edges: LooseEdges | None  # rims of faces that lie edge to edge and share nothing

    alpha_mean: float  # 4 sqrt(3) area / sum of squared edges, in 3D; 1 is equilateral
    alpha_p01: float  # 1 % of the triangles are worse
    alpha_min: float
    narrow_triangles: int  # on faces of a CAD model that are narrower than the chord: good shape
    # is not owed there; alpha, angles and edges are of all triangles
    alpha_mean_elsewhere: float | None  # of the others; None: there are none
    alpha_min_elsewhere: float | None
    alpha_metric_mean: float | None  # alpha as seen in the metric; None: isotropic, as in 3D
    alpha_metric_min: float | None
    radius_ratio_mean: float  # 2 r_in / r_circum; 1 is equilateral
    radius_ratio_min: float
    min_angle_deg: float
    max_angle_deg: float
    degenerate: int  # triangles with alpha below 1e-6
    folded: int | None  # triangles turned more than 60 degrees from the surface, inverted too
    inverted: int | None  # triangles turned more than 90 degrees from the surface
    folded_by_surface: int | None  # where the surface bends sharply or dihedrals over: not counted
    # as folded or inverted
    folded_at: tuple[FoldedTriangle, ...]  # the twenty that are turned most
    worst: tuple[WorstTriangle, ...]  # the twenty of the smallest alpha
    histograms: Mapping[str, Histogram]  # alpha, angles, length / wanted length, deviation

    edge_min: float
    edge_mean: float
    edge_max: float
    quasi_unit_share: float | None  # edges within [1/sqrt 2, sqrt 2] of the wanted length
    length_mean: float | None  # of length / wanted length, over all edges
    length_std: float | None
    length_min: float | None
    length_max: float | None
    growth_max: float  # longest over shortest edge at a vertex; in wanted lengths where those
    # depend on the direction
    growth_p99: float
    growth: float | None  # asked for: the largest ratio of neighbouring sizes
    above_growth_share: float | None  # edges whose ends are wanted to differ more than it allows
    size_growth_max: float | None  # largest such difference over what growth allows: 1 is allowed
    size_growth_point: tuple[float, float, float] | None  # middle of that edge

    chord: float | None  # the largest deviation that was asked for, of the whole model
    deviation_max: float | None  # of the mesh from the true surface
    deviation_rms: float | None
    deviation_triangle: int | None  # where deviation_max is
    deviation_point: tuple[float, float, float] | None
    deviation_uv: tuple[float, float] | None
    surface_deviation_max: float | None  # the other way: of the true surface from the mesh
    surface_deviation_triangle: int | None  # over which it is
    surface_deviation_point: tuple[float, float, float] | None  # of the true surface
    surface_deviation_uv: tuple[float, float] | None
    surface_deviation_at_rim: bool | None  # is that point on a free rim of the surface?
    deviation_two_sided: float | None  # the larger of both: the Hausdorff distance, as sampled
    above_chord_share: float | None  # triangles farther away than the chord of their face
    unseen: int | None  # triangles between whose samples a formula's bounds admit more than was
    # seen, or more was found; None: nothing is known between the samples (functions, CAD faces)
    unseen_max: float | None  # how far that lies, or may lie, from the mesh; infinite: no bound
    unseen_at: tuple[UnseenPlace, ...]  # the first twenty
    functions: int  # faces given by a Python function: features narrower than the triangles cannot
    # be excluded there, nor are they looked for
    chord_used: float | None  # median of deviation / chord where chord decided the size
    chord_decided_share: float | None  # of the triangles: where not growth or another wish did
    angle: float | None  # asked for, degrees; None: only 45 as a rule of sizes, no promise
    angle_max: float | None  # largest between triangles that share an edge within a face
    angle_triangles: tuple[int, int] | None  # where it is: not where the surface itself bends
    angle_point: tuple[float, float, float] | None  # middle of the edge
    above_angle_share: float | None  # of the edges within faces, above the angle of their face
    limits: tuple[UnattainableTolerance, ...]  # where a min_size of the user's forbids one of both

    area: float
    area_exact: float | None
    area_error: float | None  # area / area_exact - 1
    volume: float | None  # of a mesh whose every edge is run along as often both ways
    volume_exact: float | None
    volume_error: float | None  # volume / volume_exact - 1
    by_face: tuple[FaceRow, ...]
    by_solid: tuple[SolidRow, ...]
    second_opinion: SecondOpinion | None  # of trimesh and PyVista; None: they were not asked

    unit: str  # of lengths; empty when it is not known
    source: str  # the file, or what else the mesh was made from
    source_sha256: str | None
    mesh_sha256: str  # of points and triangles
    versions: Mapping[str, str]  # of the packages at work
    healing: tuple[str, ...]  # what was changed in the model
    seconds: Mapping[str, float]  # by stage
    warnings: tuple[str, ...]
    options: Mapping[str, Any]  # the sizing it was made with
    problems: tuple[str, ...]  # why it is not clean

    @property
    def clean(self) -> bool:
        """Whether the mesh can be used as it is."""
        return not self.problems

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers, strings and lists, ``clean`` included; ready for JSON."""
        values = {item.name: getattr(self, item.name) for item in fields(self)}
        return plain({"schema_version": values.pop("schema_version"), "clean": self.clean} | values)

    def to_json(self, indent: int | None = 2) -> str:
        """JSON text; numbers that are not finite become null."""
        return json.dumps(self.to_dict(), indent=indent, ensure_ascii=False, allow_nan=False)

    def to_text(self) -> str:
        """The certificate: the summary, then faces, solids, worst triangles, histograms,
        healing, versions and hashes.
        """
        from surfmesh.quality.text.certificate import certificate

        return certificate(self)

    def __str__(self) -> str:
        from surfmesh.quality.text.summary import summary

        return summary(self)


def check(mesh: SurfaceMesh, *, second_opinion: bool = False) -> Report:
    """Look at everything that can be said of ``mesh``: topology, self-intersection, shape,
    sizes, deviation, each of them against the model where that is known.

    second_opinion=True asks trimesh and PyVista too for what they know of: topology, area,
    volume, shapes, beside ours in ``report.second_opinion``. Where they disagree by more than
    rounding the mesh is not clean.

    Raises ``ValueError`` when its indices are out of range; everything else that is wrong is
    in ``report.problems``.
    """
    report = _checked(mesh)
    return with_second_opinion(report, mesh) if second_opinion else report


def with_second_opinion(report: Report, mesh: SurfaceMesh) -> Report:
    """The same report of ``mesh`` with what trimesh and PyVista say of it."""
    start = perf_counter()
    opinion = second_opinion(mesh, report)
    return replace(
        report,
        second_opinion=opinion,
        problems=(*report.problems, *disagreements(opinion)),
        warnings=(*report.warnings, *unanswered(opinion)),
        seconds={**report.seconds, "second opinion": perf_counter() - start},
    )


def _checked(mesh: SurfaceMesh) -> Report:
    start = perf_counter()
    broken = mesh.check()
    if broken and "is outside" in broken:
        raise ValueError(f"this is not a mesh: {broken}")
    finite = bool(np.isfinite(mesh.points).all())
    topo, shape = topology(mesh), shapes(mesh)
    lengths = edge_lengths(mesh)
    metric = None if mesh.sizes is None else metric_lengths(mesh, lengths)
    grown = growth(mesh, lengths if mesh.metric_root_3d is None else metric)
    slope = getattr(mesh.sizing, "gradient", None) if finite else None
    steep = None if slope is None else size_growth(mesh, lengths, slope)
    wanted = None if mesh.metric_root_3d is None else metric_alpha(mesh)
    fit = deviation(mesh, shape.area) if finite else None
    tolerances = Tolerances.of(mesh)
    back = surface_deviation(mesh, fit, tolerances)
    chord = getattr(mesh.sizing, "chord", None) or tolerances.base_chord
    facts = mesh.facts or ModelFacts()
    unit_share = None
    if metric is not None and len(metric):
        low, high = QUASI_UNIT
        unit_share = float(np.count_nonzero((metric >= low) & (metric <= high)) / len(metric))
    used = chord_use(mesh, fit, tolerances)
    angle = getattr(mesh.sizing, "angle", None) or tolerances.base_angle
    dihedrals = angles_within_faces(mesh, tolerances.angle) if finite else None
    worst = None if dihedrals is None else largest_angle(mesh, dihedrals)
    turned, bent, limits = None, None, []
    if worst is not None and np.isfinite(tolerances.angle).any():
        turned = float(np.mean(exceeds_angle(tolerances, dihedrals)))
        bent, limits = angle_violation(tolerances, mesh, dihedrals)
    faces = len(mesh.surfaces) or len(np.unique(mesh.face_ids))
    above = beyond = None
    if fit is not None and np.isfinite(tolerances.chord).any():
        above = float(np.mean(exceeds_chord(tolerances, mesh, fit)))
        beyond, more = chord_violation(tolerances, mesh, both_ways(fit, back))
        limits = [*more, *limits]
    turned_over = None if fit is None else folds(mesh, fit.cosine)
    folded = None if turned_over is None else turned_over.ours
    solids = by_solid(mesh, shape) if finite else ()
    crosses = facts.crosses_itself or (mesh.one_sided and topo.closed)  # no room in space
    pairs = meeting_pairs(mesh) if finite else None
    met = loose = None
    if pairs is not None:
        by_triangle = None if fit is None else fit.by_triangle
        loose, edge_to_edge = loose_edges(mesh, by_triangle)
        met = bodies(mesh, pairs, solids, by_triangle, edge_to_edge)
        pairs = pairs[met.own]
    meeting = () if pairs is None else located(mesh, pairs[:LISTED])
    far = None
    if beyond is not None and back is not None:
        far = surface_too_far(mesh, fit, back, beyond, tolerances)
        beyond = None if far else beyond
    narrow = narrow_triangles(mesh, shape.alpha)
    volume = _volume(mesh, topo.balanced, solids) if finite and not broken else None
    odd = unexpected(mesh, topo)
    said = problems(mesh, broken, odd, topo, shape, fit, beyond, tolerances, turned_over, solids)
    short, forbidden = volumes_not_kept(mesh, solids)
    said += short
    said += [far] if far else []
    hidden = unseen(mesh, None if fit is None else both_ways(fit, back), tolerances, LISTED)
    said += unseen_problems(hidden)
    if bent is not None:
        said.append(turned_too_far(mesh, dihedrals, bent, tolerances))
    if pairs is not None and not crosses:
        said += intersections(mesh, meeting, len(pairs))
    if met is not None:
        said += overlaps(met.overlapping)
    rows = by_face(mesh, shape, fit, lengths, folded, tolerances, limits, dihedrals)
    if fit is not None and not broken and math.isfinite(fit.largest) and is_known(mesh):
        known = explained(mesh, shape.area, fit.by_triangle)
        said += lost(mesh, known, rows, solids, facts.area)
    return Report(
        schema_version=SCHEMA_VERSION,
        surface=_names(mesh),
        nodes=len(mesh.points),
        triangles=len(mesh.triangles),
        faces=faces,
        euler=topo.euler,
        euler_exact=facts.euler,
        closed=topo.closed,
        manifold=topo.manifold,
        oriented=topo.oriented,
        one_sided=mesh.one_sided,
        components=topo.components,
        boundary_loops=topo.boundary_loops,
        boundary_edges=topo.boundary_edges,
        nonmanifold_edges=len(topo.crowded_edges),
        self_intersections=None if pairs is None else len(pairs),
        crosses_itself=crosses,
        meeting=meeting,
        contacts=None if met is None or mesh.solid_ids is None else met.contacts,
        overlapping_bodies=None if met is None else len(met.overlapping),
        touching_bodies=None if met is None else len(met.touching),
        bodies=() if met is None else (*met.overlapping, *met.touching, *met.near)[:LISTED],
        loose_edges=loose,
        alpha_mean=_over(np.mean, shape.alpha),
        alpha_p01=_over(lambda alpha: np.quantile(alpha, 0.01), shape.alpha),
        alpha_min=_over(np.min, shape.alpha),
        narrow_triangles=narrow.count,
        alpha_mean_elsewhere=narrow.alpha_mean_elsewhere,
        alpha_min_elsewhere=narrow.alpha_min_elsewhere,
        alpha_metric_mean=None if wanted is None else _over(np.mean, wanted),
        alpha_metric_min=None if wanted is None else _over(np.min, wanted),
        radius_ratio_mean=_over(np.mean, shape.radius_ratio),
        radius_ratio_min=_over(np.min, shape.radius_ratio),
        min_angle_deg=_over(np.min, shape.min_angle),
        max_angle_deg=_over(np.max, shape.max_angle),
        degenerate=int(np.count_nonzero(~(shape.alpha > DEGENERATE))),
        folded=None if folded is None else int(np.count_nonzero(folded)),
        inverted=None if folded is None else int(np.count_nonzero(turned_over.inverted)),
        folded_by_surface=None if folded is None else int(np.count_nonzero(turned_over.own)),
        folded_at=() if folded is None else most_folded(mesh, turned_over, LISTED),
        worst=worst_triangles(mesh, LISTED, shape),
        histograms=histograms(shape, metric, None if fit is None else fit.by_triangle),
        edge_min=_over(np.min, lengths),
        edge_mean=_over(np.mean, lengths),
        edge_max=_over(np.max, lengths),
        quasi_unit_share=unit_share,
        length_mean=None if metric is None else _over(np.mean, metric),
        length_std=None if metric is None else _over(np.std, metric),
        length_min=None if metric is None else _over(np.min, metric),
        length_max=None if metric is None else _over(np.max, metric),
        growth_max=grown.largest,
        growth_p99=grown.p99,
        growth=getattr(mesh.sizing, "growth", None),
        above_growth_share=None if steep is None else steep.share,
        size_growth_max=None if steep is None else steep.largest,
        size_growth_point=None if steep is None else steep.point,
        chord=chord,
        deviation_max=None if fit is None else fit.largest,
        deviation_rms=None if fit is None else fit.rms,
        deviation_triangle=None if fit is None else fit.triangle,
        deviation_point=None if fit is None else fit.point,
        deviation_uv=None if fit is None else fit.uv,
        surface_deviation_max=None if back is None else back.largest,
        surface_deviation_triangle=None if back is None else back.triangle,
        surface_deviation_point=None if back is None else back.point,
        surface_deviation_uv=None if back is None else back.uv,
        surface_deviation_at_rim=None if back is None else back.at_rim,
        deviation_two_sided=None if back is None else max(fit.largest, back.largest),
        above_chord_share=above,
        unseen=None if hidden is None else hidden.found + hidden.open,
        unseen_max=None if hidden is None else max(hidden.largest, hidden.possible),
        unseen_at=() if hidden is None else hidden.places,
        functions=sum(isinstance(surface, NumericSurface) for surface in mesh.surfaces),
        chord_used=None if used is None else used.used,
        chord_decided_share=None if used is None else used.share,
        angle=angle,
        angle_max=None if worst is None else worst[0],
        angle_triangles=None if worst is None else worst[1],
        angle_point=None if worst is None else worst[2],
        above_angle_share=turned,
        limits=tuple(limits),
        area=float(shape.area.sum()),
        area_exact=facts.area,
        area_error=relative_error(float(shape.area.sum()), facts.area),
        volume=volume,
        volume_exact=facts.volume,
        volume_error=relative_error(volume, facts.volume),
        by_face=rows,
        by_solid=solids,
        second_opinion=None,
        unit=facts.unit,
        source=facts.source,
        source_sha256=facts.sha256,
        mesh_sha256=mesh_sha256(mesh),
        versions=versions(mesh),
        healing=facts.healing,
        warnings=(
            *mesh.warnings,
            *(() if folded is None else folded_surfaces(mesh, turned_over)),
            *stated(limits),
            *forbidden,
            *(() if met is None else touching_bodies(met)),
            *(() if loose is None else loose_faces(loose, mesh)),
            *sheets_facing_apart(mesh, odd),
            *(turned_inward(mesh, topo, solids) if finite and not broken else ()),
        ),
        options=options_of(mesh.sizing),
        problems=tuple(said),
        seconds={**mesh.seconds, "check": perf_counter() - start},
    )


def _volume(mesh: SurfaceMesh, encloses: bool, solids: tuple[SolidRow, ...]) -> float | None:
    """Of what the mesh encloses; where solids share faces, the sum over the solids."""
    if shares_faces(mesh):
        return volume_of_all(solids)
    return enclosed_volume(mesh) if encloses else None


def _over(measure: Any, values: NDArray[np.float64]) -> float:
    return float(measure(values)) if len(values) else float("nan")


def _names(mesh: SurfaceMesh) -> str:
    names = list(dict.fromkeys(mesh.face_name(i) for i in range(len(mesh.surfaces))))
    return ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")
