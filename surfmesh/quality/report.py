"""The report: one object with every figure, a verdict, and sentences for what is wrong."""

from dataclasses import dataclass, replace
from time import perf_counter

from surfmesh._core import return_free_memory
from surfmesh.quality.figures.accuracy import (
    BetweenSamples,
    ChordUseFigures,
    DeviationFigures,
    DihedralFigures,
    EfficiencyFigures,
)
from surfmesh.quality.figures.area_and_volume import AreaAndVolume
from surfmesh.quality.figures.counts import Counts
from surfmesh.quality.figures.figures import Figures
from surfmesh.quality.figures.proof import ProofFigures
from surfmesh.quality.figures.provenance import Provenance, options_of
from surfmesh.quality.figures.shape import FoldFigures, ShapeFigures
from surfmesh.quality.figures.sizes import SizeFigures
from surfmesh.quality.figures.topology import ContactFigures, TopologyFigures
from surfmesh.quality.measures.by_face import by_face
from surfmesh.quality.measures.histograms import histograms
from surfmesh.quality.measures.measurements import LISTED, Measurements
from surfmesh.quality.opinion.findings import disagreements, unanswered
from surfmesh.quality.opinion.second_opinion import second_opinion as asked_opinion
from surfmesh.quality.text.certificate import certificate
from surfmesh.quality.text.summary import summary
from surfmesh.quality.verdict.problems import problems
from surfmesh.quality.verdict.remarks import remarks
from surfmesh.quality.verdict.worst import worst_triangles
from surfmesh.result.surface_mesh import SurfaceMesh
from surfmesh.truth_value import truth_value


@dataclass(frozen=True, kw_only=True)
class Report(Figures):
    """What ``check`` found, and its words. As JSON it is described by docs/report-schema.json."""

    def to_text(self) -> str:
        """The certificate: the summary, then faces, solids, worst triangles, histograms,
        healing, versions and hashes.
        """
        return certificate(self)

    def __str__(self) -> str:
        return summary(self)


def check(mesh: SurfaceMesh, *, second_opinion: bool = False, prove: bool | None = None) -> Report:
    """The report of ``mesh``, as ``surfmesh.check`` says (api.py)."""
    start = perf_counter()
    second_opinion = truth_value("second_opinion", second_opinion)
    prove = None if prove is None else truth_value("prove", prove)
    measured = Measurements(mesh)
    promised = mesh.sizing is not None and mesh.sizing.proof
    report = _report(measured, promised if prove is None else prove)
    del measured
    return_free_memory(len(mesh.triangles))
    report = replace(report, seconds={**mesh.seconds, "check": perf_counter() - start})
    return with_second_opinion(report, mesh) if second_opinion else report


def with_second_opinion(report: Report, mesh: SurfaceMesh) -> Report:
    """The same report of ``mesh`` with what trimesh and PyVista say of it."""
    start = perf_counter()
    opinion = asked_opinion(mesh, _of_straight(report, mesh))
    return replace(
        report,
        second_opinion=opinion,
        findings=(*report.findings, *disagreements(opinion), *unanswered(opinion)),
        seconds={**report.seconds, "second opinion": perf_counter() - start},
    )


def _of_straight(report: Report, mesh: SurfaceMesh) -> Report:
    """With areas and volumes of the straight triangles between the corners, which the libraries
    are given."""
    if mesh.mid_points is None:
        return report
    straight = Measurements(mesh.replaced(mid_points=None))
    return replace(report, area_and_volume=AreaAndVolume.of(straight), by_solid=straight.solids)


def _report(measured: Measurements, prove: bool) -> Report:
    """All that can be said without the time that it took."""
    mesh, shapes, fit = measured.mesh, measured.shapes, measured.deviation
    faces = by_face(measured)
    by_triangle = None if fit is None else fit.by_triangle
    return Report(
        counts=Counts.of(measured),
        topology=TopologyFigures.of(measured),
        contact=ContactFigures.of(measured),
        shape=ShapeFigures.of(measured),
        folds=FoldFigures.of(measured),
        worst=worst_triangles(mesh, LISTED, shapes),
        histograms=histograms(shapes, measured.metric_lengths, by_triangle),
        sizes=SizeFigures.of(measured),
        accuracy=DeviationFigures.of(measured),
        between_samples=BetweenSamples.of(measured),
        chord_use=ChordUseFigures.of(measured),
        efficiency_of=EfficiencyFigures.of(measured),
        dihedral_angles=DihedralFigures.of(measured),
        limits=measured.limits,
        area_and_volume=AreaAndVolume.of(measured),
        by_face=faces,
        by_solid=measured.solids,
        proof=ProofFigures.of(measured) if prove else None,
        provenance=Provenance.of(measured),
        seconds=mesh.seconds,
        findings=(*problems(measured, faces, prove), *remarks(measured, prove)),
        options=options_of(mesh.sizing),
    )
