"""One mesh measured: quality by surfmesh's own report, seconds, packing alone."""

import math
import time

import numpy as np

import surfmesh as sm
from surfmesh._core.triangulation import DONE
from surfmesh.geometry.differential.sides import find_sides
from surfmesh.geometry.surface import Surface
from surfmesh.meshing.patch.packing import packed_over
from surfmesh.sizing.field.size_field import SizeField, size_field


def quality(report: sm.Report) -> dict:
    """The figures of a report that are compared, of whatever mesher."""
    deviation = None
    if report.chord and report.deviation_max is not None:
        deviation = report.deviation_max / report.chord
    above = None
    if report.above_chord_share is not None:
        above = round(report.above_chord_share * report.triangles)
    return {
        "triangles": report.triangles,
        "alpha_mean": report.alpha_mean,
        "alpha_p01": report.alpha_p01,
        "alpha_min": report.alpha_min,
        "quasi_unit_share": report.quasi_unit_share,
        "length_mean": report.length_mean,
        "inverted": report.inverted,
        "folded": report.folded,
        "deviation_over_chord": deviation,
        "above_chord": above,
    }


def measured(name: str, sizing: dict, repeats: int) -> dict:
    """Formulas to checked mesh, the fastest of ``repeats`` runs in this process."""
    best = math.inf
    for _ in range(repeats):
        start = time.perf_counter()
        surface = sm.load(name)
        formulas = time.perf_counter() - start
        mesh = sm.mesh(surface, sm.Sizing(**sizing))
        report = sm.check(mesh)
        seconds = time.perf_counter() - start
        if seconds < best:
            best = seconds
            stages = {"formulas": formulas, **report.seconds}
    return {
        **quality(report),
        "problems": len(report.problems),
        "problem_texts": list(report.problems),
        "seconds_by_stage": stages,
        "seconds_total": best,
        "triangles_a_second": report.triangles / best,
        "worst": worst_triangles(mesh, surface),
        "repeats": repeats,
    }


def packing_rate(name: str, sizing: dict, repeats: int) -> float:
    """Triangles a second of the packing alone: its arrays and the call of the core."""
    field = field_of(sm.load(name), sizing)
    best = 0.0
    for _ in range(repeats):
        start = time.perf_counter()
        packing = packed_over(field, field.chart)
        seconds = time.perf_counter() - start
        triangles = np.count_nonzero(packing.t.region == DONE)
        best = max(best, triangles / seconds)
    return best


def field_of(surface: Surface, sizing: dict | sm.Sizing) -> SizeField:
    return size_field(surface, sm.Sizing.of(sizing), find_sides(surface))


def worst_triangles(mesh: sm.SurfaceMesh, surface: Surface, number: int = 20) -> dict:
    """Where the worst triangles by alpha are: at the boundary, and the (u, v) of the very worst."""
    from surfmesh.quality.measures.shape import alpha

    values = alpha(mesh)
    number = min(number, len(values))
    worst = np.argpartition(values, number - 1)[:number]
    worst = worst[np.argsort(values[worst])]
    at_boundary = np.zeros(len(mesh.points), bool)
    at_boundary[mesh.boundary_edges.ravel()] = True
    lo, hi = np.array(surface.domain).T
    place = mesh.uv[worst].mean(axis=1)
    fraction = (place - lo) / (hi - lo)
    return {
        "at_boundary": int(at_boundary[mesh.triangles[worst]].any(axis=1).sum()),
        "near_sides": int((np.minimum(fraction, 1.0 - fraction) < 0.02).any(axis=1).sum()),
        "of": number,
        "uv": [round(float(value), 5) for value in place[0]],
    }
