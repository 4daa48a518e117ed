"""Faces narrower than the chord: clean, their area kept, their neighbours not flooded."""

import math
from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import surfmesh as sm
from surfmesh.meshing import model_rounds
from surfmesh.meshing.edges.edge_nodes import cut_edges
from surfmesh.meshing.edges.edge_sampling import sample_edges
from surfmesh.meshing.faces import opposite_faces
from surfmesh.meshing.faces.strip_triangulation import rungs_between, zipped
from surfmesh.sizing.options.model_sizing import model_sizing

CHORD = 0.05


def judged(shape, euler=2, scale=1.0, **asked):
    """The mesh and its report, of a shape that must come out clean and closed."""
    model = sm.from_cadquery(shape)
    order = asked.pop("order", 1)
    workers = asked.pop("jobs", 1)
    asked = asked or {"chord": CHORD * scale}
    mesh = sm.mesh(model, sm.Sizing(**asked), order=order, jobs=workers)
    report = sm.check(mesh)
    assert report.clean, report.problems
    assert report.closed and report.euler == euler
    assert not any(row.folded for row in report.by_face)
    return mesh, report


def turned(shape: cq.Shape, degrees: float) -> cq.Shape:
    return shape.rotate(cq.Vector(0, 0, 0), cq.Vector(0, 0, 1), degrees)


def banded(width: float) -> cq.Shape:
    """A cylinder in three parts, that in the middle a narrow band; seams do not meet."""
    low = cq.Solid.makeCylinder(10, 5)
    band = cq.Solid.makeCylinder(10, width, pnt=cq.Vector(0, 0, 5))
    top = cq.Solid.makeCylinder(10, 5, pnt=cq.Vector(0, 0, 5 + width))
    return low.fuse(band, turned(top, 37))


def narrow_areas(report, below: float) -> list[float]:
    """Relative errors of the areas of faces smaller than ``below``."""
    rows = [row for row in report.by_face if row.area_exact < below]
    assert rows
    return [row.area / row.area_exact - 1.0 for row in rows]


@given(exponent=st.floats(-4.5, -0.1), scale=st.sampled_from([0.1, 1.0, 1e3]))
@settings(max_examples=6, deadline=None)
def test_a_band_of_any_width_costs_its_two_sides(exponent, scale):
    width = CHORD * 10.0**exponent
    _, report = judged(banded(width).scale(scale), scale=scale)
    assert report.triangles < 1000  # 922 without it
    assert max(map(abs, narrow_areas(report, scale**2 * 70 * width))) < 0.05
    assert 0 < report.narrow_triangles < 200 and report.alpha_min_elsewhere > 0.1


@pytest.mark.parametrize("off", [1e-2, 1e-3, 1e-4])
def test_crescents_of_two_circles_a_hair_apart(off):
    cylinder = cq.Solid.makeCylinder(10, 10)
    other = turned(cq.Solid.makeCylinder(10, 15), 37).translate(cq.Vector(off, 0, 0))
    _, report = judged(cylinder.fuse(other))
    assert max(map(abs, narrow_areas(report, 1.0))) < 0.01
    assert report.triangles < 3000


@pytest.mark.parametrize("fraction", [0.9, 1e-1, 1e-3, 2e-5])
def test_a_needle_hole_has_four_nodes_round_it(fraction):
    shape = cq.Workplane().box(10, 10, 10).faces(">Z").workplane().hole(fraction * CHORD)
    _, report = judged(shape, euler=0)
    tube = next(row for row in report.by_face if row.kind == "cylinder")
    assert report.triangles < 5000 and tube.triangles < 200
    assert tube.area == pytest.approx(tube.area_exact * 2.0 * math.sqrt(2.0) / math.pi, rel=0.02)


THIN = {
    "wire": (lambda w: cq.Solid.makeCylinder(w / 2, 10), 2, 150),
    "torus": (lambda w: cq.Solid.makeTorus(5, w / 2), 0, 400),
    "needle": (lambda w: cq.Solid.makeCone(w / 2, 0, 10), 2, 250),
    "truncated": (lambda w: cq.Solid.makeCone(w / 2, w / 4, 10), 2, 150),
    "fillets": (lambda w: cq.Workplane().box(10, 10, 10).edges().fillet(0.6 * w), 2, 1000),
    "chamfers": (lambda w: cq.Workplane().box(9, 9, 9).edges("|Z or >Z").chamfer(w / 2), 2, 2000),
    "rim": (lambda w: cq.Workplane().cylinder(10, 5).edges(">Z").fillet(w / 2), 2, 1500),
    "slot": (lambda w: cq.Workplane().box(10, 10, 5).faces(">Z").workplane().slot2D(6, w)
             .cutBlind(-2), 2, 1000),
    "groove": (lambda w: cq.Workplane().box(10, 10, 10)
               .cut(cq.Workplane().box(w, 20, w).translate((1, 0, 5))), 2, 2500),
    "plate": (lambda w: cq.Workplane().box(10, 10, w), 2, 500),
    "low tube": (lambda w: cq.Workplane().circle(5).circle(5 - w).extrude(0.8 * w), 0, 1000),
    "ring groove": (lambda w: cq.Workplane().circle(10).extrude(3).cut(
        cq.Workplane().workplane(offset=2.5).circle(6).circle(6 - w).extrude(3)), 2, 3000),
    "step": (lambda w: cq.Workplane().box(10, 10, 10)
             .union(cq.Workplane().box(5, 10, 10).translate((2.5, 0, w))), 2, 2500),
    "tongue": (lambda w: cq.Workplane().polyline(
        [(0, 0), (5, 0), (5, 5), (4, 5), (4, w), (-6, w / 4), (-6, 0)]).close().extrude(2), 2,
        1000),
    "wedge": (lambda w: cq.Workplane().polyline([(0, 0), (10, 0), (10, w / 20)]).close()
              .extrude(4), 2, 500),
}  # fmt: skip


@pytest.mark.parametrize("name", THIN)
@pytest.mark.parametrize("fraction", [0.8, 0.05, 2e-3])
def test_what_is_narrower_than_the_chord_is_clean_and_cheap(name, fraction):
    make, euler, most = THIN[name]
    _, report = judged(make(fraction * CHORD), euler)
    assert report.triangles < most


@pytest.mark.parametrize("asked", [
    {"size": 0.8}, {"chord": CHORD, "anisotropy": 8.0}, {"chord": CHORD, "order": 2},
    {"chord": CHORD, "jobs": 2}, {"chord": CHORD, "size": 0.7}, {"angle": 20.0, "chord": CHORD},
], ids=str)  # fmt: skip
def test_narrow_faces_by_other_requests(asked):
    asked = dict(asked)
    judged(banded(0.01), **dict(asked))
    judged(cq.Workplane().box(10, 10, 10).faces(">Z").workplane().hole(0.002), 0, **dict(asked))


@pytest.mark.parametrize("fraction", [0.3, 1e-3])
def test_both_sides_of_a_thin_wall_are_meshed_alike(fraction):
    width = fraction * CHORD
    shape = (
        cq.Workplane().spline([(0, 0), (2, 1), (4, -1), (6, 0)]).lineTo(6, width)
        .spline([(4, width - 1), (2, width + 1), (0, width)], includeCurrent=True).close()
        .extrude(2)
    )  # fmt: skip
    mesh, _ = judged(shape)
    walls = [k for k, surface in enumerate(mesh.surfaces) if surface.kind != "plane"]
    counts = np.bincount(mesh.face_ids)[walls]
    assert len(walls) == 2 and counts[0] == counts[1]
    judged(cq.Workplane().circle(5).circle(5 - width).extrude(3), euler=0)


def test_the_other_side_of_a_wall_has_no_image_of_removed_vertices(monkeypatch):
    seen = []

    def spied(*given):
        seen.append(given)
        return opposite_faces.copied(*given)

    monkeypatch.setattr(model_rounds, "copied", spied)
    sm.mesh(sm.from_cadquery(cq.Workplane().box(10, 8, 0.003)), max_size=2.0, jobs=1)
    found, *given = seen[0]
    twin = opposite_faces.copied(found, *given)
    uv = np.insert(found.uv_points, 4, [[1.0, 2.0]], axis=0)
    shifted = found.uv_triangles + (found.uv_triangles >= 4)
    other = opposite_faces.copied(replace(found, uv_points=uv, uv_triangles=shifted), *given)
    assert twin is not None and (found.slots < 0).any()
    for name in ("points", "triangles", "uv_points", "uv_triangles"):
        np.testing.assert_array_equal(getattr(other, name), getattr(twin, name))


def test_a_narrow_face_keeps_its_ends_however_short():
    _, report = judged(cq.Workplane().box(10, 10, 1e-5))
    assert all(abs(row.area / row.area_exact - 1.0) < 1e-6 for row in report.by_face)


def test_asked_for_gaps_are_meshed_across():
    shape = cq.Workplane().box(2, 2, 0.02)
    _, report = judged(shape, chord=CHORD, gap=1.0)
    assert report.triangles > 1000


def test_two_sides_are_cut_with_mates():
    model = sm.from_cadquery(banded(0.001))
    wanted = model_sizing(model, sm.Sizing(chord=CHORD))
    samples = sample_edges(model, wanted)
    nodes = cut_edges(model, wanted.base, samples, {})
    assert len(samples.narrow) == 1 and samples.mates
    runs = samples.mates
    for edge, mate, first, end in zip(runs.edge, runs.mate, runs.first[:-1], runs.first[1:]):
        own, other = nodes[edge], nodes[mate]
        inside = (own.t >= runs.t[first]) & (own.t <= runs.t[end - 1])
        away = np.linalg.norm(own.points[inside, None] - other.points, axis=2).min(axis=1)
        assert away.max() < 0.0011


def test_rungs_join_nodes_that_face_each_other():
    x = np.array([0.0, 1.0, 2.0, 3.0])
    a = np.stack([x, 0 * x, 0 * x], axis=1)
    b = a[[0, 1, 1, 2, 3]] + [0.0, 1e-9, 0.0]
    b[2, 0] = 1.4
    rungs = rungs_between(a, b)
    assert rungs.tolist() == [[0, 0], [1, 1], [1, 2], [2, 3], [3, 4]]


@given(st.integers(1, 6), st.integers(1, 6))
def test_a_zip_of_two_columns_has_every_edge_once(m, n):
    points = np.zeros((m + n + 2, 3))
    points[: m + 1, 1], points[m + 1 :, 1] = np.linspace(0, 1, m + 1), np.linspace(0, 1, n + 1)
    points[m + 1 :, 0] = 5.0
    triangles = np.array(zipped(points, np.arange(m + 1), np.arange(m + 1, m + n + 2)))
    assert len(triangles) == m + n
    a, b, c = points[triangles].transpose(1, 0, 2)
    area = 0.5 * np.cross(b - a, c - a)[:, 2]
    assert (area > 0.0).all() and area.sum() == pytest.approx(5.0)
